#include <algorithm>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/model/robot_model.h"
#include "inertia.h"
#include "mimic_limits.h"

namespace blem_sim::model {
namespace {

/** Mass of each of the two bodies between the three joints of a planar joint, as a part of the mass they carry. */
constexpr double VIRTUAL_MASS_RATIO = 1e-3;

/** Builds bodies and joints in the order of the model's joints, which is parents first. */
class Lumping {
 public:
  Lumping(const RobotModel& robot, const std::set<std::string>& keep) : robot_(robot), keep_(keep) {
    lumped_.link_placement.resize(robot.links.size());
  }

  LumpedRobot run(bool fixed_base) {
    startBody(robot_.root);
    for (const JointModel& joint : robot_.joints) {
      if (joint.type == JointType::FIXED && keep_.count(joint.name) == 0)
        joinBody(joint);
      else
        addJoint(joint);
    }
    for (std::size_t body = 0; body < lumped_.bodies.size(); ++body) addInertial(static_cast<int>(body), body == 0 && fixed_base);
    addVirtualInertials();
    bringLimitsTogether(&lumped_);
    return std::move(lumped_);
  }

 private:
  int startBody(int link) {
    const int body = static_cast<int>(lumped_.bodies.size());
    lumped_.bodies.push_back({robot_.links[link].name, {link}, {}});
    lumped_.link_placement[link] = {body, Pose::Identity()};
    return body;
  }

  void joinBody(const JointModel& joint) {
    const LinkPlacement& parent = lumped_.link_placement[joint.parent];
    lumped_.link_placement[joint.child] = {parent.body, parent.X_BL * joint.X_PJ};
    lumped_.bodies[parent.body].links.push_back(joint.child);
  }

  LumpedJoint movingJoint(const JointModel& joint) const {
    LumpedJoint moving;
    moving.name = joint.name;
    moving.type = joint.type;
    moving.parent = lumped_.link_placement[joint.parent].body;
    moving.X_PJ = lumped_.link_placement[joint.parent].X_BL * joint.X_PJ;
    moving.axis = joint.axis;
    moving.limits = joint.limits;
    moving.dry_friction = joint.dry_friction;
    moving.viscous_friction = joint.viscous_friction;
    moving.mimic = joint.mimic;
    moving.safety = joint.safety;
    return moving;
  }

  void addJoint(const JointModel& joint) {
    if (joint.type == JointType::PLANAR) return addPlanarJoint(joint);
    LumpedJoint moving = movingJoint(joint);
    moving.child = startBody(joint.child);
    lumped_.joints.push_back(moving);
  }

  /** Adds two slides and a turn, a virtual body after each slide. Axes x, y and the normal are right-handed; for normal z they are x, y, z.
   */
  void addPlanarJoint(const JointModel& joint) {
    int largest = 0;
    joint.axis.cwiseAbs().maxCoeff(&largest);
    const Vector3 seed = Vector3::Unit((largest + 1) % 3);
    const Vector3 x = (seed - joint.axis * joint.axis.dot(seed)).normalized();
    const Vector3 axes[3] = {x, joint.axis.cross(x), joint.axis};
    const char* const suffixes[3] = {"/x", "/y", "/yaw"};
    LumpedJoint moving = movingJoint(joint);
    for (int i = 0; i < 3; ++i) {
      moving.name = joint.name + suffixes[i];
      moving.type = i < 2 ? JointType::PRISMATIC : JointType::CONTINUOUS;
      moving.axis = axes[i];
      moving.child = i < 2 ? static_cast<int>(lumped_.bodies.size()) : startBody(joint.child);
      if (i < 2) lumped_.bodies.push_back({moving.name, {}, {}});
      lumped_.joints.push_back(moving);
      moving.parent = moving.child;
      moving.X_PJ = Pose::Identity();
    }
    lumped_.notes.push_back(
        fmt::format("planar joint '{0}' becomes the joints {0}/x, {0}/y and {0}/yaw; what slides on them weighs {1:.1f} % more", joint.name,
                    200 * VIRTUAL_MASS_RATIO));
  }

  /** Whether a fixed joint was kept at the root link of a body. */
  bool isKeptApart(const LumpedBody& body) const {
    return std::any_of(robot_.joints.begin(), robot_.joints.end(),
                       [&](const JointModel& joint) { return joint.child == body.links.front() && joint.type == JointType::FIXED; });
  }

  void addInertial(int index, bool is_fixed_base) {
    LumpedBody& body = lumped_.bodies[index];
    if (body.links.empty()) return;
    bool given = false;
    for (int link : body.links) {
      const std::optional<Inertial>& inertial = robot_.links[link].inertial;
      if (!inertial) continue;
      given = true;
      body.inertial = sum(body.inertial, movedTo(lumped_.link_placement[link].X_BL, *inertial));
    }
    if (is_fixed_base) return;
    const std::string who = fmt::format("{}: link '{}'", robot_.source, body.name);
    if (!given) takeInertialOfShapes(&body);
    if (!(body.inertial.mass > 0) && isKeptApart(body))
      throw InputError(
          fmt::format("{}: a force_torque sensor at its fixed joint keeps it a body of its own, but its mass is {:g} kg; give it a "
                      "positive mass, or leave the sensor out",
                      who, body.inertial.mass));
    if (!(body.inertial.mass > 0))
      throw InputError(fmt::format("{}: it moves, but its mass is {:g} kg; give it a positive mass", who, body.inertial.mass));
    repairInertia({robot_.source, fmt::format("link '{}'", body.name)}, &body.inertial, &lumped_.notes);
  }

  void takeInertialOfShapes(LumpedBody* body) {
    bool any = false;
    for (int link : body->links) {
      const std::optional<Inertial> inertial = inertialOfShapes(robot_.links[link].collisions);
      if (!inertial) continue;
      any = true;
      body->inertial = sum(body->inertial, movedTo(lumped_.link_placement[link].X_BL, *inertial));
    }
    if (!any) body->inertial = smallBall();
    lumped_.notes.push_back(
        fmt::format("link '{}' has no <inertial>: {:.4g} kg from {}", body->name, body->inertial.mass,
                    any ? "its collision shapes at 1000 kg/m^3 (open ones as a shell of 1 mm)" : "a ball of 1 cm stands in"));
  }

  /** Sets the inertials of virtual bodies, from the last joint back, so that the body that a virtual one carries is known. */
  void addVirtualInertials() {
    for (auto joint = lumped_.joints.rbegin(); joint != lumped_.joints.rend(); ++joint) {
      LumpedBody& parent = lumped_.bodies[joint->parent];
      if (!parent.links.empty()) continue;
      const Inertial& carried = lumped_.bodies[joint->child].inertial;
      const double ratio = lumped_.bodies[joint->child].links.empty() ? 1 : VIRTUAL_MASS_RATIO;
      parent.inertial = {ratio * carried.mass, Vector3::Zero(), ratio * carried.inertia.trace() / 3 * Matrix3::Identity()};
      if (ratio == 1) parent.inertial.inertia = carried.inertia;
    }
  }

  const RobotModel& robot_;
  const std::set<std::string>& keep_;
  LumpedRobot lumped_;
};

}  // namespace

LumpedRobot lumpFixedJoints(const RobotModel& robot, const std::set<std::string>& keep, bool fixed_base) {
  return Lumping(robot, keep).run(fixed_base);
}

}  // namespace blem_sim::model
