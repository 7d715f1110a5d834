// Live meshes as inputs: recorded, malformed, of nothing.
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/simulator_input.h"
#include "sim/clouds/live_mesh_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

/** Gives the calls of one simulation to another. */
class Twin : public SimulatorWatcher {
 public:
  explicit Twin(Simulator* twin) : twin_(twin) {}
  void told(const SimulatorInput& input) override { applyInput(input, twin_); }
  void stepped() override { twin_->step(); }

 private:
  Simulator* twin_;
};

TEST(LiveMesh, RecordedMeshesGiveTheSameBits) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver()), replayed(cubeAboveMesh(), model::UriResolver());
  Twin twin(&replayed);
  simulator.watch(&twin);
  SeenFloor floor(0.2);
  for (int i = 0; i < 4; ++i) {
    exchange(&simulator, floor.next());
    stepFor(&simulator, 0.1);
  }
  simulator.watch(nullptr);
  EXPECT_EQ(simulator.stateHash(), replayed.stateHash());
}

/** Every fourth triangle names a vertex twice. */
geometry::TriangleMesh malformedFloor() {
  geometry::TriangleMesh mesh = geometry::gridMesh(0.4, 0.4, 8, 8);
  for (std::size_t i = 0; i < mesh.elements.size(); i += 4) mesh.elements[i][2] = mesh.elements[i][0];
  return mesh;
}

TEST(LiveMesh, TrianglesThatNameAVertexTwiceAreNoSegments) {
  SimulationConfig config = cubeAboveMesh();
  config.environments[0].live.type = LiveConfig::Type::MESH;
  Simulator simulator(config, model::UriResolver()), replayed(config, model::UriResolver());
  Twin twin(&replayed);
  simulator.watch(&twin);
  CloudSurface surface = makeMeshSurface(malformedFloor(), "live");
  EXPECT_EQ(surface.report.degenerate, 32);
  EXPECT_EQ(surface.report.triangles, 96);
  EXPECT_EQ(surface.report.segments, 0);
  simulator.updateCloud("live", &surface);
  stepFor(&simulator, 0.1);
  simulator.watch(nullptr);
  EXPECT_EQ(simulator.stateHash(), replayed.stateHash());
  geometry::TriangleMesh nothing = geometry::gridMesh(1, 1, 1, 1);
  for (Vector3i& e : nothing.elements) e[2] = e[0];
  EXPECT_THROW(makeMeshSurface(nothing, "live"), InputError);
}

TEST(LiveMesh, SlotsAreUsedAgainHoweverOften) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.16, 0.0002, 0.02);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.3);
  for (int i = 0; i < (SANITIZED ? 100 : 1000); ++i) {
    exchange(&simulator, floor.next());
    if (i % 10 == 9) simulator.step();
  }
  EXPECT_EQ(simulator.models().size(), 2u);
  EXPECT_EQ(simulator.colliders().size(), 3u);
  EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 0.001);
}

TEST(LiveMesh, IsTakenAwayByASurfaceOfNothing) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver()), replayed(cubeAboveMesh(), model::UriResolver());
  Twin twin(&replayed);
  simulator.watch(&twin);
  SeenFloor floor(0.2);
  CloudSurface nothing;
  simulator.updateCloud("live", &nothing);
  EXPECT_EQ(simulator.colliders().size(), 1u);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.01);
  EXPECT_NEAR(carriedBy(simulator.report()), G, 0.1 * G);
  simulator.updateCloud("live", &nothing);
  EXPECT_TRUE(nothing.geometry) << "the caller frees what was there";
  CloudSurface again;
  simulator.updateCloud("live", &again);
  EXPECT_FALSE(again.geometry);
  const double before = bodyOf(simulator, "cube").v_WCom.z();
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.z(), before - 0.1 * G, 1e-9);
  exchange(&simulator, floor.next(-0.2));
  stepFor(&simulator, 0.5);
  EXPECT_NEAR(carriedBy(simulator.report()), G, 0.1 * G);
  simulator.watch(nullptr);
  EXPECT_EQ(simulator.stateHash(), replayed.stateHash());
}

TEST(LiveMesh, SettingsThatDoNotReachItAreTold) {
  SimulationConfig config = cubeAboveMesh();
  EXPECT_TRUE(Simulator(config, model::UriResolver()).notes().empty());
  config.contact.mending = model::Mending::OFF;
  config.environments[0].contact.shrink = true;
  const std::vector<std::string> notes = Simulator(config, model::UriResolver()).notes();
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].find("live: shrink does not reach meshes of topics"), 0u);
  EXPECT_EQ(notes[1].find("live: contact.mend_meshes: false does not reach meshes of topics"), 0u);
  config.environments[0].cloud.as = model::CloudOptions::As::POINTS;
  EXPECT_TRUE(Simulator(config, model::UriResolver()).notes().empty());
}

TEST(LiveMesh, PointsAreNoTriangles) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  CloudSurface points = makeCloudSurface(std::vector<Vector3>{{0, 0, 0}}, model::CloudOptions(), "live");
  EXPECT_THROW(simulator.updateCloud("live", &points), InputError);
}

}  // namespace
}  // namespace blem_sim::sim
