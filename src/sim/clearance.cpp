#include "blem_sim/sim/clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {
namespace {

/** By lumped body of a robot: the first of those that are held together with it, and the first of those that it hangs on (-1: none). */
struct RigidParts {
  explicit RigidParts(const model::LumpedRobot& robot) : first(robot.bodies.size(), 0), parent(robot.bodies.size(), -1) {
    for (const model::LumpedJoint& joint : robot.joints) {
      const int above = first[static_cast<std::size_t>(joint.parent)];
      const bool fixed = joint.type == model::JointType::FIXED;
      first[static_cast<std::size_t>(joint.child)] = fixed ? above : joint.child;
      parent[static_cast<std::size_t>(joint.child)] = fixed ? parent[static_cast<std::size_t>(above)] : above;
    }
  }
  bool areNeighbours(int a, int b) const {
    const auto at = [](const std::vector<int>& list, int body) { return list[static_cast<std::size_t>(body)]; };
    return at(first, a) == at(first, b) || at(parent, a) == at(first, b) || at(parent, b) == at(first, a);
  }

  std::vector<int> first, parent;
};

/** The deepest contact of a pair, if there is one. */
const contact::Contact* deepest(const contact::ContactManifold& manifold) {
  const auto found = std::max_element(manifold.contacts.begin(), manifold.contacts.end(),
                                      [](const contact::Contact& p, const contact::Contact& q) { return p.depth < q.depth; });
  return found == manifold.contacts.end() ? nullptr : &*found;
}

}  // namespace

RobotClearance::RobotClearance(const Simulator& simulator, int robot)
    : model_(simulator.robots().at(static_cast<std::size_t>(robot)).model), colliders_(simulator.colliders()) {
  const RobotInfo& info = simulator.robots()[static_cast<std::size_t>(robot)];
  for (const model::LinkModel& link : info.description->links) links_.push_back(link.name);
  X_LC_.resize(colliders_.size(), Pose::Identity());
  motion_.resize(colliders_.size());
  for (std::size_t k = 0; k < colliders_.size(); ++k) {
    const contact::Collider& collider = colliders_[k];
    names_.push_back(collider.name);
    const bool stands = !collider.enabled || collider.body == dynamics::WORLD_BODY;
    motion_[k].X_WC = stands ? collider.X_BC : simulator.world().bodyState(collider.body).X_WB * collider.X_BC;
    if (collider.model == model_) X_LC_[k] = simulator.linkPose(robot, collider.link).inverse() * motion_[k].X_WC;
  }
  filter_.setSelfCollision(model_, true);
  leaveOutNeighbours(info);
  leaveOutListed(simulator, info);
  leaveOutCrossing();
}

void RobotClearance::leaveOutNeighbours(const RobotInfo& robot) {
  const RigidParts parts(*robot.lumped);
  const auto part = [&](std::size_t collider) {
    return robot.lumped->link_placement[static_cast<std::size_t>(colliders_[collider].link)].body;
  };
  for (std::size_t a = 0; a < colliders_.size(); ++a)
    for (std::size_t b = a + 1; b < colliders_.size(); ++b)
      if (isOwn(static_cast<int>(a)) && isOwn(static_cast<int>(b)) && parts.areNeighbours(part(a), part(b)))
        left_out_.emplace(static_cast<int>(a), static_cast<int>(b));
}

void RobotClearance::leaveOutListed(const Simulator& simulator, const RobotInfo& robot) {
  for (const RobotConfig& config : simulator.config().robots) {
    if (config.name != robot.name) continue;
    for (const auto& [first, second] : config.disable_collisions) {
      const int link_a = robot.description->linkIndex(first), link_b = robot.description->linkIndex(second);
      for (int a = 0; a < static_cast<int>(colliders_.size()); ++a)
        for (int b = 0; b < static_cast<int>(colliders_.size()); ++b)
          if (isOwn(a) && isOwn(b) && colliders_[static_cast<std::size_t>(a)].link == link_a &&
              colliders_[static_cast<std::size_t>(b)].link == link_b)
            left_out_.insert(std::minmax(a, b));
    }
  }
}

void RobotClearance::leaveOutCrossing() {
  std::vector<Pose> X_WL(links_.size(), Pose::Identity());
  for (std::size_t k = 0; k < colliders_.size(); ++k)
    if (isOwn(static_cast<int>(k))) X_WL[static_cast<std::size_t>(colliders_[k].link)] = motion_[k].X_WC * X_LC_[k].inverse();
  for (const Approach& approach : find(X_WL, 0))
    if (approach.crossed && isOwn(approach.b)) left_out_.insert(std::minmax(approach.a, approach.b));
}

std::vector<Approach> RobotClearance::find(const std::vector<Pose>& X_WL, double distance) {
  if (X_WL.size() != links_.size())
    throw InputError(fmt::format("poses: {} were given; the robot has {} links", X_WL.size(), links_.size()));
  if (!(distance >= 0 && distance <= geometry::FARTHEST_PLACE)) throw InputError("distance: must be a number from 0 on");
  std::vector<contact::ColliderMotion> motion = motion_;
  for (std::size_t k = 0; k < colliders_.size(); ++k)
    if (isOwn(static_cast<int>(k))) motion[k].X_WC = X_WL[static_cast<std::size_t>(colliders_[k].link)] * X_LC_[k];
  std::vector<Approach> approaches;
  for (const contact::ColliderPair& pair : broad_phase_.find(colliders_, motion, filter_, distance, distance)) {
    if ((!isOwn(pair.a) && !isOwn(pair.b)) || left_out_.count({pair.a, pair.b}) > 0) continue;
    const int a = isOwn(pair.a) ? pair.a : pair.b, b = isOwn(pair.a) ? pair.b : pair.a;
    const auto placed = [&](int k) {
      return contact::PlacedCollider{colliders_[static_cast<std::size_t>(k)], motion[static_cast<std::size_t>(k)].X_WC};
    };
    contact::NarrowPhaseQuestion question;
    question.margin = distance;
    contact::ContactManifold found;
    contact::narrowPhase(placed(a), placed(b), question, &workspace_, &found);
    if (const contact::Contact* nearest = deepest(found))
      approaches.push_back({a, b, -nearest->depth, found.pierced, nearest->point, nearest->normal_BA});
  }
  return approaches;
}

}  // namespace blem_sim::sim
