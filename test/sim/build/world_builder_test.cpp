#include <algorithm>
#include <optional>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

std::string refusalOfWorld(const SimulationConfig& config) {
  try {
    Simulator simulator(config, model::UriResolver());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

bool anyContains(const std::vector<std::string>& texts, const std::string& words) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return contains(text, words); });
}

TEST(WorldBuilder, SameFileIsOneGeometry) {
  SimulationConfig config;
  for (int i = 0; i < 18; ++i) config.objects.push_back(box("mug" + std::to_string(i), Vector3::Constant(0.1), 1, {0.2 * i, 0, 1}));
  config.objects.push_back(box("large", Vector3::Constant(0.1), 1, {0, 1, 1}));
  config.objects.back().scale = Vector3::Constant(2);
  Simulator simulator(config, model::UriResolver());
  for (int i = 1; i < 18; ++i) EXPECT_EQ(simulator.colliders()[i].geometry, simulator.colliders()[0].geometry);
  EXPECT_NE(simulator.colliders()[18].geometry, simulator.colliders()[0].geometry);
  EXPECT_EQ(simulator.loadReport().size(), 19u);
  EXPECT_EQ(simulator.bodyName(0), "mug0::link");
  EXPECT_EQ(simulator.bodyName(dynamics::WORLD_BODY), "world");
}

TEST(WorldBuilder, MassFromVolumeSurfaceOrConfiguration) {
  SimulationConfig config;
  const Vector3 size(0.1, 0.2, 0.3);
  config.objects = {box("closed", size, 2, {0, 0, 1}), box("open", size, 2, {1, 0, 1}), box("given", size, 2, {2, 0, 1})};
  config.objects[0].X_OM = makePose({0.05, 0, 0}, {0, 0, M_PI / 2});
  geometry::TriangleMesh open = geometry::boxMesh(size);
  open.elements.pop_back();
  config.objects[1].uri = meshFile("open_box", open);
  config.objects[2].com = Vector3(0.01, 0.02, 0.03);
  config.objects[2].inertia = Matrix3(0.5 * Matrix3::Identity());
  Simulator simulator(config, model::UriResolver());
  const geometry::MassProperties closed = simulator.world().bodySpec(0).inertial;
  EXPECT_EQ(closed.mass, 2);
  EXPECT_LT((closed.com - Vector3(0.05, 0, 0)).norm(), 1e-12);
  // The box is turned by 90 degrees: 0.2 m along x now. The file is read in single precision.
  EXPECT_NEAR(closed.inertia(0, 0), 2.0 / 12 * (0.01 + 0.09), 1e-8);
  EXPECT_NEAR(closed.inertia(1, 1), 2.0 / 12 * (0.04 + 0.09), 1e-8);
  EXPECT_GT(simulator.world().bodySpec(1).inertial.inertia(0, 0), 2.0 / 12 * (0.04 + 0.09));
  EXPECT_EQ(simulator.world().bodySpec(2).inertial.inertia(0, 0), 0.5);
  EXPECT_TRUE(anyContains(simulator.loadReport()[0].notes, "volume"));
  EXPECT_TRUE(anyContains(simulator.loadReport()[1].notes, "surface"));
}

TEST(WorldBuilder, BoundaryWidths) {
  SimulationConfig config;
  config.contact.boundary_width = 0.003;
  config.environments = {ground()};
  config.objects = {box("default", Vector3::Constant(0.1), 1, {0, 0, 1}), box("own", Vector3::Constant(0.1), 1, {1, 0, 1})};
  config.objects[1].contact.boundary_width = 0.007;
  config.objects[1].contact.friction = 0.9;
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(simulator.colliders()[0].radius, 0);
  EXPECT_EQ(simulator.colliders()[1].radius, 0.003);
  EXPECT_EQ(simulator.colliders()[2].radius, 0.007);
  EXPECT_EQ(simulator.colliders()[2].surface.friction, 0.9);
  EXPECT_EQ(simulator.loadReport()[2].boundary_width, 0.007);
}

TEST(WorldBuilder, InitialVelocityIsOfTheObjectsOrigin) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.objects = {box("spinner", Vector3::Constant(0.1), 1, {0, 0, 1})};
  config.objects[0].com = Vector3(0.02, 0, 0);
  config.objects[0].linear_velocity = {1, 0, 0};
  config.objects[0].angular_velocity = {0, 0, 5};
  Simulator simulator(config, model::UriResolver());
  EXPECT_LT((bodyOf(simulator, "spinner").v_WCom - Vector3(1, 0.1, 0)).norm(), 1e-12);
}

// a x + b y + c z = d: a normal of any length, here the plane 0.5 above the origin along (0, 0.6, 0.8).
TEST(WorldBuilder, PlanesWithNormalsOfAnyLengthLieWhereTheirEquationSays) {
  for (const double length : {1e-3, 1.0, 2.0, 1e4}) {
    SimulationConfig config;
    EnvironmentConfig ground;
    ground.name = "ground";
    ground.plane = length * Eigen::Vector4d(0, 0.6, 0.8, 0.5);
    config.environments = {ground};
    Simulator simulator(config, model::UriResolver());
    const contact::CollisionGeometry& plane = *simulator.colliders()[0].geometry;
    EXPECT_NEAR(plane.planeOffset(), 0.5, 1e-15) << length;
    EXPECT_LT((plane.planeNormal() - Vector3(0, 0.6, 0.8)).norm(), 1e-15) << length;
  }
}

