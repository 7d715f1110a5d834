// Contacts are known as far away as two things can approach each other in a step.
#include "contacts/motion/meeting_speed.h"

#include <algorithm>

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

}  // namespace
}  // namespace blem_sim::sim
