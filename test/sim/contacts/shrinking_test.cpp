// Meshes shrunk by their layers: the size of a model, and the words of the load report.
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

TEST(Shrinking, CubesStandAtThePitchOfTheirSize) {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 5; ++i) {
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0, 0, 0.052 + 0.103 * i}));
    config.objects.back().contact.shrink = true;
  }
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(bodyOf(simulator, "cube" + std::to_string(i)).X_WB.translation().z(), 0.05 + 0.1 * i, 1e-6) << i;
}

TEST(Shrinking, ReportSaysWhatStaysAndWhatDoesNot) {
  SimulationConfig config;
  config.contact.shrink = true;
  config.environments = {ground()};
  config.environments[0].contact.boundary_width = 0.001;
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.1}), box("plate", {0.1, 0.1, 0.004}, 1, {1, 0, 0.1}),
                    box("plain", Vector3::Constant(0.1), 1, {2, 0, 0.1})};
  config.objects[2].contact.shrink = false;
  Simulator simulator(config, model::UriResolver());
  const auto said = [&simulator](int model) {
    std::string all;
    for (const std::string& note : simulator.loadReport()[model].notes) all += note + "\n";
    return all;
  };
  EXPECT_NE(said(0).find("not shrunk: it is open"), std::string::npos) << said(0);
  EXPECT_NE(said(1).find("shrunk by 2.5 mm; outer dimensions stay"), std::string::npos) << said(1);
  EXPECT_NE(said(2).find("outside stands out by up to"), std::string::npos) << said(2);
  EXPECT_EQ(said(3).find("shrunk"), std::string::npos) << said(3);
}

ObjectConfig can(const std::string& name, double radius, double length, const Vector3& p) {
  ObjectConfig object;
  object.name = name;
  object.urdf_xml = fmt::format(
      R"(<robot name="can"><link name="can"><inertial><mass value="1"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
         <collision><geometry><cylinder radius="{}" length="{}"/></geometry></collision></link></robot>)",
      radius, length);
  object.X_WO = makePose(p);
  return object;
}

TEST(Shrinking, CylindersOfAUrdfKeepTheirSizeAnyway) {
  SimulationConfig config;
  config.environments.resize(1);
  config.environments[0].name = "plane";
  config.environments[0].plane = Eigen::Vector4d(0, 0, 1, 0);
  config.objects = {can("standing", 0.05, 0.1, {0, 0, 0.05}), can("lying", 0.05, 0.1, {1, 0, 0.05}),
                    can("thin", 0.05, 0.002, {2, 0, 0.001})};
  config.objects[1].X_WO.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()).toRotationMatrix();
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.2);
  EXPECT_NEAR(bodyOf(simulator, "standing").X_WB.translation().z(), 0.05, 1e-9);
  EXPECT_NEAR(bodyOf(simulator, "lying").X_WB.translation().z(), 0.05, 1e-9);
  EXPECT_NEAR(bodyOf(simulator, "thin").X_WB.translation().z(), 0.001, 1e-9);
  EXPECT_EQ(simulator.loadReport()[1].boundary_width, 0.0025);
  EXPECT_EQ(simulator.loadReport()[3].boundary_width, 0.0005);
}

TEST(Shrinking, WhatIsSeenIsTheSurfaceThatTheLayerReaches) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {can("can", 0.05, 0.1, {0, 0, 0.05}), box("cube", Vector3::Constant(0.1), 1, {1, 0, 0.05})};
  config.objects[1].contact.shrink = true;
  const Simulator simulator(config, model::UriResolver());
  for (const contact::Collider& collider : simulator.colliders()) {
    const double layer = collider.body < 0 ? 0 : 2 * 0.0025;
    EXPECT_NEAR(collider.seen()->bounds().sizes().x() - collider.geometry->bounds().sizes().x(), layer, 1e-12) << collider.name;
  }
}

}  // namespace
}  // namespace blem_sim::sim
