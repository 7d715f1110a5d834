#include "controllers/wheel_measures.h"

#include <fmt/format.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {
namespace {

const model::JointModel& axleOf(const ControllerConfig& controller, const std::string& wheel, const model::RobotModel& robot) {
  const int joint = robot.jointIndex(wheel);
  if (joint < 0)
    throw InputError(fmt::format("controller '{}': '{}' is no joint of the URDF; name a wheel's joint", controller.name, wheel));
  return robot.joints[joint];
}

/** Place [m] of a joint's frame in the root link, all joints at 0. */
Vector3 axlePlace(const model::JointModel& axle, const model::RobotModel& robot) {
  Vector3 place = axle.X_PJ.translation();
  for (int link = axle.parent; link != robot.root;) {
    const auto joint =
        std::find_if(robot.joints.begin(), robot.joints.end(), [&](const model::JointModel& other) { return other.child == link; });
    place = joint->X_PJ * place;
    link = joint->parent;
  }
  return place;
}

/** [m]; 0 if none of its shapes is round. */
double radiusOf(const model::LinkModel& wheel) {
  for (const model::CollisionShape& shape : wheel.collisions)
    if (const double radius = shape.cylinder ? shape.cylinder->radius : shape.radius; radius > 0) return radius;
  return 0;
}

}  // namespace

DriveConfig measured(const ControllerConfig& controller, const model::RobotModel& robot) {
  DriveConfig drive = controller.drive;
  const model::JointModel& left = axleOf(controller, drive.left.front(), robot);
  const model::JointModel& right = axleOf(controller, drive.right.front(), robot);
  if (drive.wheel_separation == 0) drive.wheel_separation = (axlePlace(left, robot) - axlePlace(right, robot)).norm();
  if (drive.wheel_radius == 0) drive.wheel_radius = radiusOf(robot.links[left.child]);
  if (!(drive.wheel_separation > 0))
    throw InputError(
        fmt::format("controller '{}': wheel_separation: is missing, and the URDF has '{}' and '{}' at one place; give it in metres",
                    controller.name, left.name, right.name));
  if (!(drive.wheel_radius > 0))
    throw InputError(
        fmt::format("controller '{}': wheel_radius: is missing, and link '{}' has no <cylinder> or <sphere> to take it from; give "
                    "it in metres",
                    controller.name, robot.links[left.child].name));
  drive.wheel_separation *= drive.separation_multiplier;
  drive.wheel_radius *= drive.radius_multiplier;
  return drive;
}

}  // namespace blem_sim::sim
