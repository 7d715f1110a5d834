#include "problem/island_model.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

constexpr int HEAP = 2;      // fewest free bodies of an island that is swept while it tumbles
constexpr int MIXED = 8;     // trees beyond the number of joints of an island that is swept while it tumbles: a sweep visits every joint
constexpr int CROWD = 150;   // most trees of an island whose Hessian is cheap to factor
constexpr double HARD = 10;  // times the fastest correction of depth: a push that makes the whole island so fast is hard

}  // namespace

void IslandTerms::clear() {
  joints.clear();
  contacts.clear();
  loops.clear();
}

void IslandModel::clear() {
  trees.clear();
  clearTies();
}

void IslandModel::clearTies() {
  joints = 0;
  pairs.clear();
  loop_pairs.clear();
  mimics.clear();
}

bool IslandModel::isTied() const {
  return !mimics.empty() || !loop_pairs.empty() ||
         std::any_of(pairs.begin(), pairs.end(), [](const PairContacts& p) { return p.pair.b >= 0; });
}

bool IslandModel::isHeap() const { return treeCount() >= HEAP && loop_pairs.empty() && mimics.empty() && joints == 0; }

bool IslandModel::isMixedHeap() const { return joints > 0 && treeCount() >= joints + MIXED; }

bool IslandModel::isCrowd() const { return treeCount() > CROWD; }

double IslandModel::hardPush(double speed) const { return HARD * speed * mass; }

}  // namespace blem_sim::dynamics
