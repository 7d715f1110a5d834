// Curved and noisy bodies come to rest and stay: they neither wander nor change their contacts.
#include <gtest/gtest.h>

#include "blem_sim/geometry/shortest_turn.h"
#include "geometry/random_shapes.h"
#include "sim/simulation_scene.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

sim::EnvironmentConfig environment(const std::string& name, const geometry::TriangleMesh& mesh) {
  sim::EnvironmentConfig config;
  config.name = name;
  config.uri = sim::meshFile(name, mesh);
  return config;
}

sim::ObjectConfig object(const std::string& name, const geometry::TriangleMesh& mesh, const Pose& X_WO) {
  sim::ObjectConfig config;
  config.name = name;
  config.uri = sim::meshFile(name, mesh);
  config.mass = 0.5;
  config.X_WO = X_WO;
  return config;
}

sim::ObjectConfig mug(const Pose& X_WO) {
  sim::ObjectConfig config;
  config.name = "mug";
  config.uri = std::string(BLEM_SIM_SOURCE_DIR) + "/meshes/shell_mug.stl";
  config.mass = 0.3;
  config.X_WO = X_WO;
  return config;
}

geometry::TriangleMesh noisyPlane() {
  geometry::RandomShapes random(5);
  geometry::TriangleMesh mesh = geometry::gridMesh(0.4, 0.4, 100, 100);
  for (Vector3& v : mesh.vertices) v.z() = random.uniform(-0.0005, 0.0005);
  return mesh;
}

/** Runs for `settling` [s], then watches for ten seconds. @param wander [m] allowed sideways in that time */
void expectRest(const std::string& name, const sim::SimulationConfig& config, double settling, double wander) {
  sim::Simulator simulator(config, model::UriResolver());
  const Vector3 dropped = sim::bodyOf(simulator, config.objects.back().name).X_WB.translation();
  sim::stepFor(&simulator, settling);
  const Vector3 start = sim::bodyOf(simulator, config.objects.back().name).X_WB.translation();
  int changes = 0, contacts = simulator.report().reduced_contacts;
  double speed = 0, turning = 0;
  for (int k = 0; k < soakSteps(10, 2); ++k) {
    const sim::StepReport& report = simulator.step();
    changes += report.reduced_contacts != contacts;
    contacts = report.reduced_contacts;
    const dynamics::BodyState state = sim::bodyOf(simulator, config.objects.back().name);
    speed = std::max(speed, state.v_WCom.norm());
    turning = std::max(turning, state.w_WB.norm());
  }
  const double moved = (sim::bodyOf(simulator, config.objects.back().name).X_WB.translation() - start).head<2>().norm();
  figure(name + ": rolled or slid while it settled", 1e6 * (start - dropped).head<2>().norm(), "um");
  figure(name + ": wanders", 1e6 * moved, "um");
  figure(name + ": speed at rest", speed, "m/s");
  figure(name + ": turning at rest", turning, "rad/s");
  figure(name + ": contacts", contacts, "");
  figure(name + ": changes of their number", changes, "");
  EXPECT_LT(moved, wander);
  if (settling > 0) {
    EXPECT_EQ(changes, 0);
    EXPECT_LT(speed, 1e-6);
  }
}

sim::SimulationConfig scene(const sim::EnvironmentConfig& ground) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  config.environments = {ground};
  return config;
}

const geometry::TriangleMesh& ball() {
  static const geometry::TriangleMesh mesh = geometry::icosphereMesh(0.03, 3);
  return mesh;
}

// 1,280 triangles: it rolls on to the next facet, some 3 mm wide, and stays there.
TEST(SoakRest, BallOnTwoTriangles) {
  sim::SimulationConfig config = scene(environment("two_triangles", geometry::gridMesh(1, 1, 1, 1)));
  config.objects = {object("ball", ball(), makePose({0.013, 0.007, 0.0335}, {0.1, 0.2, 0.3}))};
  expectRest("ball on 2 triangles", config, 5, 1e-6);
}

TEST(SoakRest, BallOnFineTriangles) {
  sim::SimulationConfig config = scene(environment("fine", geometry::gridMesh(0.3, 0.3, 300, 300)));
  config.objects = {object("ball", ball(), makePose({0.0132, 0.0073, 0.0335}, {0.1, 0.2, 0.3}))};
  expectRest("ball on 1 mm triangles", config, 5, 1e-6);
}

// The icosphere stands on the facet at its bottom: there is nowhere to go.
TEST(SoakRest, BallOnItsFacet) {
  const Vector3i& e = ball().elements[0];
  const Vector3 &p = ball().vertices[e[0]], &q = ball().vertices[e[1]], &r = ball().vertices[e[2]];
  Vector3 facet = (q - p).cross(r - p).normalized();
  if (facet.dot(p) < 0) facet = -facet;
  sim::SimulationConfig config = scene(environment("two_triangles", geometry::gridMesh(1, 1, 1, 1)));
  sim::ObjectConfig resting = object("ball", ball(), makePose({0.013, 0.007, 0.0325}));
  resting.X_WO.linear() = geometry::shortestTurn(facet, -Vector3::UnitZ()).toRotationMatrix();
  config.objects = {resting};
  expectRest("ball on its facet", config, 0, 1e-4);
}

TEST(SoakRest, CubeOnNoise) {
  sim::SimulationConfig config = scene(environment("noisy", noisyPlane()));
  config.objects = {sim::box("cube", Vector3::Constant(0.1), 1, {0.003, 0.002, 0.056})};
  expectRest("cube on noise", config, 3, 1e-6);
}

TEST(SoakRest, MugOnBox) {
  sim::SimulationConfig config = scene(sim::ground());
  config.objects = {sim::box("box", Vector3::Constant(0.1), 1, {0, 0, 0.0525}), mug(makePose({0.003, 0.002, 0.16}))};
  expectRest("mug on box", config, 5, 1e-6);
}

TEST(SoakRest, MugOnTable) {
  sim::SimulationConfig config = scene(sim::ground());
  config.objects = {mug(makePose({0.003, 0.002, 0.06}))};
  expectRest("mug on table", config, 5, 1e-6);
}

TEST(SoakRest, MugOnNoise) {
  sim::SimulationConfig config = scene(environment("noisy", noisyPlane()));
  config.objects = {mug(makePose({0.003, 0.002, 0.06}))};
  expectRest("mug on noise", config, 5, 1e-6);
}

}  // namespace
}  // namespace blem_sim
