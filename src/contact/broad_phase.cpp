#include "blem_sim/contact/broad_phase.h"

#include <algorithm>
#include <tuple>

namespace blem_sim {
namespace {

Vector3 halfExtents(const Box& box) { return 0.5 * (box.max() - box.min()); }

/** Box around the turned box. */
void turn(const Box& box, const Pose& X_WC, Vector3* lower, Vector3* upper) {
  const Vector3 half = X_WC.linear().cwiseAbs() * halfExtents(box), centre = X_WC * box.center();
  *lower = centre - half;
  *upper = centre + half;
}

/** Smallest signed distance [m] from the half-space's plane to the box of another collider; negative below it. */
double boxAbovePlane(const CollisionGeometry& half_space, const Pose& X_WH, const Box& box, const Pose& X_WC) {
  const Vector3 normal_W = X_WH.linear() * half_space.planeNormal();
  const double offset_W = half_space.planeOffset() + normal_W.dot(X_WH.translation());
  const Vector3 normal_C = X_WC.linear().transpose() * normal_W;
  return normal_W.dot(X_WC * box.center()) - normal_C.cwiseAbs().dot(halfExtents(box)) - offset_W;
}

}  // namespace

class BroadPhase::Search {
 public:
  Search(BroadPhase* space, const std::vector<Collider>& colliders, const std::vector<ColliderMotion>& motion,
         const CollisionFilter& filter, double base_margin, double max_margin)
      : space_(*space), colliders_(colliders), motion_(motion), filter_(filter), base_margin_(base_margin), max_margin_(max_margin) {}

  void run() {
    space_.half_spaces_.clear();
    space_.boxes_.clear();
    space_.pairs_.clear();
    for (int i = 0; i < static_cast<int>(colliders_.size()); ++i) {
      if (colliders_[i].enabled && colliders_[i].geometry) enter(i);
    }
    for (const int half_space : space_.half_spaces_) {
      for (const SweepBox& box : space_.boxes_) meetHalfSpace(half_space, box);
    }
    sweep();
    std::sort(space_.pairs_.begin(), space_.pairs_.end(),
              [](const ColliderPair& p, const ColliderPair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  }

 private:
  void enter(int i) {
    if (colliders_[i].geometry->isHalfSpace()) {
      space_.half_spaces_.push_back(i);
      return;
    }
    const int model = colliders_[i].model >= 0 && !filter_.selfCollides(colliders_[i].model) ? colliders_[i].model : -1;
    SweepBox box{i, model, {}, {}, colliders_[i].radius + std::min(max_margin_, std::max(0.5 * base_margin_, motion_[i].reach))};
    turn(colliders_[i].geometry->bounds(), motion_[i].X_WC, &box.lower, &box.upper);
    // A state that is not finite is the step's to report; here it would only upset the order.
    if (box.lower.allFinite() && box.upper.allFinite()) space_.boxes_.push_back(box);
  }

  double margin(int i, int j) const { return std::min(max_margin_, std::max(base_margin_, motion_[i].reach + motion_[j].reach)); }

  /** Furthest distance [m] at which the pair matters. */
  double range(int i, int j) const { return colliders_[i].radius + colliders_[j].radius + margin(i, j); }

  void add(int i, int j) { space_.pairs_.push_back({std::min(i, j), std::max(i, j), margin(i, j)}); }

  void meetHalfSpace(int half_space, const SweepBox& box) {
    const int i = box.collider;
    if (!filter_.allows(colliders_[half_space], colliders_[i])) return;
    const double height =
        boxAbovePlane(*colliders_[half_space].geometry, motion_[half_space].X_WC, colliders_[i].geometry->bounds(), motion_[i].X_WC);
    if (height <= range(half_space, i)) add(half_space, i);
  }

  /** Axis along which the boxes' centres are spread most. */
  int sweepAxis() const {
    Vector3 sum = Vector3::Zero(), sum_of_squares = Vector3::Zero();
    for (const SweepBox& box : space_.boxes_) {
      const Vector3 centre = 0.5 * (box.lower + box.upper);
      sum += centre;
      sum_of_squares += centre.cwiseAbs2();
    }
    int axis = 0;
    (sum_of_squares - sum.cwiseAbs2() / std::max<double>(1, space_.boxes_.size())).maxCoeff(&axis);
    return axis;
  }

  void sweep() {
    const int axis = sweepAxis();
    std::vector<SweepStart>& starts = space_.starts_;
    starts.clear();
    for (std::size_t i = 0; i < space_.boxes_.size(); ++i)
      starts.push_back({space_.boxes_[i].lower[axis] - space_.boxes_[i].reach, static_cast<int>(i), space_.boxes_[i].model});
    // Boxes are in the order of their colliders.
    std::sort(starts.begin(), starts.end(),
              [](const SweepStart& p, const SweepStart& q) { return p.at < q.at || (p.at == q.at && p.box < q.box); });
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const SweepBox& box = space_.boxes_[starts[i].box];
      const double end = box.upper[axis] + box.reach;
      for (std::size_t j = i + 1; j < starts.size() && starts[j].at <= end; ++j) {
        if (box.model < 0 || starts[j].model != box.model) meet(box, space_.boxes_[starts[j].box]);
      }
    }
  }

  void meet(const SweepBox& box, const SweepBox& other) {
    const Vector3 gap = (box.lower - other.upper).cwiseMax(other.lower - box.upper).cwiseMax(0.0);
    const double furthest = range(box.collider, other.collider);
    if (gap.squaredNorm() > furthest * furthest) return;
    if (filter_.allows(colliders_[box.collider], colliders_[other.collider])) add(box.collider, other.collider);
  }

  BroadPhase& space_;
  const std::vector<Collider>& colliders_;
  const std::vector<ColliderMotion>& motion_;
  const CollisionFilter& filter_;
  const double base_margin_, max_margin_;
};

void CollisionFilter::setSelfCollision(int model, bool on) {
  if (on) {
    self_colliding_models_.insert(model);
  } else {
    self_colliding_models_.erase(model);
  }
}

void CollisionFilter::disableBodies(int body_a, int body_b) { disabled_bodies_.insert(std::minmax(body_a, body_b)); }

bool CollisionFilter::allows(const Collider& a, const Collider& b) const {
  if (!a.enabled || !b.enabled || a.body == b.body) return false;
  if (a.model == b.model && a.model >= 0 && !selfCollides(a.model)) return false;
  return disabled_bodies_.count(std::minmax(a.body, b.body)) == 0;
}

const std::vector<ColliderPair>& BroadPhase::find(const std::vector<Collider>& colliders, const std::vector<ColliderMotion>& motion,
                                                  const CollisionFilter& filter, double base_margin, double max_margin) {
  Search(this, colliders, motion, filter, base_margin, max_margin).run();
  return pairs_;
}

}  // namespace blem_sim
