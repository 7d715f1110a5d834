#include "wheels/wheel_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {
namespace {

const model::JointModel& axleOf(const ControllerConfig& controller, const std::string& wheel, const model::RobotModel& robot) {
  const int joint = robot.jointIndex(wheel);
  if (joint < 0)
    throw InputError(fmt::format("controller '{}': '{}' is no joint of the URDF; name a wheel's joint", controller.name, wheel));
  return robot.joints[joint];
}

/** A place [m] of a link in the root link, all joints at 0. */
Vector3 placeInRoot(Vector3 place, int link, const model::RobotModel& robot) {
  for (int joint = jointAbove(link, robot); joint >= 0; joint = jointAbove(robot.joints[joint].parent, robot))
    place = robot.joints[joint].X_PJ * place;
  return place;
}

Vector3 axlePlace(const model::JointModel& axle, const model::RobotModel& robot) {
  return placeInRoot(axle.X_PJ.translation(), axle.parent, robot);
}

/** [m]; 0 if none of its shapes is round. */
double radiusOf(const model::LinkModel& wheel) {
  for (const model::CollisionShape& shape : wheel.collisions)
    if (const double radius = shape.cylinder ? shape.cylinder->radius : shape.radius; radius > 0) return radius;
  return 0;
}

[[noreturn]] void refuseRadius(const ControllerConfig& controller, const std::string& key, const model::LinkModel& wheel) {
  throw InputError(
      fmt::format("controller '{}': {}: is missing, and link '{}' has no <cylinder> or <sphere> to take it from; give it in metres",
                  controller.name, key, wheel.name));
}

/** Takes a radius [m] that is 0 from a wheel. @throws InputError: it has none */
void measureRadius(const ControllerConfig& controller, const std::string& key, const model::LinkModel& wheel, double* radius) {
  if (*radius == 0) *radius = radiusOf(wheel);
  if (!(*radius > 0)) refuseRadius(controller, key, wheel);
}

/** @throws InputError: a side or an axle has no wheel, a driven one is there twice */
void requireWheels(const ControllerConfig& controller, const DriveConfig& drive) {
  const SteeringConfig& steering = drive.steering;
  const bool steers = controller.kind == ControllerKind::STEERED_DRIVE;
  if (!steers && (drive.left.empty() || drive.right.empty()))
    throw InputError(fmt::format("controller '{}': needs left_wheel and right_wheel", controller.name));
  if (steers && (steering.rear.empty() || steering.joints.empty()))
    throw InputError(fmt::format("controller '{}': needs rear_wheel and front_steer", controller.name));
  for (const std::string& wheel : steering.driven)
    if (std::count(steering.driven.begin(), steering.driven.end(), wheel) > 1)
      throw InputError(fmt::format("controller '{}': driven_wheel: '{}' is there twice; name it once", controller.name, wheel));
}

void measureSeparation(const ControllerConfig& controller, const model::RobotModel& robot, DriveConfig* drive) {
  const model::JointModel& left = axleOf(controller, drive->left.front(), robot);
  const model::JointModel& right = axleOf(controller, drive->right.front(), robot);
  if (drive->wheel_separation == 0) drive->wheel_separation = (axlePlace(left, robot) - axlePlace(right, robot)).norm();
  if (!(drive->wheel_separation > 0))
    throw InputError(
        fmt::format("controller '{}': wheel_separation: is missing, and the URDF has '{}' and '{}' at one place; give it in metres",
                    controller.name, left.name, right.name));
  drive->wheel_separation *= drive->separation_multiplier;
}

/** Radius of driven wheels that are none of the rear. */
void measureSteered(const ControllerConfig& controller, const model::RobotModel& robot, DriveConfig* drive) {
  const std::vector<std::string>& rear = drive->steering.rear;
  for (const std::string& wheel : drive->steering.driven) {
    if (std::find(rear.begin(), rear.end(), wheel) != rear.end()) continue;
    measureRadius(controller, "front_wheel_radius", robot.links[axleOf(controller, wheel, robot).child], &drive->steering.steered_radius);
  }
  drive->steering.steered_radius *= drive->radius_multiplier;
}

/** All wheels of a drive that steers change their speeds together, so that none slips meanwhile. */
void boundTogether(DriveConfig* drive) {
  const double bound = std::exchange(drive->wheel_acceleration, 0);
  if (bound == 0) return;
  drive->linear.max_acceleration = std::min(drive->linear.max_acceleration, bound);
  drive->linear.min_acceleration = std::max(drive->linear.min_acceleration, -bound);
}

}  // namespace

int jointAbove(int link, const model::RobotModel& robot) {
  const auto at =
      std::find_if(robot.joints.begin(), robot.joints.end(), [&](const model::JointModel& joint) { return joint.child == link; });
  return at == robot.joints.end() ? -1 : static_cast<int>(at - robot.joints.begin());
}

int steeringAbove(int joint, const SteeringConfig& steering, const model::RobotModel& robot) {
  for (; joint >= 0; joint = jointAbove(robot.joints[joint].parent, robot)) {
    const auto at = std::find(steering.joints.begin(), steering.joints.end(), robot.joints[joint].name);
    if (at != steering.joints.end()) return static_cast<int>(at - steering.joints.begin());
  }
  return -1;
}

Eigen::Vector2d placeInBase(const std::string& joint, const ControllerConfig& controller, const model::RobotModel& robot) {
  const int named = robot.linkIndex(controller.drive.base_frame), base = named < 0 ? robot.root : named;
  const Vector3 origin = placeInRoot(Vector3::Zero(), base, robot);
  const Vector3 from = axlePlace(axleOf(controller, joint, robot), robot) - origin;
  return {from.dot(placeInRoot(Vector3::UnitX(), base, robot) - origin), from.dot(placeInRoot(Vector3::UnitY(), base, robot) - origin)};
}

DriveConfig measured(const ControllerConfig& controller, const model::RobotModel& robot) {
  DriveConfig drive = controller.drive;
  if (controller.kind == ControllerKind::PLANAR_DRIVE) return drive;
  const bool steers = controller.kind == ControllerKind::STEERED_DRIVE;
  requireWheels(controller, drive);
  if (steers)
    measureSteered(controller, robot, &drive);
  else
    measureSeparation(controller, robot, &drive);
  const std::string& first = steers ? drive.steering.rear.front() : drive.left.front();
  measureRadius(controller, "wheel_radius", robot.links[axleOf(controller, first, robot).child], &drive.wheel_radius);
  drive.wheel_radius *= drive.radius_multiplier;
  if (steers) boundTogether(&drive);
  return drive;
}

}  // namespace blem_sim::sim
