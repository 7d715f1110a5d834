// Boxes on boxes: ten cubes, and a hundred kilograms on one; contacts written down, and of meshes.
#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "sim/simulation_scene.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

const Vector3 CUBE(0.1, 0.1, 0.1);
constexpr double LAYER = 0.0025;  // [m] on every side of a mesh cube, the configuration's default

// [m] between cubes at the start: the top one then lands slower than the contacts' margin of 1 mm per step.
constexpr double DROP = 0.004;

/** Cubes dropped, each on the one below. */
struct Tower {
  explicit Tower(const std::vector<double>& masses) : world(Vector3(0, 0, -9.81), soakSettings()) {
    for (std::size_t i = 0; i < masses.size(); ++i)
      world.addBody(dynamics::boxBody("cube", masses[i], CUBE, {0, 0, 0.05 + DROP + (0.1 + DROP) * static_cast<double>(i)}));
  }
  const dynamics::SolveResult& step() {
    contacts.clear();
    dynamics::boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    for (int i = 1; i < world.bodyCount(); ++i) dynamics::boxOnBox(world, i, CUBE, i - 1, CUBE, {}, &contacts);
    times.start();
    const dynamics::SolveResult& result = world.step(1e-3, contacts, {});
    times.stop(result);
    return result;
  }
  dynamics::World world;
  std::vector<dynamics::ContactConstraint> contacts;
  StepTimes times;
};

void expectStands(const std::string& name, const std::vector<double>& masses) {
  Tower tower(masses);
  double energy = tower.world.kineticEnergy() + tower.world.potentialEnergy(), gained = -INFINITY;
  for (int k = 0; k < soakSteps(60, 3); ++k) {
    ASSERT_TRUE(tower.step().finite) << k;
    const double now = tower.world.kineticEnergy() + tower.world.potentialEnergy();
    gained = std::max(gained, now - energy);
    energy = now;
  }
  double height = 0, sideways = 0, speed = 0;
  for (int i = 0; i < tower.world.bodyCount(); ++i) {
    const dynamics::BodyState state = tower.world.bodyState(i);
    height = std::max(height, std::abs(state.X_WB.translation().z() - 0.05 - 0.1 * i));
    sideways = std::max(sideways, state.X_WB.translation().head<2>().norm());
    speed = std::max(speed, state.v_WCom.norm());
  }
  figure(name + ": height error", height, "m");
  figure(name + ": sideways", sideways, "m");
  figure(name + ": speed", speed, "m/s");
  figure(name + ": energy gained in a step", gained, "J");
  tower.times.print(name);
  EXPECT_LE(height, 1e-6);
  EXPECT_LE(sideways, 1e-6);
  EXPECT_LT(gained, 1e-6);
}

TEST(Stacking, TenCubes) { expectStands("ten cubes", std::vector<double>(10, 1)); }
TEST(Stacking, HundredKilogramsOnOne) { expectStands("100 kg on 1 kg", {1, 100}); }

void expectMeshesStand(const std::string& name, const std::vector<double>& masses) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  config.environments = {sim::ground()};
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double z = 0.05 + LAYER + 0.01 + static_cast<double>(i) * (0.1 + 2 * LAYER + 0.01);
    config.objects.push_back(sim::box("cube" + std::to_string(i), CUBE, masses[i], {0, 0, z}));
  }
  sim::Simulator simulator(config, model::UriResolver());
  double energy = simulator.report().energy, gained = -INFINITY;
  StepTimes times;
  for (int k = 0; k < soakSteps(20, 3); ++k) {
    times.start();
    const sim::StepReport& report = simulator.step();
    times.stop(report);
    ASSERT_FALSE(report.status & sim::STATE_NOT_FINITE) << k;
    gained = std::max(gained, report.energy - energy);
    energy = report.energy;
  }
  double height = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double z = 0.05 + LAYER + static_cast<double>(i) * (0.1 + 2 * LAYER);
    height = std::max(height, std::abs(sim::bodyOf(simulator, "cube" + std::to_string(i)).X_WB.translation().z() - z));
  }
  figure(name + ": height error", height, "m");
  figure(name + ": energy gained in a step", gained, "J");
  times.print(name);
  EXPECT_LE(height, 1e-6);
  EXPECT_LT(gained, 1e-6);
}

TEST(Stacking, TenCubesOfMeshes) { expectMeshesStand("ten mesh cubes", std::vector<double>(10, 1)); }
TEST(Stacking, HundredKilogramsOnOneOfMeshes) { expectMeshesStand("100 kg on 1 kg, meshes", {1, 100}); }

}  // namespace
}  // namespace blem_sim
