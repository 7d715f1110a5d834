// Bodies whose meshes are broken stand where whole ones stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <tuple>

#include "contact/stl_soup.h"
#include "sim/simulation_scene.h"
#include "support/broken_meshes.h"
#include "support/sanitizers.h"
#include "support/shared_data.h"

namespace blem_sim::sim {
namespace {

constexpr double BROKEN_LAYER = 0.0025;  // [m]
constexpr double CRACKS = 1e-5;          // [m] in each coordinate
constexpr int CUBES = 10;
// A cube that rocks on cracks of 10 um may take 20 s to come to rest.
constexpr double SECONDS = SANITIZED ? 2 : 30;

/** A stack in its last second. */
struct Stack {
  double away = 0;          ///< [m] of the cube farthest from where theory puts it
  double rms_velocity = 0;  ///< [m/s]
  std::set<int> counts;     ///< of contacts
};

Stack stackOf(const std::vector<geometry::TriangleMesh>& cubes, const std::string& name, const std::string& stepper, double seconds) {
  SimulationConfig config;
  config.solver.stepper = stepper;
  config.environments = {ground()};
  for (int i = 0; i < CUBES; ++i) {
    ObjectConfig cube = box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0, 0, 0.06 + 0.11 * i});
    cube.uri = meshFile(name + std::to_string(i), cubes[i]);
    config.objects.push_back(cube);
  }
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, seconds - 1);
  Stack stack;
  double squares = 0;
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) {
    const StepReport& report = simulator.step();
    stack.counts.insert(report.reduced_contacts);
    for (const dynamics::BodyState& body : report.bodies) squares += body.v_WCom.squaredNorm();
  }
  stack.rms_velocity = std::sqrt(squares / (CUBES * steps));
  for (int i = 0; i < CUBES; ++i) {
    const Vector3 theory(0, 0, 0.05 + BROKEN_LAYER + i * (0.1 + 2 * BROKEN_LAYER));
    stack.away = std::max(stack.away, (bodyOf(simulator, "cube" + std::to_string(i)).X_WB.translation() - theory).norm());
  }
  std::printf("%s, %s: away %.3g um, rms %.3g m/s, %d to %d contacts\n", name.c_str(), stepper.c_str(), 1e6 * stack.away,
              stack.rms_velocity, *stack.counts.begin(), *stack.counts.rbegin());
  return stack;
}

std::vector<geometry::TriangleMesh> tenOf(const std::function<geometry::TriangleMesh(geometry::RandomShapes&)>& make) {
  geometry::RandomShapes random(31);
  std::vector<geometry::TriangleMesh> cubes;
  for (int i = 0; i < CUBES; ++i) cubes.push_back(make(random));
  return cubes;
}

void expectStands(const Stack& stack) {
  EXPECT_LT(stack.away, 1e-4);
  EXPECT_LT(stack.rms_velocity, 1e-5);
  EXPECT_EQ(stack.counts.size(), 1u);
}

const geometry::TriangleMesh BROKEN_CUBE = geometry::boxMesh(Vector3::Constant(0.1));

TEST(BrokenMeshes, TenCrackedCubesStand) {
  expectStands(stackOf(tenOf([](geometry::RandomShapes& random) { return crackedCopy(BROKEN_CUBE, CRACKS, random); }), "cracked",
                       "articulated", SECONDS));
}

TEST(BrokenMeshes, TenCubesWithTJunctionsStand) {
  expectStands(stackOf(tenOf([](geometry::RandomShapes& random) { return tJunctionCopy(shuffledCopy(BROKEN_CUBE, random)); }),
                       "t_junctions", "articulated", SECONDS));
}

TEST(BrokenMeshes, TenCrackedCubesWithTJunctionsStand) {
  expectStands(stackOf(tenOf([](geometry::RandomShapes& random) { return crackedCopy(tJunctionCopy(BROKEN_CUBE), CRACKS, random); }),
                       "cracked_t", "articulated", SECONDS));
}

/** A body on a surface. */
struct Resting {
  std::string name;
  geometry::TriangleMesh mesh, surface;
  Vector3 start;  ///< [m]
};

/** Pose of a body at rest, and the wrench that holds it: force [N] and torque [N m] about its origin. */
struct Rest {
  Pose X_WB;
  Wrench wrench;
  double speed = 0;  ///< [m/s]
};

