// A body that sticks to a turning one stays in its place on it.
#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** A cube rides on a turntable; friction 0.8 holds up to 8.8 rad/s. @return [m] distance that it has moved on it after `turns` */
double slipOnTurntable(double speed, double turns) {
  const Vector3 disk_size(0.4, 0.4, 0.05), cube_size(0.05, 0.05, 0.05);
  const double radius = 0.1;
  World world({0, 0, -9.81}, {});
  const int disk = world.addBody(boxBody("disk", 5, disk_size, {0, 0, -0.025}));
  const int cube = world.addBody(boxBody("cube", 0.2, cube_size, {radius, 0, 0.025}));
  JointSpec hinge;
  hinge.name = "turn";
  hinge.kind = JointKind::REVOLUTE;
  hinge.parent = WORLD_BODY;
  hinge.child = disk;
  hinge.axis = Vector3::UnitZ();
  hinge.X_PJ = makePose({0, 0, -0.025});
  world.addJoint(hinge);
  JointDrive drive;
  drive.stiffness = 1e6;
  drive.damping = 1e4;
  Surface rubber;
  rubber.friction = 0.8;
  std::vector<ContactConstraint> contacts;
  const double start_up = 1;  // [s]
  const int steps = static_cast<int>((turns * 2 * M_PI / speed + start_up) / DT);
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 1) * DT, ramp = std::min(t, start_up);
    drive.target_velocity = speed * ramp / start_up;
    drive.target_position = 0.5 * speed * ramp * ramp / start_up + speed * (t - ramp);
    contacts.clear();
    boxOnBox(world, cube, cube_size, disk, disk_size, rubber, &contacts);
    if (!world.step(DT, contacts, {drive}).finite) return INFINITY;
  }
  const Vector3 on_disk = world.bodyState(disk).X_WB.inverse() * world.bodyState(cube).X_WB.translation();
  return (on_disk - Vector3(radius, 0, 0.05)).norm();
}

TEST(Carried, CubeStaysOnATurntable) {
  // A row for velocities alone lets it drift outwards at h/2 w^2 r: 1.25 mm/s at 5 rad/s.
  for (const double speed : {1.0, 5.0, 8.0}) {
    const double slip = slipOnTurntable(speed, 3);
    RecordProperty("slip_um_at_" + std::to_string(static_cast<int>(speed)), std::to_string(1e6 * slip));
    EXPECT_LT(slip, 5e-5) << speed;
  }
}

TEST(Carried, CubeLeavesATurntableThatIsTooFast) { EXPECT_GT(slipOnTurntable(9.5, 3), 0.01); }

}  // namespace
}  // namespace blem_sim::dynamics
