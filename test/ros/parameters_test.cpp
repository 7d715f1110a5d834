#include "messages/parameter_yaml.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <limits>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {
namespace {

TEST(Parameters, ScalarsKeepTheirValues) {
  EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue(true)).as<bool>(), true);
  EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue(-7)).as<int>(), -7);
  EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue("a b")).as<std::string>(), "a b");
  EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue("")).as<std::string>(), "");
  for (const double value : {0.1, 1.0 / 3.0, 1e-9, 2.5e17, -0.001}) EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue(value)).as<double>(), value);
}

TEST(Parameters, InfinityAndNanSurvive) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue(infinity)).as<double>(), infinity);
  EXPECT_EQ(toYaml(XmlRpc::XmlRpcValue(-infinity)).as<double>(), -infinity);
  EXPECT_TRUE(std::isnan(toYaml(XmlRpc::XmlRpcValue(std::nan(""))).as<double>()));
}

TEST(Parameters, ListsAndMapsNest) {
  XmlRpc::XmlRpcValue value;
  value["objects"].setSize(2);
  value["objects"][0]["mass"] = 1.5;
  value["objects"][1]["name"] = "mug";
  value["robots"].setSize(0);
  const YAML::Node node = toYaml(value);
  EXPECT_EQ(node["objects"].size(), 2U);
  EXPECT_EQ(node["objects"][0]["mass"].as<double>(), 1.5);
  EXPECT_EQ(node["objects"][1]["name"].as<std::string>(), "mug");
  EXPECT_TRUE(node["robots"].IsSequence());
  EXPECT_EQ(node["robots"].size(), 0U);
}

TEST(Parameters, BinaryDataIsRefused) {
  char data[] = "abc";
  EXPECT_THROW(toYaml(XmlRpc::XmlRpcValue(data, 3)), InputError);
}

}  // namespace
}  // namespace blem_sim::node