/** Mass properties are given, as those of a mesh that is doubled or turned inside out are not the whole one's. */
Rest restOfFile(const Resting& scene, const std::string& file, double seconds) {
  SimulationConfig config;
  config.environments = {ground()};
  config.environments[0].uri = meshFile(scene.name + "_surface", scene.surface);
  const geometry::MassProperties inertial = geometry::massFromSurface(scene.mesh, 1);
  ObjectConfig object = box("body", Vector3::Constant(0.1), 1, scene.start);
  object.uri = file;
  object.com = inertial.com;
  object.inertia = inertial.inertia;
  object.max_contacts = 50;
  config.objects = {object};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, seconds);
  Rest rest;
  const dynamics::BodyState body = bodyOf(simulator, "body");
  rest.X_WB = body.X_WB;
  rest.speed = body.v_WCom.norm();
  for (const ContactReport& contact : simulator.report().contacts) {
    const Vector3 force = contact.body_a == simulator.models()[simulator.modelIndex("body")].bodies[0] ? contact.force : -contact.force;
    rest.wrench.force += force;
    rest.wrench.torque += (contact.point - body.X_WB.translation()).cross(force);
  }
  return rest;
}

Rest restOf(const Resting& scene, const geometry::TriangleMesh& mesh, double seconds) {
  return restOfFile(scene, meshFile(scene.name, mesh), seconds);
}

void expectSameRest(const Resting& scene) {
  const double seconds = 3;
  geometry::RandomShapes random(33);
  const Rest whole = restOf(scene, scene.mesh, seconds);
  const std::vector<std::tuple<const char*, geometry::TriangleMesh, double>> copies = {
      {"subdivided", geometry::subdivided(scene.mesh, 1), 1e-6},  {"shuffled", shuffledCopy(scene.mesh, random), 1e-6},
      {"rewound", rewoundCopy(scene.mesh, random), 1e-6},         {"doubled", doubledCopy(scene.mesh), 1e-6},
      {"unwelded", crackedCopy(scene.mesh, 0, random), 1e-6},     {"T-junctions", tJunctionCopy(scene.mesh), 1e-6},
      {"cracked", crackedCopy(scene.mesh, CRACKS, random), 1e-4},
  };
  std::printf("%s: speed %.2g m/s\n", scene.name.c_str(), whole.speed);
  EXPECT_NEAR(whole.wrench.force.z(), G, 1e-6 * G);
  for (std::size_t i = SANITIZED ? copies.size() - 1 : 0; i < copies.size(); ++i) {
    const auto& [name, mesh, tolerance] = copies[i];
    const Rest rest = restOf(scene, mesh, seconds);
    const double apart = (rest.X_WB.translation() - whole.X_WB.translation()).norm();
    const double force = (rest.wrench.force - whole.wrench.force).norm() / G,
                 torque = (rest.wrench.torque - whole.wrench.torque).norm() / (0.1 * G);
    std::printf("  %-12s apart %.3g um, wrench differs by %.2g, %.2g, speed %.2g m/s\n", name, 1e6 * apart, force, torque, rest.speed);
    EXPECT_LT(apart, tolerance) << name;
    if (tolerance < 1e-5) {
      EXPECT_LT(force, 1e-6) << name;
      EXPECT_LT(torque, 1e-6) << name;
    }
  }
}

geometry::TriangleMesh hills(double size, int cells, double height) {
  geometry::RandomShapes random(34);
  geometry::TriangleMesh mesh = geometry::gridMesh(size, size, cells, cells);
  for (Vector3& p : mesh.vertices) p.z() = random.uniform(-height, height);
  return mesh;
}

/** A mesh moved so that its lowest point is at z = 0. */
geometry::TriangleMesh restingOnGround(const geometry::TriangleMesh& mesh) {
  return geometry::transformed(mesh, makePose({0, 0, -mesh.bounds().min().z()}));
}

TEST(BrokenMeshes, CubeRestsWhereTheWholeOneDoes) {
  expectSameRest({"cube_rest", restingOnGround(BROKEN_CUBE), geometry::gridMesh(1, 1, 3, 3), {0.013, 0.021, 0.003}});
  expectSameRest({"cube_hills", restingOnGround(BROKEN_CUBE), hills(0.5, 20, 0.002), {0.013, 0.021, 0.006}});
}

