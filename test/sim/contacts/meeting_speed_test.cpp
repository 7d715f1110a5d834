// Contacts are known as far away as two things can approach each other in a step.
#include "contacts/motion/meeting_speed.h"

#include <algorithm>

#include "geometry/random_shapes.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double BOTH_LAYERS = 0.005;  // [m] of two boxes

/** Two cubes in the air, 10 cm wide, `gap` [m] between their layers along x. */
SimulationConfig twoCubes(double gap, const Vector3& velocity_a, const Vector3& velocity_b) {
  SimulationConfig config;
  config.objects = {box("a", Vector3::Constant(0.1), 1, Vector3(0, 0, 5)),
                    box("b", Vector3::Constant(0.1), 1, Vector3(0.1 + BOTH_LAYERS + gap, 0, 5))};
  config.objects[0].linear_velocity = velocity_a;
  config.objects[1].linear_velocity = velocity_b;
  return config;
}

TEST(KnownContacts, ThingsThatMoveTogetherAreFar) {
  Simulator simulator(twoCubes(0.002, Vector3(0, 1, 0), Vector3(0, 1, 0)), model::UriResolver());
  for (int i = 0; i < 10; ++i) {
    const StepReport& report = simulator.step();
    EXPECT_EQ(report.searched_pairs, 1);
    EXPECT_EQ(report.raw_contacts, 0) << i;
  }
}

TEST(KnownContacts, ThingsThatMeetAreKnownBeforeTheyTouch) {
  for (const double speed : {1.0, 2.0, 3.0}) {
    Simulator simulator(twoCubes(0.01, Vector3(speed, 8, 0), Vector3(0, 8, 0)), model::UriResolver());
    double deepest = 0;
    int before_touch = 0;
    for (int i = 0; i < 50; ++i) {
      const StepReport& report = simulator.step();
      deepest = std::max(deepest, report.max_depth);
      before_touch += report.raw_contacts > 0 && report.contacts.empty();
    }
    EXPECT_GT(before_touch, 0) << speed;
    EXPECT_LT(deepest, 1e-9) << speed;
    EXPECT_GT(bodyOf(simulator, "b").v_WCom.x(), 0.3 * speed);
  }
}

TEST(KnownContacts, WhatIsStoppedDeadIsKnownToWhatFollows) {
  for (const double speed : {2.0, 4.0, 6.0}) {
    SimulationConfig config = twoCubes(0.001, Vector3(speed, 0, 0), Vector3(speed, 0, 0));
    config.objects.push_back(box("wall", Vector3::Constant(0.1), 1e4, Vector3(2 * (0.1 + BOTH_LAYERS) + 0.02, 0, 5)));
    Simulator simulator(config, model::UriResolver());
    double deepest = 0;
    for (int i = 0; i < 30; ++i) {
      const StepReport& report = simulator.step();
      EXPECT_EQ(report.redone_solves, 0) << speed;
      deepest = std::max(deepest, report.max_of_layer);
    }
    EXPECT_LT(bodyOf(simulator, "a").v_WCom.x(), 0.1 * speed);
    EXPECT_LT(deepest, 0.01) << speed;
  }
}

TEST(KnownContacts, SpinCounts) {
  for (const bool spins : {false, true}) {
    SimulationConfig config = twoCubes(0.002, Vector3::Zero(), Vector3::Zero());
    if (spins) config.objects[0].angular_velocity = {40, 0, 0};
    Simulator simulator(config, model::UriResolver());
    for (int i = 0; i < 10; ++i) EXPECT_EQ(simulator.step().raw_contacts > 0, spins) << i;
  }
}

/** Two cubes anywhere near each other, the second one perhaps the static world's, in any motion. */
TEST(MeetingSpeed, IsNoMoreThanItsBound) {
  geometry::RandomShapes random(7);
  int meet = 0, tight = 0;
  for (int i = 0; i < 300; ++i) {
    SimulatedWorld world{Vector3::Zero(), dynamics::SolverSettings()};
    std::vector<dynamics::BodyState> bodies;
    std::vector<contact::ColliderMotion> motion;
    const auto number = [&](double most) { return random.uniform(-most, most); };
    const auto vector = [&](double most) { return Vector3(number(most), number(most), number(most)); };
    for (int c = 0; c < 2; ++c) {
      dynamics::BodySpec spec;
      spec.name = "body";
      spec.inertial.mass = 1;
      spec.inertial.com = vector(0.02);
      spec.inertial.inertia = Matrix3::Identity();
      contact::Collider collider;
      collider.geometry = std::make_shared<const contact::CollisionGeometry>(
          std::make_shared<const geometry::TriangleMesh>(geometry::boxMesh({0.1, 0.08, 0.06})));
      collider.radius = 0.002;
      collider.body = c == 1 && i % 3 == 0 ? dynamics::WORLD_BODY : world.world.addBody(spec);
      world.colliders.push_back(collider);
      dynamics::BodyState state;
      state.X_WB = makePose(vector(0.08), vector(3));
      state.v_WCom = vector(i % 2 ? 0.01 : 3);
      state.w_WB = vector(i % 5 ? 20 : 0);
      if (collider.body != dynamics::WORLD_BODY) bodies.push_back(state);
      motion.emplace_back();
      motion.back().X_WC = state.X_WB;
    }
    contact::ColliderPair pair;
    pair.a = 0;
    pair.b = 1;
    pair.margin = 0.01;
    const double speed = meetingSpeed(world, bodies, motion, pair), bound = meetingSpeedBound(world, bodies, motion, pair);
    EXPECT_LE(speed, bound * (1 + 1e-12)) << i;
    meet += speed > 0;
    tight += speed > 0.5 * bound;
  }
  EXPECT_GT(meet, 200);
  EXPECT_GT(tight, 100);
}

}  // namespace
}  // namespace blem_sim::sim
