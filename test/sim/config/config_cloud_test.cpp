// cloud: settings of points that become meshes.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>

#include "blem_sim/sim/config.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

TEST(CloudConfig, HasMeshers) {
  const auto cloud = [](const std::string& settings) {
    const YAML::Node document = YAML::Load("environments: [{name: scan, uri: scan.pcd, cloud: {" + settings + "}}]");
    return parseConfig(document, "world.yaml", "").environments[0].cloud;
  };
  const model::CloudOptions poisson = cloud("as: mesh, mesher: poisson, cell: 0.02, fill_holes: true, viewpoint: [1, 2, 3]");
  EXPECT_EQ(poisson.mesher, model::CloudOptions::Mesher::POISSON);
  EXPECT_EQ(poisson.cell, 0.02);
  EXPECT_TRUE(poisson.fill_holes);
  EXPECT_EQ(*poisson.viewpoint, Vector3(1, 2, 3));
  const model::CloudOptions grid =
      cloud("as: mesh, mesher: organized, max_depth_jump: .inf, filters: [{moving_least_squares: {radius: 0.05, order: 3}}]");
  EXPECT_TRUE(std::isinf(grid.max_depth_jump));
  EXPECT_FALSE(grid.viewpoint);
  EXPECT_EQ(grid.filters[0].kind, model::CloudFilter::Kind::MOVING_LEAST_SQUARES);
  EXPECT_EQ(grid.filters[0].size, 0.05);
  EXPECT_EQ(grid.filters[0].order, 3);
  EXPECT_TRUE(isOneLineWith(refusal([&] { cloud("mesher: poisson"); }), {"mesher", "as: mesh"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { cloud("as: mesh, mesher: marching_squares"); }), {"mesher", "marching_cubes"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { cloud("as: mesh, cell: 0"); }), {"cell"}));
}

}  // namespace
}  // namespace blem_sim::sim
