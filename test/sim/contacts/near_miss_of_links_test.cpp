// Links that pass an edge without touching it go on as if nothing were there: arms that motors turn, legs that swing their own hinge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/contacts/near_miss_scene.h"
#include "support/random/scene_numbers.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

/** A cube of 0.1 m on an arm, its middle 0.5 m from a hinge about y. */
std::string armUrdf() {
  return R"(<robot name="arm"><link name="base"/>
    <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/>
      </inertial><collision><origin xyz="0.5 0 0"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint></robot>)";
}

/** Motor of a hinge, and what it is asked for. */
struct Drive {
  JointGains gains;
  double position = NAN, velocity = NAN;  // [rad, rad/s]
};

/** Arm that a motor turns from along x through -z. */
std::unique_ptr<Simulator> drivenArm(const Drive& drive, const std::vector<EnvironmentConfig>& environments, double dt) {
  SimulationConfig config = weightless(dt);
  config.environments = environments;
  config.robots = {robot("arm", armUrdf(), true)};
  config.robots[0].gains["default"] = drive.gains;
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  auto simulator = std::make_unique<Simulator>(config, model::UriResolver());
  const auto asked = [](double value) { return std::isnan(value) ? std::vector<double>() : std::vector<double>{value}; };
  simulator->commandJoints(0, {{"hinge"}, asked(drive.position), asked(drive.velocity), {}});
  return simulator;
}

/** Largest force [N] of a contact and largest change of the joint's speed [rad/s], against the same arm alone, within a second. */
std::pair<double, double> feltOf(const Drive& drive, const EnvironmentConfig& table, double dt) {
  const auto beside = drivenArm(drive, {table}, dt), alone = drivenArm(drive, {}, dt);
  double force = 0, change = 0;
  for (double t = 0; t < 1; t += dt) {
    const StepReport& report = beside->step();
    for (const ContactReport& contact : report.contacts) force = std::max(force, contact.force.norm());
    change = std::max(change, std::abs(report.joints[0].velocity - alone->step().joints[0].velocity));
  }
  return {force, change};
}

/** An arm moves on a bent path; an edge that it misses is not felt, however near it is and however fast the arm sweeps across it. */
TEST(NearMiss, OfADrivenArmChangesNothing) {
  const Drive slow{{0, 0, 1e3}, NAN, 3}, fast{{0, 0, 1e3}, NAN, 30}, weak{{0, 0, 0.5}, NAN, 30}, held{{1e5, 0, 1e3}, 2.5, NAN},
      step{{1e3, 0, 10}, 2.5, NAN};
  for (const double clearance : SANITIZED ? std::vector<double>{1e-5} : std::vector<double>{1e-5, 1e-4, 5e-4})
    for (const double dt : {0.0005, 0.001, 0.005}) {
      EnvironmentConfig table;
      table.name = "table";
      table.uri = meshFile("table_below_arm", geometry::gridMesh(0.05, 0.6, 1, 1));
      table.X_WE = makePose({0, 0, -(std::hypot(0.55, 0.05) + LAYER + clearance)});
      for (const Drive* drive : {&slow, &fast, &weak, &held, &step}) {
        const auto [force, change] = feltOf(*drive, table, dt);
        SCOPED_TRACE(std::to_string(1000 * clearance) + " mm, dt " + std::to_string(dt) + ", gains " + std::to_string(drive->gains.p) +
                     " " + std::to_string(drive->gains.d) + ", " + std::to_string(drive->velocity) + " rad/s");
        EXPECT_EQ(force, 0);
        // A motor that still speeds the arm up does so in the parts of a step near the edge.
        if (drive == &slow || drive == &fast) {
          EXPECT_LT(change, 1e-6);
        }
      }
    }
}

/** Motors of any strength whose target leaps: 0.5 to 300 rad/s at the edge, of which up to 50 come within a step. */
TEST(NearMiss, OfAnArmThatMotorsSpeedUpAtRandomChangesNothing) {
  SceneNumbers numbers(1);
  for (int i = 0; i < (SANITIZED ? 25 : 100); ++i) {
    const Drive drive{{numbers.spread(10, 1e6), 0, numbers.spread(0.1, 1e3)}, numbers.uniform(1.7, 4.2), NAN};
    const double dt = 0.0005 * numbers.count(1, 20), clearance = numbers.spread(1e-6, 5e-4);
    EnvironmentConfig table;
    table.name = "table";
    table.uri = meshFile("table_below_arm", geometry::gridMesh(0.05, 0.6, 1, 1));
    table.X_WE = makePose({0, 0, -(std::hypot(0.55, 0.05) + LAYER + clearance)});
    EXPECT_EQ(feltOf(drive, table, dt).first, 0) << i << ": " << 1000 * clearance << " mm, dt " << dt << ", gains " << drive.gains.p << " "
                                                 << drive.gains.d << ", to " << drive.position << " rad";
  }
}

