#include "blem_sim/sim/link_motion.h"

#include <algorithm>

namespace blem_sim::sim {

namespace {
/** Motion of a frame F that is fixed on the body. */
LinkMotion frameMotion(const Simulator& simulator, const StepReport& report, int body, const Pose& X_BF) {
  const dynamics::BodyState& state = report.bodies[body];
  LinkMotion motion;
  motion.X_WL = state.X_WB * X_BF;
  motion.w_WL = state.w_WB;
  const Vector3 p_WCom = state.X_WB * simulator.world().bodySpec(body).inertial.com;
  motion.v_WL = state.v_WCom + state.w_WB.cross(motion.X_WL.translation() - p_WCom);
  return motion;
}
}  // namespace

LinkMotion partMotion(const Simulator& simulator, const LinkPart& part) {
  if (part.body != dynamics::WORLD_BODY) return frameMotion(simulator, simulator.report(), part.body, part.X_BL);
  LinkMotion fixed;
  fixed.X_WL = part.X_BL;
  return fixed;
}

LinkMotion linkMotion(const Simulator& simulator, const StepReport& report, const RobotInfo& robot, int link) {
  const model::LinkPlacement& placement = robot.lumped->link_placement[link];
  const int body = robot.bodies[placement.body];
  if (body != dynamics::WORLD_BODY) return frameMotion(simulator, report, body, placement.X_BL);
  LinkMotion fixed;
  fixed.X_WL = robot.X_WR * placement.X_BL;
  return fixed;
}

LinkMotion bodyMotion(const Simulator& simulator, const StepReport& report, int body) {
  return frameMotion(simulator, report, body, Pose::Identity());
}

LinkMotion modelMotion(const Simulator& simulator, const StepReport& report, int model) {
  const ModelInfo& info = simulator.models()[model];
  if (info.kind == ModelKind::ROBOT) {
    // Robots come in the order of their models.
    const auto robot = std::partition_point(simulator.robots().begin(), simulator.robots().end(),
                                            [model](const RobotInfo& other) { return other.model < model; });
    return linkMotion(simulator, report, *robot, robot->description->root);
  }
  if (info.kind == ModelKind::OBJECT) return bodyMotion(simulator, report, info.bodies.front());
  LinkMotion environment;
  environment.X_WL = info.X_WM;
  return environment;
}

}  // namespace blem_sim::sim
