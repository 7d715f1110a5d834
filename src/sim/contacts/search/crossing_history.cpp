#include "contacts/search/crossing_history.h"

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

constexpr double APART = 0.25;                  // of the layer: a pair that crossed is sound again when its deepest contact uses up less
constexpr std::size_t WORDS = 3, NUMBERS = 16;  // of a recovery

bool isRigid(const Pose& X) {
  constexpr double ROUNDING = 1e-6;
  return ((X.linear() * X.linear().transpose() - Matrix3::Identity()).array().abs() <= ROUNDING).all() &&
         X.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

}  // namespace

const Recovery* CrossingHistory::find(int a, int b) const { return contact::findPair(recoveries_, a, b); }

void CrossingHistory::goOn(const CrossingHistory& before, const std::vector<Recovery>& last_apart, const std::vector<std::uint8_t>& crossed,
                           const std::vector<contact::ContactManifold>& manifolds) {
  recoveries_.clear();
  for (std::size_t i = 0; i < last_apart.size(); ++i) {
    const contact::ContactManifold& manifold = manifolds[i];
    const bool was_recovering = before.find(manifold.a, manifold.b) != nullptr;
    if (crossed[i] || (was_recovering && manifold.maxDepth() > APART * manifold.layer)) recoveries_.push_back(last_apart[i]);
  }
}

void CrossingHistory::forget(int collider) { contact::removePairsOf(collider, &recoveries_); }

void CrossingHistory::save(geometry::StateWriter* writer) const {
  writer->word(recoveries_.size());
  for (const Recovery& recovery : recoveries_) {
    writer->integer(recovery.a);
    writer->integer(recovery.b);
    writer->flag(recovery.known);
    writer->numbers(recovery.X_AB.matrix().data(), NUMBERS);
  }
}

void CrossingHistory::restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader) {
  recoveries_.clear();
  for (std::size_t left = reader->count(WORDS, NUMBERS); left > 0; --left) {
    const auto [a, b] = contact::readPair(colliders, reader);
    Recovery recovery{a, b, reader->flag(), Pose()};
    reader->numbers(recovery.X_AB.matrix().data(), NUMBERS);
    if (!isRigid(recovery.X_AB)) reader->refuseContent("a pose in which a pair was last apart is none");
    recoveries_.push_back(recovery);
  }
  if (!contact::areSorted(recoveries_)) contact::refusePairs(*reader);
}

}  // namespace blem_sim::sim