/** Arms that strong motors turn by up to 2 rad in a solve, through a sheet that their cube reaches below by 3 to 23 mm. */
TEST(Passage, OfAnArmThatTurnsFarInOneSolveIsSaid) {
  SceneNumbers numbers(1);
  int driven = 0;
  for (int i = 0; i < (SANITIZED ? 25 : 100); ++i) {
    const Drive drive{{numbers.spread(1e3, 1e6), 0, numbers.spread(0.1, 1e3)}, numbers.uniform(2.2, 4.2), NAN};
    const double dt = 0.0005 * numbers.count(1, 20);
    EnvironmentConfig table;
    table.name = "table";
    table.uri = meshFile("table_below_arm", geometry::gridMesh(0.05, 0.6, 1, 1));
    table.X_WE = makePose({0, 0, -(std::hypot(0.55, 0.05) + LAYER - numbers.uniform(0.003, 0.023))});
    const auto arm = drivenArm(drive, {table}, dt);
    bool said = false, behind = false;
    for (double t = 0; t < 0.5 && !behind; t += dt) {
      const StepReport& report = arm->step();
      said = said || (report.status & CONTACT_UNRELIABLE);
      behind = report.joints[0].position > 1.95;
    }
    driven += behind || said;
    EXPECT_TRUE(said || !behind) << i << ": dt " << dt << ", gains " << drive.gains.p << " " << drive.gains.d << ", to " << drive.position;
  }
  EXPECT_GT(driven, SANITIZED ? 1 : 5);
}

/** A cube of 0.1 m at the end of a leg of 0.5 m and 2 kg, on a hinge about y of a torso of 0.5 kg that nothing holds. */
std::string swingingUrdf() {
  return R"(<robot name="swinging"><link name="torso"><inertial><mass value="0.5"/>
      <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <link name="leg"><inertial><origin xyz="0.25 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/>
      </inertial><collision><origin xyz="0.5 0 0"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="hip" type="continuous"><parent link="torso"/><child link="leg"/><axis xyz="0 1 0"/></joint></robot>)";
}

/** Swing of the leg past a table. */
struct Swing {
  double speed, gain;    // [rad/s], [N m s/rad] that a motor turns the hip with
  double clearance, dt;  // [m, s]
};

std::unique_ptr<Simulator> swingingLeg(const Swing& swing, const std::vector<EnvironmentConfig>& environments) {
  SimulationConfig config = weightless(swing.dt);
  config.environments = environments;
  config.robots = {robot("swinging", swingingUrdf(), false)};
  config.robots[0].gains["default"] = {0, 0, swing.gain};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  auto simulator = std::make_unique<Simulator>(config, model::UriResolver());
  simulator->commandJoints(0, {{"hip"}, {}, {swing.speed}, {}});
  return simulator;
}

/** Lowest corner of the foot at the ends of all steps within a time [s]. */
Vector3 lowestOfFoot(Simulator* simulator, double time) {
  Vector3 lowest(0, 0, INFINITY);
  for (double t = 0; t < time; t += simulator->config().time_step) {
    simulator->step();
    for (const double x : {0.45, 0.55})
      for (const double z : {-0.05, 0.05}) {
        const Vector3 corner = simulator->linkPose(0, 1) * Vector3(x, 0, z);
        if (corner.z() < lowest.z()) lowest = corner;
      }
  }
  return lowest;
}

/** The leg swings its own hinge: velocities change within a step though nothing touches. */
TEST(NearMiss, OfALegThatSwingsFromAFreeBodyChangesNothing) {
  for (const Swing& swing : {Swing{5, 2, 1e-6, 0.001}, Swing{8, 0.2, 1e-6, 0.001}, Swing{8, 100, 1e-6, 0.001}, Swing{13, 100, 1e-6, 0.0005},
                             Swing{40, 0.2, 7e-4, 0.0005}, Swing{40, 0.2, 1e-6, 0.001}, Swing{40, 2, 4e-4, 0.0005}}) {
    constexpr double TIME = 0.6;
    const Vector3 lowest = lowestOfFoot(swingingLeg(swing, {}).get(), TIME);
    const double turn = swing.speed * swing.dt, between_steps = 0.125 * turn * turn * 0.72;  // [m] an arc sinks below its ends
    EnvironmentConfig table;
    table.name = "table";
    table.uri = meshFile("table_below_leg", geometry::gridMesh(0.05, 0.6, 1, 1));
    table.X_WE = makePose(lowest - Vector3(0, lowest.y(), between_steps + LAYER + swing.clearance));
    const auto beside = swingingLeg(swing, {table});
    double force = 0;
    for (double t = 0; t < TIME; t += swing.dt)
      for (const ContactReport& contact : beside->step().contacts) force = std::max(force, contact.force.norm());
    EXPECT_EQ(force, 0) << swing.speed << " rad/s, gain " << swing.gain << ", " << 1000 * swing.clearance << " mm, dt " << swing.dt;
  }
}

}  // namespace
}  // namespace blem_sim::sim