/** Whether the file of an environment is said to show it. */
bool isShownByItsFile(const EnvironmentConfig& environment) {
  SimulationConfig config;
  config.environments = {environment};
  return Simulator(config, model::UriResolver()).models()[0].file.has_value();
}

TEST(WorldBuilder, AFileShowsAnEnvironmentThatIsNotChanged) {
  EnvironmentConfig terrain = ground();
  terrain.scale = Vector3(1, 2, 3);
  SimulationConfig config;
  config.environments = {terrain};
  const Simulator simulator(config, model::UriResolver());
  const std::optional<SurfaceFile>& file = simulator.models()[0].file;
  ASSERT_TRUE(file.has_value());
  EXPECT_EQ(file->path, terrain.uri);
  EXPECT_EQ(file->uri, "file://" + terrain.uri);
  EXPECT_EQ(file->scale, terrain.scale);
}

/** Its file has the surface that its layer reaches. */
TEST(WorldBuilder, AFileShowsAnEnvironmentThatIsShrunk) {
  EnvironmentConfig shrunk = ground();
  shrunk.uri = meshFile("block_to_shrink", geometry::boxMesh(Vector3::Ones()));
  shrunk.contact.boundary_width = 0.01;
  shrunk.contact.shrink = true;
  EXPECT_TRUE(isShownByItsFile(shrunk));
}

TEST(WorldBuilder, TheLoadReportCountsTheSurfaceOfAShrunkMeshToo) {
  SimulationConfig config;
  config.environments = {ground()};
  config.environments[0].uri = meshFile("block_to_count", geometry::boxMesh(Vector3::Ones()));
  config.environments[0].contact.boundary_width = 0.01;
  const std::size_t plain = Simulator(config, model::UriResolver()).loadReport()[0].bytes;
  config.environments[0].contact.shrink = true;
  EXPECT_GE(Simulator(config, model::UriResolver()).loadReport()[0].bytes, 2 * plain);
}

TEST(WorldBuilder, AFileDoesNotShowAnEnvironmentThatIsChanged) {
  ASSERT_TRUE(isShownByItsFile(ground()));
  EnvironmentConfig mirrored = ground();
  mirrored.scale.x() = -1;
  EXPECT_FALSE(isShownByItsFile(mirrored));
  EnvironmentConfig far_away = ground();
  geometry::TriangleMesh grid = geometry::gridMesh(4, 4, 1, 1);
  for (Vector3& vertex : grid.vertices) vertex.x() += 1e6;
  far_away.uri = meshFile("ground_far_away", grid);
  EXPECT_FALSE(isShownByItsFile(far_away));
  EnvironmentConfig damaged = ground();
  damaged.uri = sceneFile("ground_with_a_hole.ply", [](std::ofstream& out) {
    out << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
           "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\nnan 1 0\n3 0 1 2\n3 1 3 2\n";
  });
  EXPECT_FALSE(isShownByItsFile(damaged));
  EnvironmentConfig points = ground();
  points.cloud.as = model::CloudOptions::As::POINTS;
  EXPECT_FALSE(isShownByItsFile(points));
  EXPECT_FALSE(isShownByItsFile(pointCloud("cloud", {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)})));
  EnvironmentConfig plane;
  plane.name = "plane";
  plane.plane = Eigen::Vector4d(0, 0, 1, 0);
  EXPECT_FALSE(isShownByItsFile(plane));
}

TEST(WorldBuilder, RefusesInWords) {
  SimulationConfig config;
  config.environments = {ground(), ground()};
  EXPECT_TRUE(contains(refusalOfWorld(config), "ground: the name is taken"));
  config.environments = {ground()};
  config.environments[0].uri = "no_such_mesh.stl";
  EXPECT_TRUE(contains(refusalOfWorld(config), "environments: ground")) << refusalOfWorld(config);
  EXPECT_TRUE(contains(refusalOfWorld(config), "no_such_mesh.stl"));
  config.environments = {};
  config.objects = {box("cube", Vector3::Constant(0.1), 0, {0, 0, 1})};
  EXPECT_TRUE(contains(refusalOfWorld(config), "cube: mass")) << refusalOfWorld(config);
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 1})};
  config.contact.reduction = "hul";
  EXPECT_TRUE(contains(refusalOfWorld(config), "hull")) << refusalOfWorld(config);
  config.contact.reduction = "hull";
  config.time_step = 0;
  EXPECT_TRUE(contains(refusalOfWorld(config), "time_step")) << refusalOfWorld(config);
  config.time_step = 0.001;
  config.solver.stepper = "jump_step";
  EXPECT_TRUE(contains(refusalOfWorld(config), "world_step")) << refusalOfWorld(config);
}

}  // namespace
}  // namespace blem_sim::sim
