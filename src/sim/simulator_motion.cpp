// Bodies that are put elsewhere between steps, and resets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/geometry/input_error.h"
#include "config/scene_limits.h"
#include "numbers/nearest_name.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

constexpr double SAME_PLACE = 1e-6;  // of a fixed base's pose

/** Motion of a frame of a robot: its pose, and the velocity of its origin and of its axes. */
struct FrameMotion {
  Pose X_WF = Pose::Identity();
  Vector3 v = Vector3::Zero(), w = Vector3::Zero();
};

void checkState(const dynamics::BodyState& state) {
  const auto within = [](const Vector3& v, double most) { return (v.array().abs() <= most).all(); };
  if (!state.X_WB.matrix().allFinite() || !within(state.X_WB.translation(), geometry::FARTHEST_PLACE))
    throw InputError(fmt::format("pose: needs finite numbers, not beyond {:g} m", geometry::FARTHEST_PLACE));
  if (!within(state.v_WCom, FASTEST) || !within(state.w_WB, FASTEST))
    throw InputError(fmt::format("twist: needs finite numbers, not beyond {:g} m/s and rad/s", FASTEST));
}

/** Motion of a joint's child from its parent's. @param rate [rad/s or m/s] */
FrameMotion childOf(const FrameMotion& parent, const model::LumpedJoint& joint, double position, double rate) {
  FrameMotion child;
  child.X_WF = parent.X_WF * joint.pose(position);
  const Vector3 axis = parent.X_WF.linear() * joint.X_PJ.linear() * joint.axis;
  const bool slides = joint.type == model::JointType::PRISMATIC,
             turns = joint.type == model::JointType::REVOLUTE || joint.type == model::JointType::CONTINUOUS;
  child.w = parent.w;
  if (turns) child.w += rate * axis;
  child.v = parent.v + parent.w.cross(child.X_WF.translation() - parent.X_WF.translation());
  if (slides) child.v += rate * axis;
  return child;
}

FrameMotion motionOf(const dynamics::World& world, int body) {
  const dynamics::BodyState state = world.bodyState(body);
  const Vector3 arm = state.X_WB.linear() * world.bodySpec(body).inertial.com;
  return {state.X_WB, state.v_WCom - state.w_WB.cross(arm), state.w_WB};
}

dynamics::BodyState stateOf(const dynamics::World& world, int body, const FrameMotion& motion) {
  const Vector3 arm = motion.X_WF.linear() * world.bodySpec(body).inertial.com;
  return {motion.X_WF, motion.v + motion.w.cross(arm), motion.w};
}

/** Positions and rates of a robot's lumped joints. */
struct JointValues {
  std::vector<double> positions, rates;
};

JointValues valuesOf(const dynamics::World& world, const RobotInfo& robot) {
  JointValues values;
  for (const int joint : robot.world_joints) {
    const dynamics::JointState state = joint < 0 ? dynamics::JointState() : world.jointState(joint);
    values.positions.push_back(state.position);
    values.rates.push_back(state.velocity);
  }
  return values;
}

/** Makes mimic joints follow their masters, through chains of them. */
void followMasters(const model::LumpedRobot& robot, JointValues* values) {
  const auto indexOf = [&](const std::string& name) {
    return std::find_if(robot.joints.begin(), robot.joints.end(), [&](const model::LumpedJoint& j) { return j.name == name; }) -
           robot.joints.begin();
  };
  for (std::size_t link = 0; link < robot.joints.size(); ++link) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      if (!robot.joints[j].mimic) continue;
      const model::Mimic& mimic = *robot.joints[j].mimic;
      const auto master = static_cast<std::size_t>(indexOf(mimic.joint));
      values->positions[j] = mimic.multiplier * values->positions[master] + mimic.offset;
      values->rates[j] = mimic.multiplier * values->rates[master];
    }
  }
}

std::string withoutScope(const std::string& joint, const std::string& model) {
  return joint.compare(0, model.size() + 2, model + "::") == 0 ? joint.substr(model.size() + 2) : joint;
}

/** Index of each joint named, among the robot's lumped joints. */
std::vector<std::size_t> indicesOf(const RobotInfo& robot, const std::vector<std::string>& names, const std::vector<double>& positions) {
  const std::string where = "robot '" + robot.name + "'";
  if (names.size() != positions.size())
    throw InputError(fmt::format("{}: {} joint_positions for {} joint_names; give one each", where, positions.size(), names.size()));
  std::vector<std::size_t> indices;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = withoutScope(names[i], robot.name);
    requireName(name, robot.joint_names, where, "movable joint");
    if (!seen.insert(name).second) throw InputError(fmt::format("{}: joint '{}' is there twice; name it once", where, name));
    if (!isCommand(positions[i])) throw InputError(fmt::format("{}: joint '{}': {} is no position", where, name, positions[i]));
    const std::vector<model::LumpedJoint>& joints = robot.lumped->joints;
    const auto joint = std::find_if(joints.begin(), joints.end(), [&](const model::LumpedJoint& j) { return j.name == name; });
    if (joint->mimic) throw InputError(fmt::format("{}: joint '{}' mimics '{}'; set that one", where, name, joint->mimic->joint));
    indices.push_back(joint - joints.begin());
  }
  return indices;
}

}  // namespace

int Simulator::Impl::modelOfBody(int body) const {
  const auto& models = world_.models;
  const auto has = [body](const ModelInfo& model) {
    return std::find(model.bodies.begin(), model.bodies.end(), body) != model.bodies.end();
  };
  return static_cast<int>(std::find_if(models.begin(), models.end(), has) - models.begin());
}

