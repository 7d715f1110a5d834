// Pairs of bodies of an island, the contacts between them, and joints that follow others.
#pragma once

#include <vector>

#include "lanes/spatial.h"

namespace blem_sim::dynamics {

/** Two nodes that act on each other. */
struct BodyPair {
  int a = -1;                       ///< node; wrenches are on it, about its tree's reference point
  int b = -1;                       ///< node, -1: the static world
  Vector3 shift = Vector3::Zero();  ///< from a's reference point to b's
};

/** Twist of node a against node b, about a's reference point. @param twist per node */
inline Vector6 relativeTwist(const BodyPair& pair, const std::vector<Vector6>& twist) {
  if (pair.b < 0) return twist[pair.a];
  return twist[pair.a] - moveTwist(twist[pair.b], -pair.shift);
}

/** Adds a wrench on a pair's a, and its reaction on b. @param on_node sums per node, about the trees' reference points */
inline void addWrench(const BodyPair& pair, const Vector6& wrench, std::vector<Vector6>* on_node) {
  (*on_node)[pair.a] += wrench;
  if (pair.b >= 0) (*on_node)[pair.b] -= moveWrench(wrench, -pair.shift);
}

/** Contacts of one pair, consecutive among the problem's contacts. */
struct PairContacts {
  BodyPair pair;
  int first = 0, end = 0;
};

/** v[dof] = multiplier * v[master], kept exactly: the column of dof is folded into that of its master. */
struct MimicFold {
  int dof, master;
  double multiplier;
};

}  // namespace blem_sim::dynamics
