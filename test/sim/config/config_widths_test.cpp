// boundary_width: a length, or auto.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "blem_sim/sim/config.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

TEST(WidthConfig, IsALengthOrAuto) {
  const auto contact = [](const std::string& width) {
    return parseConfig(YAML::Load("contact: {boundary_width: " + width + "}"), "world.yaml", "").contact.boundary_width;
  };
  EXPECT_TRUE(contact("auto").automatic);
  EXPECT_EQ(contact("0.004").metres, 0.004);
  EXPECT_FALSE(contact("0.004").automatic);
  EXPECT_TRUE(isOneLineWith(refusal([&] { contact("automatic"); }), {"world.yaml", "contact.boundary_width", "at least 0, or auto"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { contact("-1"); }), {"contact.boundary_width", "or auto"}));
}

TEST(WidthConfig, TheInnermostCounts) {
  const SimulationConfig config = parseConfig(YAML::Load("contact: {boundary_width: auto}\n"
                                                         "environments: [{name: e, uri: e.ply, boundary_width: 0}]\n"
                                                         "robots: [{name: r, urdf: r.urdf, links: {hand: {boundary_width: auto}}}]\n"),
                                              "world.yaml", "");
  EXPECT_FALSE(config.environments[0].contact.boundary_width.value().automatic);
  EXPECT_FALSE(config.robots[0].contact.boundary_width.has_value());
  EXPECT_TRUE(config.robots[0].links.at("hand").boundary_width.value().automatic);
  EXPECT_TRUE(parseEnvironment(YAML::Load("{name: e, uri: a.ply, boundary_width: auto}"), "~load_environment")
                  .contact.boundary_width.value()
                  .automatic);
}

}  // namespace
}  // namespace blem_sim::sim