void Simulator::Impl::moveModel(int body, const dynamics::BodyState& to) {
  checkState(to);
  const int model = modelOfBody(body), robot = world_.robotOf(model);
  const dynamics::BodyState from = world_.world.bodyState(body);
  if (robot >= 0 && world_.robots[robot].fixed_base) {
    if (to.X_WB.isApprox(from.X_WB, SAME_PLACE)) return;
    throw InputError(fmt::format("'{}' has a fixed base; set_model_configuration moves its joints, delete and spawn it to move the base",
                                 world_.models[model].name));
  }
  if (const AttachedModel* by = carrierOf(model))
    throw InputError(fmt::format("'{}' is attached to '{}'; detach it first", by->object, by->part.name));
  moveRigidly(model, body, to);
  carryAlong(model);
  reportWithoutStep();
}

void Simulator::Impl::moveRigidly(int model, int body, const dynamics::BodyState& to) {
  const Pose move = to.X_WB * world_.world.bodyState(body).X_WB.inverse();
  const Vector3 p_WCom = to.X_WB * world_.world.bodySpec(body).inertial.com;
  for (const int each : world_.models[model].bodies) {
    dynamics::BodyState state = to;
    if (each != body) {
      state.X_WB = move * world_.world.bodyState(each).X_WB;
      state.v_WCom += to.w_WB.cross(state.X_WB * world_.world.bodySpec(each).inertial.com - p_WCom);
    }
    world_.world.setBodyState(each, state);
  }
  forgetContacts(world_.collidersOf(model));
}

void Simulator::Impl::setJointPositions(int index, const std::vector<std::string>& names, const std::vector<double>& positions) {
  const RobotInfo& robot = world_.robots.at(index);
  const std::vector<model::LumpedJoint>& joints = robot.lumped->joints;
  const std::vector<std::size_t> set = indicesOf(robot, names, positions);
  JointValues values = valuesOf(world_.world, robot);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const dynamics::JointSpec& limits = world_.world.jointSpec(robot.world_joints[set[i]]);
    values.positions[set[i]] = std::clamp(positions[i], limits.lower, limits.upper);
    values.rates[set[i]] = 0;
  }
  followMasters(*robot.lumped, &values);
  std::vector<FrameMotion> motion(robot.bodies.size());
  motion[0] = robot.bodies[0] == dynamics::WORLD_BODY ? FrameMotion{robot.X_WR} : motionOf(world_.world, robot.bodies[0]);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int child = joints[j].child, joint = robot.world_joints[j];
    if (joint < 0) {
      motion[child] = motionOf(world_.world, robot.bodies[child]);
      continue;
    }
    motion[child] = childOf(motion[joints[j].parent], joints[j], values.positions[j], values.rates[j]);
    world_.world.setBodyState(robot.bodies[child], stateOf(world_.world, robot.bodies[child], motion[child]));
    world_.world.resetJointPosition(joint, values.positions[j]);
  }
  for (const std::size_t j : set) world_.motors[robot.world_joints[j]].hold(values.positions[j]);
  forgetContacts(world_.collidersOf(robot.model));
  carryAlong(robot.model);
  reportWithoutStep();
}

void Simulator::Impl::restart(const ModelInfo& model, int robot) {
  for (const int body : model.bodies) {
    world_.world.setBodyState(body, world_.start_states[body]);
    loads_.clearBody(body);
    base_drives_.clearBody(body);
  }
  if (robot < 0) return;
  for (const int joint : world_.robots[robot].world_joints) {
    if (joint < 0) continue;
    world_.world.resetJointPosition(joint, world_.start_positions[joint]);
    world_.motors[joint].reset();
    loads_.clearJoint(joint);
  }
  sensors_.resetOf(world_, robot);
  moveIntoLimits(robot);
}

void Simulator::Impl::moveIntoLimits(int index) {
  const RobotInfo& robot = world_.robots[index];
  std::vector<std::string> names;
  std::vector<double> positions;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const dynamics::JointSpec& limits = world_.world.jointSpec(robot.joints[j]);
    const double start = world_.start_positions[robot.joints[j]];
    if (!robot.driven[j] || (limits.lower <= start && start <= limits.upper)) continue;
    names.push_back(robot.joint_names[j]);
    positions.push_back(start);
  }
  if (!names.empty()) setJointPositions(index, names, positions);
}

void Simulator::Impl::resetModel(int index) {
  requireAlive(index);
  detachAll(index);
  restart(world_.models.at(index), world_.robotOf(index));
  forgetContacts(world_.collidersOf(index));
  reportWithoutStep();
}

void Simulator::Impl::resetWorld() {
  while (!world_.attachments.empty()) removeAttachment(0);
  for (std::size_t i = 0; i < world_.models.size(); ++i)
    if (world_.models[i].alive) restart(world_.models[i], world_.robotOf(static_cast<int>(i)));
  world_.world.setJointEfforts(std::vector<double>(world_.world.jointCount(), 0));
  world_.world.forgetHistory();
  stopped_ = false;
  endFading();
  constraint_maker_.memory().clear();
  constraint_maker_.stops().clear();
  at_hand_.crossings.clear();
  layer_watch_.clear();
  energy_balance_.clear();
  most_ticks_ = Substeps::MAX_SUBSTEPS;
  at_hand_.known = false;
  reportWithoutStep();
}

}  // namespace blem_sim::sim
