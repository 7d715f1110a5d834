// The step problem of one island: minimise, over the velocities v at the end of the step,
//   1/2 (v - v*)' M (v - v*) + sum_j phi_j(v_j) + sum_c psi_c(J_c v)
// Every reaction is minus a gradient. See docs/solver.md.
#pragma once

#include <vector>

#include "lanes/body_pair.h"
#include "lanes/contact_term.h"
#include "lanes/joint_term.h"
#include "lanes/loop_term.h"

namespace blem_sim::dynamics {

/** Terms of the objective: made before a solve, which answers in them. */
struct IslandTerms {
  std::vector<JointTerm> joints;
  std::vector<ContactTerm> contacts;
  std::vector<LoopTerm> loops;

  void clear();
};

/** Answer of an island's solve: terms with their reactions, and proximal points that give these at the velocities found. */
struct IslandAnswer {
  IslandTerms terms;
  std::vector<double> mimic_impulses;  ///< by which each mimic's dof follows its master
};

/** One island: trees that something ties together, and how. Used again from step to step, so it need not allocate. */
struct IslandModel {
  std::vector<int> trees;  ///< ascending
  int joints = 0;          ///< that have terms
  std::vector<PairContacts> pairs;
  std::vector<BodyPair> loop_pairs;  ///< of each loop, a the child
  std::vector<MimicFold> mimics;
  Vector3 up = Vector3::Zero();  ///< against gravity; zero without
  double mass = 0;               ///< [kg] of all trees

  void clear();
  /** Leaves the trees alone. */
  void clearTies();
  int treeCount() const { return static_cast<int>(trees.size()); }
  /** Whether two branches or two trees are tied, so that the Hessian couples what M does not. */
  bool isTied() const;
  /** Whether it is of free bodies alone, so many that it is swept while it tumbles. */
  bool isHeap() const;
  /** Whether robots are among so many bodies that it is swept while these tumble. */
  bool isMixedHeap() const;
  bool isSwept() const { return isHeap() || isMixedHeap(); }
  /** Whether it is swept and so large that Newton's method does not go on from what sweeps leave of creep. */
  bool isSweptCrowd() const { return isSwept() && isCrowd(); }
  /** Whether its Hessian takes long to factor: as long as dozens of sweeps. */
  bool isCrowd() const;
  /** [N s] A push that no load needs: it would make the whole island ten times as fast as depth is corrected. @param speed [m/s] of that */
  double hardPush(double speed) const;
};

}  // namespace blem_sim::dynamics
