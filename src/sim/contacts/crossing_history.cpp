#include "contacts/crossing_history.h"

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

constexpr double APART = 0.25;                  // of the layer: a pair that crossed is sound again when its deepest contact uses up less
constexpr std::size_t WORDS = 3, NUMBERS = 16;  // of a recovery

bool isRigid(const Pose& X) {
  constexpr double ROUNDING = 1e-6;
  return (X.linear() * X.linear().transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff() <= ROUNDING &&
         X.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

}  // namespace

const Recovery* CrossingHistory::find(int a, int b) const { return contact::findPair(recoveries_, a, b); }

void CrossingHistory::goOn(const CrossingHistory& before, const std::vector<Recovery>& last_apart,
                           const std::vector<contact::ContactManifold>& manifolds) {
  recoveries_.clear();
  for (std::size_t i = 0; i < last_apart.size(); ++i) {
    const contact::ContactManifold& manifold = manifolds[i];
    const bool was_recovering = before.find(manifold.a, manifold.b) != nullptr;
    if (manifold.pierced || (was_recovering && manifold.maxDepth() > APART * manifold.layer)) recoveries_.push_back(last_apart[i]);
  }
}

void CrossingHistory::forget(int collider) { contact::removePairsOf(collider, &recoveries_); }

void CrossingHistory::append(std::vector<double>* numbers, std::vector<std::uint64_t>* words) const {
  words->push_back(recoveries_.size());
  for (const Recovery& recovery : recoveries_) {
    for (const int word : {recovery.a, recovery.b, static_cast<int>(recovery.known)}) words->push_back(static_cast<std::uint64_t>(word));
    numbers->insert(numbers->end(), recovery.X_AB.matrix().data(), recovery.X_AB.matrix().data() + NUMBERS);
  }
}

bool CrossingHistory::read(const std::vector<contact::Collider>& colliders, const std::uint64_t** words, const std::uint64_t* words_end,
                           NumberReader* reader) {
  recoveries_.clear();
  if (*words == words_end) return false;
  const std::uint64_t count = *(*words)++;
  if (static_cast<std::uint64_t>(words_end - *words) / WORDS < count) return false;
  for (std::uint64_t i = 0; i < count; ++i, *words += WORDS) {
    if (!contact::isPair(colliders, (*words)[0], (*words)[1]) || (*words)[2] > 1) return false;
    Recovery recovery{static_cast<int>((*words)[0]), static_cast<int>((*words)[1]), (*words)[2] != 0, Pose()};
    reader->numbers(recovery.X_AB.matrix().data(), NUMBERS);
    if (!isRigid(recovery.X_AB)) return false;
    recoveries_.push_back(recovery);
  }
  return contact::areSorted(recoveries_);
}

}  // namespace blem_sim::sim
