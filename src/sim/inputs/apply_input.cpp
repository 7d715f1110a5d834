#include <fmt/format.h>

#include <map>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "blem_sim/sim/state_file.h"
#include "inputs/input_reader.h"

namespace blem_sim::sim {

namespace {

using Call = void (*)(InputReader& in, Simulator& to);

// In each row arguments are read in the order in which the Simulator's method tells them.
const std::map<std::string, Call> CALLS = {
    {"commandTrajectory",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot();
       to.commandTrajectory(robot, in.take<JointTrajectory>());
     }},
    {"commandJoints",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot();
       to.commandJoints(robot, in.take<JointCommandMessage>());
     }},
    {"driveJoints",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot();
       to.driveJoints(robot, in.take<JointVelocityCommand>());
     }},
    {"driveBase",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot();
       const auto link = in.take<int>();
       to.driveBase(robot, link, in.take<BaseVelocityCommand>());
     }},
    {"releaseBase", [](InputReader& in, Simulator& to) { to.releaseBase(in.takeRobot()); }},
    {"holdJoint",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot(), joint = in.takeJointOf(robot);
       to.holdJoint(robot, joint, in.takeCommand());
     }},
    {"loadEnvironment", [](InputReader& in, Simulator& to) { to.loadEnvironment(in.take<EnvironmentConfig>()); }},
    {"unloadEnvironment", [](InputReader& in, Simulator& to) { to.unloadEnvironment(in.take<std::string>()); }},
    {"updateCloud",
     [](InputReader& in, Simulator& to) {
       const auto environment = in.take<std::string>();
       auto surface = in.take<CloudSurface>();
       to.updateCloud(environment, &surface);
     }},
    {"spawn", [](InputReader& in, Simulator& to) { to.spawn(in.take<RobotConfig>()); }},
    {"removeModel", [](InputReader& in, Simulator& to) { to.removeModel(in.take<std::string>()); }},
    {"attach",
     [](InputReader& in, Simulator& to) {
       const auto object = in.take<std::string>(), part = in.take<std::string>();
       const auto max_force = in.take<double>();
       to.attach(object, findLink(to, part, "attach"), max_force, in.take<double>());
     }},
    {"detach", [](InputReader& in, Simulator& to) { to.detach(in.take<std::string>()); }},
    {"moveModel",
     [](InputReader& in, Simulator& to) {
       const int body = in.takeBody();
       to.moveModel(body, in.take<dynamics::BodyState>());
     }},
    {"setJointPositions",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot();
       const auto joints = in.take<std::vector<std::string>>();
       to.setJointPositions(robot, joints, in.take<std::vector<double>>());
     }},
    {"resetModel", [](InputReader& in, Simulator& to) { to.resetModel(in.takeModel()); }},
    {"applyLoad",
     [](InputReader& in, Simulator& to) {
       const int body = in.takeBody();
       auto load = in.take<BodyLoad>();
       load.body = body;
       to.applyLoad(load, in.take<LoadTime>());
     }},
    {"applyEffort",
     [](InputReader& in, Simulator& to) {
       const int joint = in.takeJoint();
       const auto effort = in.take<double>();
       to.applyEffort(joint, effort, in.take<LoadTime>());
     }},
    {"clearLoads", [](InputReader& in, Simulator& to) { to.clearLoads(in.takeBody()); }},
    {"clearEfforts", [](InputReader& in, Simulator& to) { to.clearEfforts(in.takeJoint()); }},
    {"tareSensor", [](InputReader& in, Simulator& to) { to.tareSensor(in.takeSensor()); }},
    {"setPhysics",
     [](InputReader& in, Simulator& to) {
       const auto gravity = in.take<Vector3>();
       const auto time_step = in.take<double>();
       to.setPhysics(gravity, time_step, in.take<double>());
     }},
    {"setLinkInertial",
     [](InputReader& in, Simulator& to) {
       const int body = in.takeBody(), link = in.takeLinkOf(body);
       to.setLinkInertial(body, link, in.takeInertial());
     }},
    {"setLinkGravity",
     [](InputReader& in, Simulator& to) {
       const int body = in.takeBody(), link = in.takeLinkOf(body);
       to.setLinkGravity(body, link, in.take<bool>());
     }},
    {"setJointDamping",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot(), joint = in.takeJointOf(robot);
       to.setJointDamping(robot, joint, in.take<double>());
     }},
    {"setMotorGains",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot(), joint = in.takeJointOf(robot);
       to.setMotorGains(robot, joint, in.take<JointGains>());
     }},
    {"setFriction",
     [](InputReader& in, Simulator& to) {
       const int model = in.takeModel();
       to.setFriction(model, in.take<double>());
     }},
    {"setJointLimits",
     [](InputReader& in, Simulator& to) {
       const int robot = in.takeRobot(), joint = in.takeJointOf(robot);
       const auto lower = in.take<double>();
       to.setJointLimits(robot, joint, lower, in.take<double>());
     }},
    {"resetWorld", [](InputReader&, Simulator& to) { to.resetWorld(); }},
    {"resetSimulation", [](InputReader&, Simulator& to) { to.resetSimulation(); }},
};

}  // namespace

void applyInput(const SimulatorInput& input, Simulator* simulator) {
  if (input.call == "restore") return simulator->restore(stateOf(input.state, "input 'restore'"));
  const auto call = CALLS.find(input.call);
  if (call == CALLS.end())
    throw InputError(fmt::format("input '{:.60}': there is no such call; replay with the version that recorded", input.call));
  InputReader arguments(input, *simulator);
  call->second(arguments, *simulator);
  arguments.finish();
}

}  // namespace blem_sim::sim
