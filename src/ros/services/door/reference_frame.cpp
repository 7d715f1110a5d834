#include "services/door/reference_frame.h"

#include "messages/conversions.h"

namespace blem_sim::node {

sim::LinkMotion frameMotion(const sim::Simulator& simulator, const std::string& frame, const std::string& where) {
  const std::optional<sim::LinkPart> part = sim::findFrame(simulator, frame, where);
  return part ? partMotion(simulator, *part) : sim::LinkMotion();
}

sim::LinkMotion seenFrom(const sim::LinkMotion& frame, const sim::LinkMotion& motion) {
  const Matrix3 R_FW = frame.X_WL.linear().transpose();
  return {frame.X_WL.inverse() * motion.X_WL, R_FW * (motion.v_WL - frame.v_WL), R_FW * (motion.w_WL - frame.w_WL)};
}

sim::LinkMotion inWorld(const sim::LinkMotion& frame, const geometry_msgs::Pose& pose, const geometry_msgs::Twist& twist,
                        const std::string& where) {
  const Matrix3& R_WF = frame.X_WL.linear();
  return {frame.X_WL * fromPose(pose, where), R_WF * fromVector3(twist.linear), R_WF * fromVector3(twist.angular)};
}

dynamics::BodyState bodyStateOf(const sim::Simulator& simulator, const sim::LinkPart& part, const sim::LinkMotion& motion) {
  dynamics::BodyState state;
  state.X_WB = motion.X_WL * part.X_BL.inverse();
  state.w_WB = motion.w_WL;
  const Vector3 p_WCom =
      part.body == dynamics::WORLD_BODY ? state.X_WB.translation() : state.X_WB * simulator.world().bodySpec(part.body).inertial.com;
  state.v_WCom = motion.v_WL + motion.w_WL.cross(p_WCom - motion.X_WL.translation());
  return state;
}

}  // namespace blem_sim::node
