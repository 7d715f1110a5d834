// Curved and noisy bodies come to rest and stay: they neither wander nor change their contacts.
#include <gtest/gtest.h>

#include "geometry/random_shapes.h"
#include "sim/simulation_scene.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

EnvironmentConfig environment(const std::string& name, const TriangleMesh& mesh) {
  EnvironmentConfig config;
  config.name = name;
  config.uri = meshFile(name, mesh);
  return config;
}

ObjectConfig object(const std::string& name, const TriangleMesh& mesh, const Pose& X_WO) {
  ObjectConfig config;
  config.name = name;
  config.uri = meshFile(name, mesh);
  config.mass = 0.5;
  config.X_WO = X_WO;
  return config;
}

ObjectConfig mug(const Pose& X_WO) {
  ObjectConfig config;
  config.name = "mug";
  config.uri = std::string(BLEM_SIM_SOURCE_DIR) + "/meshes/shell_mug.stl";
  config.mass = 0.3;
  config.X_WO = X_WO;
  return config;
}

TriangleMesh noisyPlane() {
  RandomShapes random(5);
  TriangleMesh mesh = gridMesh(0.4, 0.4, 100, 100);
  for (Vector3& v : mesh.vertices) v.z() = random.uniform(-0.0005, 0.0005);
  return mesh;
}

/** Runs for `settling` [s], then watches for ten seconds. @param wander [m] allowed sideways in that time */
void expectRest(const std::string& name, const SimulationConfig& config, double settling, double wander) {
  Simulator simulator(config, UriResolver());
  const Vector3 dropped = bodyOf(simulator, config.objects.back().name).X_WB.translation();
  stepFor(&simulator, settling);
  const Vector3 start = bodyOf(simulator, config.objects.back().name).X_WB.translation();
  int changes = 0, contacts = simulator.report().reduced_contacts;
  double speed = 0, turning = 0;
  for (int k = 0; k < soakSteps(10, 2); ++k) {
    const StepReport& report = simulator.step();
    changes += report.reduced_contacts != contacts;
    contacts = report.reduced_contacts;
    const BodyState state = bodyOf(simulator, config.objects.back().name);
    speed = std::max(speed, state.v_WCom.norm());
    turning = std::max(turning, state.w_WB.norm());
  }
  const double moved = (bodyOf(simulator, config.objects.back().name).X_WB.translation() - start).head<2>().norm();
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

SimulationConfig scene(const EnvironmentConfig& ground) {
  SimulationConfig config;
  config.solver = soakSettings();
  config.environments = {ground};
  return config;
}

const TriangleMesh& ball() {
  static const TriangleMesh mesh = icosphereMesh(0.03, 3);
  return mesh;
}

// 1,280 triangles: it rolls on to the next facet, some 3 mm wide, and stays there.
TEST(SoakRest, BallOnTwoTriangles) {
  SimulationConfig config = scene(environment("two_triangles", gridMesh(1, 1, 1, 1)));
  config.objects = {object("ball", ball(), makePose({0.013, 0.007, 0.0335}, {0.1, 0.2, 0.3}))};
  expectRest("ball on 2 triangles", config, 5, 1e-6);
}

TEST(SoakRest, BallOnFineTriangles) {
  SimulationConfig config = scene(environment("fine", gridMesh(0.3, 0.3, 300, 300)));
  config.objects = {object("ball", ball(), makePose({0.0132, 0.0073, 0.0335}, {0.1, 0.2, 0.3}))};
  expectRest("ball on 1 mm triangles", config, 5, 1e-6);
}

// The icosphere stands on the facet at its bottom: there is nowhere to go.
TEST(SoakRest, BallOnItsFacet) {
  const Vector3i& e = ball().elements[0];
  const Vector3 &p = ball().vertices[e[0]], &q = ball().vertices[e[1]], &r = ball().vertices[e[2]];
  Vector3 facet = (q - p).cross(r - p).normalized();
  if (facet.dot(p) < 0) facet = -facet;
  SimulationConfig config = scene(environment("two_triangles", gridMesh(1, 1, 1, 1)));
  ObjectConfig resting = object("ball", ball(), makePose({0.013, 0.007, 0.0325}));
  resting.X_WO.linear() = Quaternion::FromTwoVectors(facet, -Vector3::UnitZ()).toRotationMatrix();
  config.objects = {resting};
  expectRest("ball on its facet", config, 0, 1e-4);
}

TEST(SoakRest, CubeOnNoise) {
  SimulationConfig config = scene(environment("noisy", noisyPlane()));
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.003, 0.002, 0.056})};
  expectRest("cube on noise", config, 3, 1e-6);
}

TEST(SoakRest, MugOnBox) {
  SimulationConfig config = scene(ground());
  config.objects = {box("box", Vector3::Constant(0.1), 1, {0, 0, 0.0525}), mug(makePose({0.003, 0.002, 0.16}))};
  expectRest("mug on box", config, 5, 1e-6);
}

TEST(SoakRest, MugOnTable) {
  SimulationConfig config = scene(ground());
  config.objects = {mug(makePose({0.003, 0.002, 0.06}))};
  expectRest("mug on table", config, 5, 1e-6);
}

TEST(SoakRest, MugOnNoise) {
  SimulationConfig config = scene(environment("noisy", noisyPlane()));
  config.objects = {mug(makePose({0.003, 0.002, 0.06}))};
  expectRest("mug on noise", config, 5, 1e-6);
}

}  // namespace
}  // namespace blem_sim
