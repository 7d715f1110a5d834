// A box at rest on the cloud of a box, joined to triangles by each mesher.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double LAYER_OF_CUBE = 0.0025;  // [m]

/** Points of a box of 0.3 x 0.3 x 0.1 m below z = 0, all sides. */
std::vector<Vector3> boxPoints(double spacing) {
  const Vector3i counts = (Vector3(0.3, 0.3, 0.1) / spacing).array().round().cast<int>();
  std::vector<Vector3> points;
  for (int i = 0; i <= counts.x(); ++i)
    for (int j = 0; j <= counts.y(); ++j)
      for (int k = 0; k <= counts.z(); ++k)
        if (i % counts.x() == 0 || j % counts.y() == 0 || k % counts.z() == 0)
          points.emplace_back(spacing * i - 0.15, spacing * j - 0.15, -spacing * k);
  return points;
}

TEST(MeshedCloud, ABoxRestsOnTheCloudOfABoxWithinAThirdOfTheSpacing) {
  using Mesher = model::CloudOptions::Mesher;
  for (const Mesher mesher : {Mesher::GREEDY_PROJECTION, Mesher::MARCHING_CUBES, Mesher::POISSON})
    for (const double spacing : {0.002, 0.005, 0.01, 0.02}) {
      if (spacing < (SANITIZED ? 0.02 : samples(1) > 1 ? 0.002 : 0.005)) continue;
      const std::string which = "mesher " + std::to_string(static_cast<int>(mesher)) + ", " + std::to_string(spacing) + " m";
      SimulationConfig config;
      config.environments = {pointCloud("meshed" + which, boxPoints(spacing))};
      model::CloudOptions& cloud = config.environments[0].cloud;
      cloud.as = model::CloudOptions::As::MESH;
      cloud.mesher = mesher;
      cloud.max_edge = 3 * spacing;
      cloud.cell = spacing;
      cloud.viewpoint = Vector3(0, 0, -0.05);
      config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.003, 0.004, 0.06})};
      Simulator simulator(config, model::UriResolver());
      stepFor(&simulator, 0.5);
      const double above = bodyOf(simulator, "cube").X_WB.translation().z() - 0.05 - LAYER_OF_CUBE;
      std::printf("%s: %.3f of the spacing too high\n", which.c_str(), above / spacing);
      EXPECT_LT(std::abs(above), spacing / 3) << which;
      EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 1e-4) << which;
    }
}

}  // namespace
}  // namespace blem_sim::sim
