// A body that passes beside another without touching it goes on as if nothing were there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/contacts/near_miss_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

/** A mesh that flies beside another. */
struct Flight {
  geometry::TriangleMesh mesh;
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
  const geometry::TriangleMesh cube = geometry::boxMesh(Vector3::Constant(0.1)), ball = geometry::icosphereMesh(0.05, 2);
  std::vector<Flight> all;
  all.push_back({cube});
  all.push_back({cube, {0, 0, 0.3}});
  all.push_back({cube, {0.4, 0, 0}});
  all.push_back({cube, {0.4, -0.7, 0.3}});
  all.push_back({cube, {0, 0, 0.2}, Vector3(1, 0.6, 0).normalized()});
  all.push_back({cube, {0, 0, 0}, Vector3::UnitX(), {0, 0, 20}});
  all.push_back({ball, {0.1, 0.2, 0.3}, Vector3::UnitX(), {3, 30, -7}, 0.05});
  all.push_back({geometry::transformed(geometry::gridMesh(0.1, 0.1, 1, 1), makePose(Vector3::Zero(), {M_PI / 2, 0, 0})), {0, 0, 0.4}});
  return all;
}

std::vector<geometry::TriangleMesh> tables() {
  return {geometry::gridMesh(0.05, 0.6, 1, 1), geometry::gridMesh(0.05, 0.6, 3, 7),
          geometry::transformed(geometry::boxMesh({0.05, 0.6, 0.1}), makePose({0, 0, -0.05})), geometry::gridMesh(0.001, 0.6, 1, 1)};
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

/** Largest change of velocity until the time is over, of the speed; of spin, of the speed per 0.1 m. */
double largestChange(const SimulationConfig& config, double time, double speed) {
  Simulator simulator(config, model::UriResolver());
  double change = 0;
  for (double t = 0; t < time; t += config.time_step) {
    simulator.step();
    for (const ObjectConfig& object : config.objects) {
      const dynamics::BodyState state = bodyOf(simulator, object.name);
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
  for (const geometry::TriangleMesh& table : tables()) {
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
        const Flight other{geometry::boxMesh({0.1, 0.3, 0.1}), Vector3::Zero(), -flight.direction};
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
  table.uri = meshFile("table_long", geometry::transformed(geometry::gridMesh(0.4, 0.6, 2, 2), makePose({-0.2, 0, 0})));
  for (const double fall : {0.02, 0.2, 1.0})
    for (const double clearance : {1e-5, 1e-4, 5e-4})
      for (const double speed : {1.0, 10.0, 30.0}) {
        const Vector3 way = Vector3(1, 0, -fall).normalized(), up(-way.z(), 0, way.x());
        SimulationConfig config = weightless(0.001);
        config.objects = {flying("cube", {geometry::boxMesh(Vector3::Constant(0.1)), Vector3::Zero(), way},
                                 Vector3(0.05, 0, 0.05) + (LAYER + clearance) * up - 0.1 * way, speed)};
        config.environments = {table};
        EXPECT_LT(largestChange(config, 0.3 / speed, speed), 1e-6) << fall << ", " << 1000 * clearance << " mm, " << speed << " m/s";
      }
}

/** A cube flies over a narrow ridge on a falling path: gravity alone acts. Steps that are made in parts fall less. */
TEST(NearMiss, OnAFallingPathOnlyGravityActs) {
  EnvironmentConfig ridge;
  ridge.name = "ridge";
  ridge.uri = meshFile("ridge", geometry::gridMesh(0.001, 0.6, 1, 1));
  for (const double clearance : {1e-5, 1e-4, 5e-4})
    for (const double speed : {1.0, 3.0, 10.0, 30.0})
      for (const double dt : {0.001, 0.005}) {
        SimulationConfig config;
        config.time_step = dt;
        config.environments = {ridge};
        const double start = -0.08 - 0.37 * speed * dt, gone = (0.0506 - start) / speed;  // its last edge is above the ridge's then
        const double steps = std::ceil(gone / dt), fallen = 0.5 * G * dt * dt * steps * (steps + 1);
        config.objects = {
            flying("cube", {geometry::boxMesh(Vector3::Constant(0.1))}, {start, 0, 0.05 + LAYER + clearance + fallen}, speed)};
        Simulator simulator(config, model::UriResolver());
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
  table.uri = meshFile("table_ball", geometry::transformed(geometry::gridMesh(0.4, 0.6, 2, 2), makePose({0.2, 0, 0})));
  for (const double part : {0.3, 0.6, 0.9, 0.99, 1.0002})  // of its radius, that its middle is higher than the edge
    for (const double speed : {1.0, 3.0, 10.0})
      for (const double dt : {0.0001, 0.0005, 0.001}) {
        SimulationConfig config = weightless(dt);
        config.contact.surface.friction = 0;
        config.environments = {table};
        config.objects = {pointBall("ball", {-0.1 - 0.3 * speed * dt, 0, 0.05 * part}, {speed, 0, 0})};
        Simulator simulator(config, model::UriResolver());
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
      Simulator simulator(config, model::UriResolver());
      const Vector3 normal = part < 1 ? Vector3(-std::sqrt(1 - part * part), 0, part) : Vector3::UnitZ(), way(speed, 0, 0);
      stepFor(&simulator, 0.21 / speed);
      const Vector3 expected = way - way.dot(normal) * normal;
      const double turned = part < 1 ? 2 * 2 * speed * config.time_step / 0.1 : 0;
      EXPECT_LT((bodyOf(simulator, "left").v_WCom - expected).norm(), (1e-6 + turned) * speed)
          << part << " of the radius, " << speed << " m/s";
      EXPECT_LT((bodyOf(simulator, "left").v_WCom + bodyOf(simulator, "right").v_WCom).norm(), 1e-9 * speed);
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
        block.uri = meshFile("block", geometry::transformed(geometry::boxMesh({0.1, 0.6, 0.4}), makePose({0.05, 0, -0.18})));
        config.environments = {block};
        ObjectConfig cube = flying("cube", {geometry::boxMesh(Vector3::Constant(0.1))}, {-0.1, -0.1 * across, 0}, speed);
        cube.linear_velocity = {speed, across * speed, 0};
        config.objects = {cube};
        Simulator simulator(config, model::UriResolver());
        stepFor(&simulator, 0.1 / speed + 0.005);
        const dynamics::BodyState state = bodyOf(simulator, "cube");
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
      ObjectConfig cube = flying("cube", {geometry::boxMesh(Vector3::Constant(0.1)), {0, 0, 0.3}}, {-0.3, 0, 0.0573}, 0);
      cube.linear_velocity = {speed, 0.2 * speed, -0.5 * speed};
      config.objects = {cube};
      Simulator simulator(config, model::UriResolver());
      stepFor(&simulator, 0.1 / speed);
      const dynamics::BodyState state = bodyOf(simulator, "cube");
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
      table.uri = meshFile("table_struck", geometry::transformed(geometry::gridMesh(0.4, 0.6, 2, 2), makePose({0.2, 0, 0})));
      config.environments = {table};
      const double flight = 0.03;  // [m] until it is struck
      config.objects = {flying("cube", {geometry::boxMesh(Vector3::Constant(0.1))}, {place - flight, 0, 0.0526}, speed),
                        box("hammer", Vector3::Constant(0.1), 5, {place, 0, 0.0526 + 0.105 + flight})};
      config.objects[1].linear_velocity = {0, 0, -speed};
      Simulator simulator(config, model::UriResolver());
      for (double t = 0; t < 2 * flight / speed; t += 0.001) {
        EXPECT_FALSE(simulator.step().status & CONTACT_UNRELIABLE) << speed << " m/s, " << place;
        EXPECT_LT(simulator.report().max_of_layer, 0.9) << speed << " m/s, " << place;
      }
    }
}

}  // namespace
}  // namespace blem_sim::sim
