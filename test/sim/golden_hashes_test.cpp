// Hashes of states after some steps of a dozen scenes, as they were when somebody meant them: a change of bits is seen here first.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "sim/simulation_scene.h"
#include "sim/state/saved_scene.h"
#include "soak/heap.h"
#include "support/random/random_scene.h"
#include "support/shared_packages.h"
#include "support/throw_scene.h"

namespace blem_sim::sim {
namespace {

constexpr const char* FILE_OF_HASHES = BLEM_SIM_SOURCE_DIR "/test/data/golden_hashes.txt";

constexpr const char* HUMANOID = "robots/klampt/huboplus/huboplus.urdf";
constexpr const char* GRIPPER_URDF = "robots/robotiq_arg85_description/robots/robotiq_arg85_description.urdf";  // with mimic joints

/** One row of scenes: its name in the file, how it is made, and for how long it is simulated. */
struct GoldenScene {
  const char* name;
  SimulationConfig (*make)();
  double seconds;
  const char* shared = nullptr;  ///< file of the shared data that it needs
};

void PrintTo(const GoldenScene& scene, std::ostream* out) { *out << scene.name; }

SimulationConfig stackOfFive() {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 5; ++i)
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0.01 * i, 0, 0.055 + 0.11 * i}));
  return config;
}

SimulationConfig slidingOverPoints() {
  std::vector<Vector3> points;
  for (int i = 0; i < 2500; ++i) points.push_back({0.01 * (i % 50) - 0.25, 0.01 * (i / 50) - 0.25, 1e-3 * std::sin(0.7 * i)});
  SimulationConfig config;
  config.environments = {pointCloud("golden_points", points)};
  config.environments[0].contact.boundary_width = 0.01;
  config.objects = {box("slider", {0.1, 0.1, 0.05}, 1, {0, 0, 0.04})};
  config.objects[0].linear_velocity = {0.5, 0.1, 0};
  return config;
}

SimulationConfig mugOnTerrain() {
  geometry::TriangleMesh hills = geometry::gridMesh(1, 1, 60, 60);
  for (Vector3& v : hills.vertices) v.z() = 0.01 * std::sin(31 * v.x()) * std::cos(27 * v.y()) + 0.002 * std::sin(171 * v.x() + 90 * v.y());
  SimulationConfig config;
  EnvironmentConfig terrain;
  terrain.name = "terrain";
  terrain.uri = meshFile("golden_hills", hills);
  config.environments = {terrain};
  ObjectConfig mug;
  mug.name = "mug";
  mug.uri = BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl";
  mug.mass = 0.2;
  mug.X_WO = makePose({0, 0, 0.08}, {0.3, 0.2, 0.1});
  config.objects = {mug};
  return config;
}

SimulationConfig twoPendulums() {
  SimulationConfig config = sceneOfAllKinds();
  config.objects.clear();
  RobotConfig second = config.robots[0];
  second.name = "second";
  second.X_WR = makePose({1.2, 0, 0});
  second.gains["default"] = {30, 0, 1, 50};
  for (SensorConfig& sensor : second.sensors) sensor.name += "_2";
  config.robots.push_back(second);
  return config;
}

/** A robot of the shared data that falls onto hills while its motors hold the pose that is all zeros. */
SimulationConfig onHills(const std::string& urdf, double height) {
  SimulationConfig config = mugOnTerrain();
  config.objects.clear();
  RobotConfig robot;
  robot.name = "robot";
  robot.urdf = sharedData(urdf).value_or("");
  robot.X_WR = makePose({0, 0, height});
  robot.gains["default"] = {500, 0, 20, 0};
  robot.motor["default"] = MotorLaw::IMPLICIT_PD;
  robot.velocity_limits["default"] = std::numeric_limits<double>::infinity();
  config.robots = {robot};
  return config;
}

template <int SEED>
SimulationConfig random() {
  return randomScene(SEED).config;
}

const GoldenScene SCENES[] = {
    {"stack", stackOfFive, 0.3},
    {"heap", [] { return heapOfCubes(1, {}); }, 0.3},
    {"all_kinds", [] { return sceneOfAllKinds(); }, 0.2},
    {"points", slidingOverPoints, 0.2},
    {"mug_on_terrain", mugOnTerrain, 0.2},
    {"two_robots", twoPendulums, 0.2},
    {"throw", [] { return thrownScene(7).config; }, 0.03},
    {"hit_plate", [] { return thrownScene(1197).config; }, 0.01},
    {"random_3", random<3>, 0.1},
    {"random_11", random<11>, 0.1},
    {"random_17", random<17>, 0.1},
    {"random_23", random<23>, 0.1},
    {"humanoid", [] { return onHills(HUMANOID, 0.8); }, 0.05, HUMANOID},
    {"gripper", [] { return onHills(GRIPPER_URDF, 0.1); }, 0.15, GRIPPER_URDF},
};

/** Compiler, machine and libraries, which decide bits. */
std::string platform() {
  std::ostringstream out;
#if defined(__clang__)
  out << "clang-" << __clang_major__ << "." << __clang_minor__;
#else
  out << "gcc-" << __GNUC__ << "." << __GNUC_MINOR__;
#endif
#if defined(__x86_64__)
  out << "_x86_64";
#elif defined(__aarch64__)
  out << "_aarch64";
#else
  out << "_other";
#endif
#if defined(__GLIBC__)
  out << "_glibc-" << __GLIBC__ << "." << __GLIBC_MINOR__;
#endif
  out << "_eigen-" << EIGEN_WORLD_VERSION << "." << EIGEN_MAJOR_VERSION << "." << EIGEN_MINOR_VERSION;
  return out.str();
}

/** "platform scene stepper hash" per line. */
std::map<std::string, std::string> knownHashes() {
  std::map<std::string, std::string> hashes;
  std::ifstream file(FILE_OF_HASHES);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string where, scene, stepper, hash;
    if (line[0] != '#' && words >> where >> scene >> stepper >> hash) hashes[where + " " + scene + " " + stepper] = hash;
  }
  return hashes;
}

class GoldenHashes : public ::testing::TestWithParam<std::tuple<GoldenScene, const char*>> {};

TEST_P(GoldenHashes, NoBitHasMoved) {
  const auto& [scene, stepper] = GetParam();
  if (scene.shared) SKIP_WITHOUT_SHARED_DATA(scene.shared);
  SimulationConfig config = scene.make();
  config.solver.stepper = stepper;
  if (config.solver.stepper != "articulated")
    for (RobotConfig& robot : config.robots) robot.armature.clear();
  Simulator simulator(config, model::UriResolver(sharedPackages()));
  stepFor(&simulator, scene.seconds);
  const std::string key = platform() + " " + scene.name + " " + stepper, hash = fmt::format("{:016x}", simulator.stateHash());
  if (const char* file = std::getenv("BLEM_SIM_NEW_HASHES")) {
    std::ofstream(file, std::ios::app) << key << " " << hash << "\n";
    GTEST_SKIP() << "written to " << file;
  }
  const std::map<std::string, std::string> known = knownHashes();
  const auto at = known.find(key);
  if (at == known.end())
    GTEST_SKIP() << "no golden hash for " << key << ": scripts/print_golden_hashes writes those of this platform into " << FILE_OF_HASHES;
  EXPECT_EQ(hash, at->second) << key << ": bits have moved. If that is meant, say so in the commit and run scripts/print_golden_hashes";
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenHashes,
                         ::testing::Combine(::testing::ValuesIn(SCENES), ::testing::Values("articulated", "world_step", "quick_step")),
                         [](const auto& info) { return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param); });

}  // namespace
}  // namespace blem_sim::sim
