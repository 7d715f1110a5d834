#include "step_prediction.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim {
namespace {

constexpr double USED_UP = 0.9;    // of the distance between bare meshes
constexpr double PER_SOLVE = 0.5;  // layers that two bodies that touch may move in one solve
// A margin is at least 1.5 times the largest motion: what is slower than this is no danger to any layer.
constexpr double LEAST_MARGIN = 1.5 * PER_SOLVE;  // layers

/** Velocity of the points of a collider's body. */
struct Twist {
  Vector3 centre = Vector3::Zero(), v = Vector3::Zero(), w = Vector3::Zero();
  Vector3 at(const Vector3& p) const { return v + w.cross(p - centre); }
};

Twist twistOf(const SimulatedWorld& world, const std::vector<BodyState>& bodies, int collider) {
  const int body = world.colliders[collider].body;
  if (body == WORLD_BODY) return {};
  return {bodies[body].X_WB * world.world.bodySpec(body).inertial.com, bodies[body].v_WCom, bodies[body].w_WB};
}

/** World box of a collider's geometry, grown by `margin` [m]; everything for a half-space. */
Box boxOf(const Collider& collider, const Pose& X_WC, double margin) {
  const Box& box = collider.geometry->bounds();
  if (collider.geometry->isHalfSpace()) return box;
  const Vector3 half = X_WC.linear().cwiseAbs() * (0.5 * (box.max() - box.min())) + Vector3::Constant(margin), centre = X_WC * box.center();
  return Box(centre - half, centre + half);
}

class Prediction {
 public:
  Prediction(const SimulatedWorld& world, const ContactStage& contacts, const std::vector<BodyState>& bodies)
      : world_(world), contacts_(contacts), bodies_(bodies) {}

  double safeTime(const WatchedPair& pair, double time) const {
    const Collider &a = world_.colliders[pair.a], &b = world_.colliders[pair.b];
    const double layer = a.radius + b.radius;
    if (!(layer > 0) || pair.margin <= LEAST_MARGIN * layer) return time;
    const ContactManifold* manifold = findPair(contacts_.current(), pair.a, pair.b);
    const double gap = std::min(pair.known, manifold ? -manifold->maxDepth() : pair.known);  // between the layers, at least
    const double harmless = std::max(PER_SOLVE * layer, std::min(pair.known, USED_UP * (layer + gap)));
    const double speed = meetingSpeed(pair, layer + pair.margin);
    if (speed * time <= harmless) return time;
    return std::min(time, std::max(gap, PER_SOLVE * layer) / speed);
  }

 private:
  /** [m/s] Largest relative speed of the points that are within `reach` [m] of both. It is a convex function of place. */
  double meetingSpeed(const WatchedPair& pair, double reach) const {
    const Collider &a = world_.colliders[pair.a], &b = world_.colliders[pair.b];
    const Pose &X_WA = contacts_.motion()[pair.a].X_WC, &X_WB = contacts_.motion()[pair.b].X_WC;
    const Box common = boxOf(a, X_WA, reach).intersection(boxOf(b, X_WB, reach));
    if (common.isEmpty()) return 0;
    Vector3 towards = Vector3::Zero();  // the half-space's way in for A's points
    if (b.geometry->isHalfSpace()) towards = -(X_WB.linear() * b.geometry->planeNormal());
    if (a.geometry->isHalfSpace()) towards = X_WA.linear() * a.geometry->planeNormal();
    const Twist twist_a = twistOf(world_, bodies_, pair.a), twist_b = twistOf(world_, bodies_, pair.b);
    double fastest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 p = common.corner(static_cast<Box::CornerType>(corner)), v = twist_a.at(p) - twist_b.at(p);
      fastest = std::max(fastest, towards.isZero(0) ? v.norm() : towards.dot(v));
    }
    return fastest;
  }

  const SimulatedWorld& world_;
  const ContactStage& contacts_;
  const std::vector<BodyState>& bodies_;
};

}  // namespace

double safeTime(const SimulatedWorld& world, const ContactStage& contacts, const std::vector<BodyState>& bodies, double time) {
  const Prediction prediction(world, contacts, bodies);
  double safe = time;
  for (const WatchedPair& pair : contacts.watched()) safe = std::min(safe, prediction.safeTime(pair, time));
  return safe;
}

}  // namespace blem_sim
