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

}  // namespace
}  // namespace blem_sim::sim
