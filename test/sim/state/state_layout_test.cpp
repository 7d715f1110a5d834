// A saved state goes on only if all that its numbers rest on is the same; else the message names the difference.
#include <functional>

#include "blem_sim/geometry/input_error.h"
#include "sim/state/saved_scene.h"
#include "state/state_header.h"

namespace blem_sim::sim {
namespace {

/** The words of a refusal; empty if it is restored. */
std::string refusalToRestore(Simulator* simulator, const SimulationState& state) {
  const std::uint64_t untouched = simulator->stateHash();
  try {
    simulator->restore(state);
  } catch (const InputError& error) {
    EXPECT_EQ(simulator->stateHash(), untouched);
    return error.what();
  }
  return "";
}

/** Another scene of the same names. */
struct Change {
  const char* what;
  std::function<void(SimulationConfig*)> change;
};

TEST(StateLayout, SaysWhatIsNotTheSame) {
  const Change changes[] = {
      {"time_step is", [](SimulationConfig* c) { c->time_step = 0.002; }},
      {"solver settings is", [](SimulationConfig* c) { c->solver.correction_fraction = 0.1; }},
      {"contact settings is", [](SimulationConfig* c) { c->contact.friction_rule = contact::FrictionRule::MEAN; }},
      {"model 'cube': kind or settings", [](SimulationConfig* c) { c->objects[0].max_contacts = 7; }},
      {"body 'cube::link': mass is", [](SimulationConfig* c) { c->objects[0].mass = 1.01; }},
      {"body 'ball::link': centre of mass or inertia", [](SimulationConfig* c) { c->objects[1].com = Vector3(0.001, 0, 0); }},
      {"joint 'pendulum::hinge': gains", [](SimulationConfig* c) { c->robots[0].gains["default"].i = 21; }},
      {"joint 'pendulum::hinge': motor or friction",
       [](SimulationConfig* c) {
         c->robots[0].joint_friction["hinge"] = {0.1, 0};
       }},
      {"joint 'pendulum::hinge': motor or friction", [](SimulationConfig* c) { c->robots[0].motor["hinge"] = MotorLaw::IMPLICIT_PD; }},
      {"joint 'pendulum::hinge': motor or friction", [](SimulationConfig* c) { c->robots[0].effort_limits["hinge"] = 10; }},
      {"joint 'pendulum::hinge': armature", [](SimulationConfig* c) { c->robots[0].armature["hinge"] = 0.1; }},
      {"joint 'pendulum::hinge': kind, place or limits",
       [](SimulationConfig* c) {
         c->robots[0].X_WR = makePose({1, 0, 0.1});
       }},
      {"collider 0 'ground': mesh", [](SimulationConfig* c) { c->environments[0] = ground(5); }},
      {"collider 0 'ground': place",
       [](SimulationConfig* c) {
         c->environments[0].X_WE = makePose({0, 0, -1e-6});
       }},
      {"collider 1 'cube': layer or surface", [](SimulationConfig* c) { c->objects[0].contact.friction = 0.4; }},
      {"collider 1 'cube': layer or surface", [](SimulationConfig* c) { c->objects[0].contact.boundary_width = 0.002; }},
      {"collider 1 'cube': layer or surface", [](SimulationConfig* c) { c->objects[0].contact.impact_friction_factor = 0.5; }},
      {"collider 1 'cube': layer or surface", [](SimulationConfig* c) { c->objects[0].contact.impact_friction_speed = 0.1; }},
      {"sensor 'imu'", [](SimulationConfig* c) { c->robots[0].sensors[0].noise[0].stddev = 0.2; }},
      {"model 'plate': kind or settings is not here", [](SimulationConfig* c) { c->objects.pop_back(); }},
      {"model 'more': kind or settings was not there",
       [](SimulationConfig* c) {
         c->objects.push_back(box("more", Vector3::Constant(0.1), 1, {3, 0, 1}));
       }},
      {"is at another place", [](SimulationConfig* c) { std::swap(c->objects[0], c->objects[1]); }},
  };
  Simulator simulator(sceneOfAllKinds(), model::UriResolver());
  setOut(&simulator);
  const SimulationState saved = simulator.save();
  for (const Change& change : changes) {
    SimulationConfig config = sceneOfAllKinds();
    change.change(&config);
    Simulator other(config, model::UriResolver());
    const std::string words = refusalToRestore(&other, saved);
    EXPECT_NE(words.find(change.what), std::string::npos) << change.what << ": " << words;
    EXPECT_EQ(words.find('\n'), std::string::npos) << words;
  }
}

/** A mesh of the same file name, whose vertices were moved by a micrometre. */
TEST(StateLayout, SeesAMeshThatOnlyItsVerticesTellApart) {
  SimulationConfig config = sceneOfAllKinds();
  geometry::TriangleMesh mesh = geometry::boxMesh({0.1, 0.1, 0.1});
  config.objects[0].uri = meshFile("state_layout", mesh);
  config.objects[0].inertia = Matrix3::Identity();
  config.objects[0].com = Vector3::Zero();
  const SimulationState saved = Simulator(config, model::UriResolver()).save();
  mesh.vertices[3].x() += 1e-6;
  meshFile("state_layout", mesh);
  Simulator other(config, model::UriResolver());
  EXPECT_NE(refusalToRestore(&other, saved).find("collider 1 'cube': mesh is not the same"), std::string::npos);
}

TEST(StateLayout, WhatDoesNotChangeResultsMayDiffer) {
  SimulationConfig config = sceneOfAllKinds();
  Simulator simulator(config, model::UriResolver());
  setOut(&simulator);
  config.solver.threads = 2;
  config.random_seed = 7;
  config.objects[0].X_WO = makePose({0, 0, 1});
  Simulator other(config, model::UriResolver());
  other.restore(simulator.save());
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
}

TEST(StateLayout, AnotherVersionIsToldFromWhatIsNoState) {
  Simulator simulator(sceneOfAllKinds(), model::UriResolver());
  SimulationState state = simulator.save();
  ++state.header.format;
  EXPECT_NE(refusalToRestore(&simulator, state).find("this version restores"), std::string::npos);
  state.header = StateHeader();
  EXPECT_NE(refusalToRestore(&simulator, state).find("no header"), std::string::npos);
}

}  // namespace
}  // namespace blem_sim::sim
