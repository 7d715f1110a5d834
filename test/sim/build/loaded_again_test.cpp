// A simulation that is given another one shares what that has loaded, and is none the different for it.
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

std::string footUrdf(const std::string& mesh, double mass) {
  return fmt::format(
      R"(<robot name="foot"><link name="sole"><inertial><mass value="{}"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>)"
      R"(</inertial><collision><geometry><mesh filename="file://{}"/></geometry></collision></link></robot>)",
      mass, mesh);
}

std::string writeFoot(const std::string& urdf) {
  return sceneFile("loaded_again.urdf", [&](std::ofstream& out) { out << urdf; });
}

/** A mesh environment, an object and a robot whose URDF names a mesh, colliders 0 to 2 in this order: ground, robot, object. */
SimulationConfig sceneOfFiles() {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.5, 0, 0.06})};
  RobotConfig foot = robot("foot", "", false);
  foot.urdf = writeFoot(footUrdf(meshFile("loaded_again", geometry::boxMesh({0.2, 0.1, 0.05})), 1));
  foot.X_WR = makePose({0, 0, 0.03});
  config.robots = {foot};
  return config;
}

/** Whether each collider of `other` has the geometry of the same one of `first`. */
std::vector<bool> shared(const Simulator& first, const Simulator& other) {
  std::vector<bool> same;
  for (std::size_t i = 0; i < first.colliders().size(); ++i) same.push_back(first.colliders()[i].geometry == other.colliders()[i].geometry);
  return same;
}

TEST(LoadedAgain, GeometriesAreSharedAndMotionIsTheSame) {
  const SimulationConfig config = sceneOfFiles();
  auto first = std::make_unique<Simulator>(config, model::UriResolver());
  stepFor(first.get(), 0.02);
  Simulator second(config, model::UriResolver(), {}, first.get()), alone(config, model::UriResolver());
  EXPECT_EQ(shared(*first, second), std::vector<bool>({true, true, true}));
  EXPECT_EQ(shared(*first, alone), std::vector<bool>({false, false, false}));
  EXPECT_EQ(first->robots()[0].description, second.robots()[0].description);
  first.reset();
  for (Simulator* simulator : {&second, &alone}) stepFor(simulator, 0.05);
  EXPECT_EQ(second.stateHash(), alone.stateHash());
  EXPECT_EQ(second.loadReport().size(), alone.loadReport().size());
}

TEST(LoadedAgain, FilesThatWereWrittenSinceAreReadAgain) {
  const SimulationConfig config = sceneOfFiles();
  const Simulator first(config, model::UriResolver());
  meshFile("loaded_again", geometry::gridMesh(0.2, 0.1, 3, 3));
  const Simulator other_mesh(config, model::UriResolver(), {}, &first);
  EXPECT_EQ(shared(first, other_mesh), std::vector<bool>({true, false, true}));
  EXPECT_EQ(other_mesh.colliders()[1].geometry->mesh().elements.size(), 18u);

  writeFoot(footUrdf(meshFile("loaded_again", geometry::gridMesh(0.2, 0.1, 3, 3)), 12.5));
  const Simulator other_urdf(config, model::UriResolver(), {}, &other_mesh);
  EXPECT_EQ(other_urdf.world().bodySpec(other_urdf.models()[1].bodies[0]).inertial.mass, 12.5);

  std::ofstream(config.environments[0].uri, std::ios::app) << "\n# another size\n";
  EXPECT_EQ(shared(first, Simulator(config, model::UriResolver(), {}, &first))[0], false);
}

TEST(LoadedAgain, WhatIsMendedOtherwiseIsReadAgain) {
  SimulationConfig config = sceneOfFiles();
  const Simulator first(config, model::UriResolver());
  config.contact.mending = model::Mending::OFF;
  const Simulator unmended(config, model::UriResolver(), {}, &first);
  EXPECT_EQ(shared(first, unmended), std::vector<bool>({false, false, false}));
  EXPECT_NE(first.robots()[0].description, unmended.robots()[0].description);
}

}  // namespace
}  // namespace blem_sim::sim
