// A body that passes beside another without touching it goes on as if nothing were there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim {
namespace {

constexpr double LAYER = 0.0025;  // [m] of objects; environments have none

/** A mesh that flies beside another. */
struct Flight {
  TriangleMesh mesh;
  Vector3 turn = Vector3::Zero();        // [rad]
  Vector3 direction = Vector3::UnitX();  // unit
  Vector3 spin = Vector3::Zero();        // [rad/s]
  double lowest = NAN;                   // [m] of its points below its middle, however it turns; NAN: of the mesh as it is turned
};

double lowestOf(const Flight& flight) {
  if (!std::isnan(flight.lowest)) return flight.lowest;
  double lowest = 0;
  const Matrix3 turn = makePose(Vector3::Zero(), flight.turn).linear();
  for (const Vector3& v : flight.mesh.vertices) lowest = std::max(lowest, -(turn * v).z());
  return lowest;
}

std::vector<Flight> flights() {
  const TriangleMesh cube = boxMesh(Vector3::Constant(0.1)), ball = icosphereMesh(0.05, 2);
  std::vector<Flight> all;
  all.push_back({cube});
  all.push_back({cube, {0, 0, 0.3}});
  all.push_back({cube, {0.4, 0, 0}});
  all.push_back({cube, {0.4, -0.7, 0.3}});
  all.push_back({cube, {0, 0, 0.2}, Vector3(1, 0.6, 0).normalized()});
  all.push_back({cube, {0, 0, 0}, Vector3::UnitX(), {0, 0, 20}});
  all.push_back({ball, {0.1, 0.2, 0.3}, Vector3::UnitX(), {3, 30, -7}, 0.05});
  all.push_back({transformed(gridMesh(0.1, 0.1, 1, 1), makePose(Vector3::Zero(), {M_PI / 2, 0, 0})), {0, 0, 0.4}});
  return all;
}

std::vector<TriangleMesh> tables() {
  return {gridMesh(0.05, 0.6, 1, 1), gridMesh(0.05, 0.6, 3, 7), transformed(boxMesh({0.05, 0.6, 0.1}), makePose({0, 0, -0.05})),
          gridMesh(0.001, 0.6, 1, 1)};
}

ObjectConfig flying(const std::string& name, const Flight& flight, const Vector3& position, double speed) {
  static int number = 0;
  ObjectConfig object;
  object.name = name;
  object.uri = meshFile("flying" + std::to_string(number++ % 64), flight.mesh);
  object.mass = 1;
  object.inertia = 0.002 * Matrix3::Identity();
  object.com = Vector3::Zero();
  object.X_WO = makePose(position, flight.turn);
  object.linear_velocity = speed * flight.direction;
  object.angular_velocity = flight.spin;
  return object;
}

SimulationConfig weightless(double dt) {
  SimulationConfig config;
  config.gravity.setZero();
  config.time_step = dt;
  return config;
}

/** Largest change of velocity until the time is over, of the speed; of spin, of the speed per 0.1 m. */
double largestChange(const SimulationConfig& config, double time, double speed) {
  Simulator simulator(config, UriResolver());
  double change = 0;
  for (double t = 0; t < time; t += config.time_step) {
    simulator.step();
    for (const ObjectConfig& object : config.objects) {
      const BodyState state = bodyOf(simulator, object.name);
      change = std::max(change, (state.v_WCom - object.linear_velocity).norm() / speed);
      change = std::max(change, 0.1 * (state.w_WB - object.angular_velocity).norm() / speed);
    }
  }
  return change;
}

TEST(NearMiss, OverAnEdgeChangesNothing) {
  const std::vector<double> clearances = SANITIZED ? std::vector<double>{1e-5} : std::vector<double>{1e-5, 1e-4, 5e-4};
  const std::vector<double> speeds = SANITIZED ? std::vector<double>{3.0, 30.0} : std::vector<double>{1.0, 3.0, 10.0, 30.0};
  int table_number = 0;
  for (const TriangleMesh& table : tables()) {
    EnvironmentConfig environment;
    environment.name = "table";
    environment.uri = meshFile("table" + std::to_string(table_number++), table);
    int number = 0;
    for (const Flight& flight : flights()) {
      ++number;
      for (const double clearance : clearances)
        for (const double speed : speeds)
          for (const double dt : {0.0005, 0.001, 0.005}) {
            SimulationConfig config = weightless(dt);
            config.environments = {environment};
            const Vector3 start = -(0.15 + 0.37 * speed * dt) * flight.direction;
            config.objects = {flying("thrown", flight, start + (lowestOf(flight) + LAYER + clearance) * Vector3::UnitZ(), speed)};
            EXPECT_LT(largestChange(config, 0.35 / speed, speed), 1e-6)
                << "table " << table_number << ", flight " << number << ", " << 1000 * clearance << " mm, " << speed << " m/s, dt " << dt;
          }
    }
  }
}

/** Two bodies that fly past each other, and one past a corner. */
TEST(NearMiss, OfTwoBodiesChangesNothing) {
  int number = 0;
  for (const Flight& flight : flights()) {
    ++number;
    for (const double clearance : {1e-5, 5e-4})
      for (const double speed : {1.0, 10.0, 30.0}) {
        SimulationConfig config = weightless(0.001);
        const double half = 0.5 * (lowestOf(flight) + 0.05) + LAYER + 0.5 * clearance;
        const Flight other{boxMesh({0.1, 0.3, 0.1}), Vector3::Zero(), -flight.direction};
        config.objects = {flying("upper", flight, -0.2 * flight.direction + Vector3(0, 0, half + 0.5 * (lowestOf(flight) - 0.05)), speed),
                          flying("lower", other, 0.2 * flight.direction - Vector3(0, 0, half + 0.5 * (0.05 - lowestOf(flight))), speed)};
        EXPECT_LT(largestChange(config, 0.25 / speed, speed), 1e-6)
            << "flight " << number << ", " << 1000 * clearance << " mm, " << speed << " m/s";
      }
  }
}

TEST(NearMiss, DescendingPastTheFarEdgeChangesNothing) {
  EnvironmentConfig table;
  table.name = "table";
  table.uri = meshFile("table_long", transformed(gridMesh(0.4, 0.6, 2, 2), makePose({-0.2, 0, 0})));
  for (const double fall : {0.02, 0.2, 1.0})
    for (const double clearance : {1e-5, 1e-4, 5e-4})
      for (const double speed : {1.0, 10.0, 30.0}) {
        const Vector3 way = Vector3(1, 0, -fall).normalized(), up(-way.z(), 0, way.x());
        SimulationConfig config = weightless(0.001);
        config.objects = {flying("cube", {boxMesh(Vector3::Constant(0.1)), Vector3::Zero(), way},
                                 Vector3(0.05, 0, 0.05) + (LAYER + clearance) * up - 0.1 * way, speed)};
        config.environments = {table};
        EXPECT_LT(largestChange(config, 0.3 / speed, speed), 1e-6) << fall << ", " << 1000 * clearance << " mm, " << speed << " m/s";
      }
}

/** A cube flies over a narrow ridge on a falling path: gravity alone acts. Steps that are made in parts fall less. */
TEST(NearMiss, OnAFallingPathOnlyGravityActs) {
  EnvironmentConfig ridge;
  ridge.name = "ridge";
  ridge.uri = meshFile("ridge", gridMesh(0.001, 0.6, 1, 1));
  for (const double clearance : {1e-5, 1e-4, 5e-4})
    for (const double speed : {1.0, 3.0, 10.0, 30.0})
      for (const double dt : {0.001, 0.005}) {
        SimulationConfig config;
        config.time_step = dt;
        config.environments = {ridge};
        const double start = -0.08 - 0.37 * speed * dt, gone = (0.0506 - start) / speed;  // its last edge is above the ridge's then
        const double steps = std::ceil(gone / dt), fallen = 0.5 * G * dt * dt * steps * (steps + 1);
        config.objects = {flying("cube", {boxMesh(Vector3::Constant(0.1))}, {start, 0, 0.05 + LAYER + clearance + fallen}, speed)};
        Simulator simulator(config, UriResolver());
        for (int i = 1; i <= steps; ++i) {
          simulator.step();
          const Vector3 expected(speed, 0, -G * dt * i);
          ASSERT_LT((bodyOf(simulator, "cube").v_WCom - expected).norm(), 1e-6 * speed)
              << 1000 * clearance << " mm, " << speed << " m/s, dt " << dt << ", step " << i << " of " << steps;
        }
      }
}

/** A ball of 50 mm, a point with a layer. */
ObjectConfig pointBall(const std::string& name, const Vector3& position, const Vector3& velocity) {
  ObjectConfig ball;
  ball.name = name;
  ball.uri = pointsFile("one_point", {Vector3::Zero()});
  ball.mass = 1;
  ball.com = Vector3::Zero();
  ball.inertia = 0.001 * Matrix3::Identity();
  ball.cloud.point_radius = 0.05;
  ball.X_WO = makePose(position);
  ball.linear_velocity = velocity;
  return ball;
}

/** Without friction a ball loses its velocity along the line to the edge that it touches. */
TEST(NearMiss, BallThatMeetsAnEdgeTurnsAsTheEdgeTellsIt) {
  EnvironmentConfig table;
  table.name = "table";
  table.uri = meshFile("table_ball", transformed(gridMesh(0.4, 0.6, 2, 2), makePose({0.2, 0, 0})));
  for (const double part : {0.3, 0.6, 0.9, 0.99, 1.0002})  // of its radius, that its middle is higher than the edge
    for (const double speed : {1.0, 3.0, 10.0})
      for (const double dt : {0.0001, 0.0005, 0.001}) {
        SimulationConfig config = weightless(dt);
        config.contact.surface.friction = 0;
        config.environments = {table};
        config.objects = {pointBall("ball", {-0.1 - 0.3 * speed * dt, 0, 0.05 * part}, {speed, 0, 0})};
        Simulator simulator(config, UriResolver());
        const Vector3 normal = part < 1 ? Vector3(-std::sqrt(1 - part * part), 0, part) : Vector3::UnitZ();
        const Vector3 expected = config.objects[0].linear_velocity - config.objects[0].linear_velocity.dot(normal) * normal;
        stepFor(&simulator, 0.12 / speed);
        // The ball lands in one part of a step and has stopped in the next, by when it is elsewhere.
        const double turned = part < 1 ? std::min(1.0, 2 * speed * dt / 0.05) : 0;
        EXPECT_LT((bodyOf(simulator, "ball").v_WCom - expected).norm(), (1e-6 + turned) * speed)
            << part << " of the radius, " << speed << " m/s, dt " << dt << ": " << bodyOf(simulator, "ball").v_WCom.transpose() << " not "
            << expected.transpose();
        EXPECT_LT(simulator.report().max_of_layer, 0.05);
      }
}

/** Balls that meet off their middles without friction exchange velocity along the line between them, here half of it: nothing bounces. */
TEST(NearMiss, BallsThatMeetOffTheirMiddlesLoseWhatGoesAlongTheirLine) {
  for (const double part : {0.0, 0.5, 0.9, 0.99, 1.0002})
    for (const double speed : {1.0, 3.0}) {
      SimulationConfig config = weightless(0.0005);
      config.contact.surface.friction = 0;
      config.objects = {pointBall("left", {-0.2, 0, 0.05 * part}, {speed, 0, 0}),
                        pointBall("right", {0.2, 0, -0.05 * part}, {-speed, 0, 0})};
      Simulator simulator(config, UriResolver());
      const Vector3 normal = part < 1 ? Vector3(-std::sqrt(1 - part * part), 0, part) : Vector3::UnitZ(), way(speed, 0, 0);
      stepFor(&simulator, 0.21 / speed);
      const Vector3 expected = way - way.dot(normal) * normal;
      const double turned = part < 1 ? 2 * 2 * speed * config.time_step / 0.1 : 0;
      EXPECT_LT((bodyOf(simulator, "left").v_WCom - expected).norm(), (1e-6 + turned) * speed)
          << part << " of the radius, " << speed << " m/s";
      EXPECT_LT((bodyOf(simulator, "left").v_WCom + bodyOf(simulator, "right").v_WCom).norm(), 1e-9 * speed);
    }
}

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
  auto simulator = std::make_unique<Simulator>(config, UriResolver());
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
  const Drive slow{{0, 0, 1e3}, NAN, 3}, fast{{0, 0, 1e3}, NAN, 30}, weak{{0, 0, 0.5}, NAN, 30}, held{{1e5, 0, 1e3}, 2.5, NAN};
  for (const double clearance : {1e-5, 1e-4, 5e-4})
    for (const double dt : {0.0005, 0.001, 0.005}) {
      EnvironmentConfig table;
      table.name = "table";
      table.uri = meshFile("table_below_arm", gridMesh(0.05, 0.6, 1, 1));
      table.X_WE = makePose({0, 0, -(std::hypot(0.55, 0.05) + LAYER + clearance)});
      for (const Drive* drive : {&slow, &fast, &weak, &held}) {
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
  auto simulator = std::make_unique<Simulator>(config, UriResolver());
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
    table.uri = meshFile("table_below_leg", gridMesh(0.05, 0.6, 1, 1));
    table.X_WE = makePose(lowest - Vector3(0, lowest.y(), between_steps + LAYER + swing.clearance));
    const auto beside = swingingLeg(swing, {table});
    double force = 0;
    for (double t = 0; t < TIME; t += swing.dt)
      for (const ContactReport& contact : beside->step().contacts) force = std::max(force, contact.force.norm());
    EXPECT_EQ(force, 0) << swing.speed << " rad/s, gain " << swing.gain << ", " << 1000 * swing.clearance << " mm, dt " << swing.dt;
  }
}

TEST(NearMiss, WhatIsHitHeadOnStops) {
  for (const double speed : {1.0, 3.0, 10.0, 30.0})
    for (const double across : {0.0, 0.05, 0.5})
      for (const double dt : {0.0005, 0.001}) {
        SimulationConfig config = weightless(dt);
        config.contact.surface.friction = 0;
        EnvironmentConfig block;
        block.name = "block";
        block.uri = meshFile("block", transformed(boxMesh({0.1, 0.6, 0.4}), makePose({0.05, 0, -0.18})));
        config.environments = {block};
        ObjectConfig cube = flying("cube", {boxMesh(Vector3::Constant(0.1))}, {-0.1, -0.1 * across, 0}, speed);
        cube.linear_velocity = {speed, across * speed, 0};
        config.objects = {cube};
        Simulator simulator(config, UriResolver());
        stepFor(&simulator, 0.1 / speed + 0.005);
        const BodyState state = bodyOf(simulator, "cube");
        EXPECT_NEAR(state.X_WB.translation().x(), -0.0525, 2e-5) << speed << " m/s, across " << across << ", dt " << dt;
        EXPECT_LT((state.v_WCom - Vector3(0, across * speed, 0)).norm(), 1e-3 * speed)
            << speed << " m/s, across " << across << ", dt " << dt;
      }
}

TEST(NearMiss, LandingAcrossStopsAtTheLayer) {
  for (const double speed : {1.0, 5.0, 20.0})
    for (const double dt : {0.0005, 0.001}) {
      SimulationConfig config = weightless(dt);
      config.contact.surface.friction = 0;
      config.environments = {ground()};
      ObjectConfig cube = flying("cube", {boxMesh(Vector3::Constant(0.1)), {0, 0, 0.3}}, {-0.3, 0, 0.0573}, 0);
      cube.linear_velocity = {speed, 0.2 * speed, -0.5 * speed};
      config.objects = {cube};
      Simulator simulator(config, UriResolver());
      stepFor(&simulator, 0.1 / speed);
      const BodyState state = bodyOf(simulator, "cube");
      EXPECT_LT((state.v_WCom - Vector3(speed, 0.2 * speed, 0)).norm(), 1e-6 * speed);
      EXPECT_NEAR(state.X_WB.translation().z(), 0.0525, 1e-6);
    }
}

TEST(NearMiss, WhatIsStruckOnItsWayOverAnEdgeIsStoppedByIt) {
  for (const double speed : {1.0, 5.0, 10.0})
    for (const double place : {-0.06, -0.055, -0.05, -0.045, 0.0}) {
      SimulationConfig config = weightless(0.001);
      EnvironmentConfig table;
      table.name = "table";
      table.uri = meshFile("table_struck", transformed(gridMesh(0.4, 0.6, 2, 2), makePose({0.2, 0, 0})));
      config.environments = {table};
      const double flight = 0.03;  // [m] until it is struck
      config.objects = {flying("cube", {boxMesh(Vector3::Constant(0.1))}, {place - flight, 0, 0.0526}, speed),
                        box("hammer", Vector3::Constant(0.1), 5, {place, 0, 0.0526 + 0.105 + flight})};
      config.objects[1].linear_velocity = {0, 0, -speed};
      Simulator simulator(config, UriResolver());
      for (double t = 0; t < 2 * flight / speed; t += 0.001) {
        EXPECT_FALSE(simulator.step().status & CONTACT_UNRELIABLE) << speed << " m/s, " << place;
        EXPECT_LT(simulator.report().max_of_layer, 0.9) << speed << " m/s, " << place;
      }
    }
}

}  // namespace
}  // namespace blem_sim