TEST(BrokenMeshes, MugRestsWhereTheWholeOneDoes) {
  const geometry::TriangleMesh mug =
      restingOnGround(geometry::cleanMesh(contact::readStlSoup(BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl"), nullptr));
  expectSameRest({"mug_rest", mug, geometry::gridMesh(1, 1, 3, 3), {0.013, 0.021, 0.003}});
}

TEST(BrokenMeshes, FootRestsWhereTheWholeOneDoes) {
  const char* const FOOT = "robots/klampt/huboplus/meshes/Body_LAR_col_simple.stl";
  SKIP_WITHOUT_SHARED_DATA(FOOT);
  const geometry::TriangleMesh foot = restingOnGround(geometry::cleanMesh(contact::readStlSoup(*sharedData(FOOT)), nullptr));
  expectSameRest({"foot_hills", foot, hills(0.8, 30, 0.002), {0.013, 0.021, 0.006}});
}

/** Files with the cube's sole. */
TEST(BrokenMeshes, PathologicalCubesRestWhereTheWholeOneDoes) {
  SKIP_WITHOUT_SHARED_DATA("pathological");
  const Resting scene = {"pathological", BROKEN_CUBE, geometry::gridMesh(1, 1, 3, 3), {0.013, 0.021, 0.053}};
  const Rest whole = restOf(scene, scene.mesh, 3);
  for (const char* name : {"cube_duplicate_faces", "cube_flipped", "cube_zero_area", "cube_nan", "cube_nested_self_intersecting",
                           "cube_layers", "cube_nonmanifold_fins", "cube_open_bottom", "cube_slivers", "cube_holes"}) {
    const Rest rest = restOfFile(scene, *sharedData(std::string("pathological/") + name + ".ply"), 3);
    const double apart = (rest.X_WB.translation() - whole.X_WB.translation()).norm();
    std::printf("  %-22s apart %.3g um, speed %.2g m/s\n", name, 1e6 * apart, rest.speed);
    EXPECT_LT(apart, 1e-6) << name;
    EXPECT_LT((rest.wrench.force - whole.wrench.force).norm(), 1e-6 * G) << name;
    EXPECT_LT((rest.wrench.torque - whole.wrench.torque).norm(), 1e-6 * 0.1 * G) << name;
  }
}

/** Triangles off by 0.15 mm and more are no crack any more but a shape: the soup stands on the corners that stick out most. */
TEST(BrokenMeshes, SoupOfTrianglesStandsOnWhatSticksOut) {
  const char* const SOUP = "pathological/cube_cracked_soup.ply";
  SKIP_WITHOUT_SHARED_DATA(SOUP);
  const Resting scene = {"soup", BROKEN_CUBE, geometry::gridMesh(1, 1, 3, 3), {0.013, 0.021, 0.053}};
  const Rest rest = restOfFile(scene, *sharedData(SOUP), 3);
  EXPECT_LT(rest.speed, 1e-9);
  EXPECT_GT(rest.X_WB.translation().z(), 0.05 + BROKEN_LAYER);
  EXPECT_LT(rest.X_WB.translation().z(), 0.05 + BROKEN_LAYER + 0.0004);
}

bool notesHold(const Simulator& simulator, const std::string& words) {
  const std::vector<std::string>& notes = simulator.loadReport()[0].notes;
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(BrokenMeshes, TheLoadReportSaysWhatWasMended) {
  geometry::RandomShapes random(35);
  SimulationConfig config;
  ObjectConfig object = box("body", Vector3::Constant(0.1), 1, {0, 0, 1});
  object.uri = meshFile("told", crackedCopy(tJunctionCopy(BROKEN_CUBE), CRACKS, random));
  config.objects = {object};
  const Simulator mended(config, model::UriResolver());
  EXPECT_TRUE(notesHold(mended, "cracks up to"));
  EXPECT_TRUE(notesHold(mended, "edges split at T-junctions"));
  EXPECT_TRUE(notesHold(mended, "onto 6 planes"));
  EXPECT_TRUE(mended.loadReport()[0].closed);
  config.contact.mending = model::Mending::OFF;
  const Simulator as_it_is(config, model::UriResolver());
  EXPECT_FALSE(notesHold(as_it_is, "cracks"));
  EXPECT_EQ(as_it_is.loadReport()[0].open_edges, 3 * as_it_is.loadReport()[0].triangles);
}

}  // namespace
}  // namespace blem_sim::sim
