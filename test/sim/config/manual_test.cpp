// config/default.yaml, the manual of the keys, holds what holds without it, and every key.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <limits>
#include <set>
#include <string>

#include "config/config_sections.h"

namespace blem_sim::sim {
namespace {

/** The manual, with or without its commented examples. */
YAML::Node manual(bool with_examples) {
  std::ifstream stream(std::string(BLEM_SIM_SOURCE_DIR) + "/config/default.yaml");
  std::string text;
  for (std::string line; std::getline(stream, line); text += line + "\n")
    if (with_examples && line.compare(0, 3, "#: ") == 0) line = line.substr(3);
  return YAML::Load(text);
}

/** Keys that a document holds, as "robots[].gains.default.p". */
void collectKeys(const YAML::Node& node, const std::string& path, std::set<std::string>* keys) {
  if (node.IsSequence())
    for (const auto& item : node) collectKeys(item, path + "[]", keys);
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    const std::string key = (path.empty() ? "" : path + ".") + entry.first.Scalar();
    keys->insert(key);
    collectKeys(entry.second, key, keys);
  }
}

/** "a.*.p" stands for any name in the middle. */
bool holdsKey(const std::set<std::string>& keys, const std::string& pattern) {
  const std::size_t star = pattern.find(".*.");
  if (star == std::string::npos) return keys.count(pattern) > 0;
  const std::string head = pattern.substr(0, star + 1), tail = pattern.substr(star + 2);
  for (const std::string& key : keys) {
    if (key.compare(0, head.size(), head) != 0 || key.size() < head.size() + tail.size()) continue;
    if (key.compare(key.size() - tail.size(), tail.size(), tail) != 0) continue;
    const std::string name = key.substr(head.size(), key.size() - head.size() - tail.size());
    if (name.find('.') == std::string::npos) return true;
  }
  return false;
}

TEST(Manual, SaysWhatHoldsWithoutIt) {
  const SimulationConfig manual_config = parseConfig(manual(false), "default.yaml", "");
  const SimulationConfig defaults = parseConfig(YAML::Node(), "world.yaml", "");
  EXPECT_EQ(manual_config.time_step, defaults.time_step);
  EXPECT_EQ(manual_config.real_time_factor, defaults.real_time_factor);
  EXPECT_EQ(manual_config.paused, defaults.paused);
  EXPECT_EQ(manual_config.gravity, defaults.gravity);
  EXPECT_EQ(manual_config.random_seed, defaults.random_seed);
  EXPECT_EQ(manual_config.solver.stepper, defaults.solver.stepper);
  EXPECT_EQ(manual_config.solver.threads, defaults.solver.threads);
  EXPECT_EQ(manual_config.solver.quick_step_iterations, defaults.solver.quick_step_iterations);
  EXPECT_EQ(manual_config.solver.cfm, defaults.solver.cfm);
  EXPECT_EQ(manual_config.solver.correction_fraction, defaults.solver.correction_fraction);
  EXPECT_EQ(manual_config.solver.max_correction_speed, defaults.solver.max_correction_speed);
  EXPECT_EQ(manual_config.solver.joint_erp, defaults.solver.joint_erp);
  EXPECT_EQ(manual_config.solver.joint_cfm, defaults.solver.joint_cfm);
  EXPECT_EQ(manual_config.contact.boundary_width.metres, defaults.contact.boundary_width.metres);
  EXPECT_EQ(manual_config.contact.surface.friction, defaults.contact.surface.friction);
  EXPECT_EQ(manual_config.contact.surface.restitution, defaults.contact.surface.restitution);
  EXPECT_EQ(manual_config.contact.surface.impact_friction_factor, defaults.contact.surface.impact_friction_factor);
  EXPECT_EQ(manual_config.contact.surface.impact_friction_speed, defaults.contact.surface.impact_friction_speed);
  EXPECT_EQ(manual_config.contact.surface.stiffness, std::numeric_limits<double>::infinity());
  EXPECT_EQ(manual_config.contact.surface.damping, std::numeric_limits<double>::infinity());
  EXPECT_EQ(manual_config.contact.friction_rule, defaults.contact.friction_rule);
  EXPECT_EQ(manual_config.contact.max_contacts_per_robot, defaults.contact.max_contacts_per_robot);
  EXPECT_EQ(manual_config.contact.max_contacts_per_object, defaults.contact.max_contacts_per_object);
  EXPECT_EQ(manual_config.contact.reduction, defaults.contact.reduction);
  EXPECT_EQ(manual_config.contact.mending, defaults.contact.mending);
  EXPECT_EQ(manual_config.contact.shrink, defaults.contact.shrink);
  EXPECT_EQ(manual_config.rates.clock, defaults.rates.clock);
  EXPECT_EQ(manual_config.rates.joint_state, defaults.rates.joint_state);
  EXPECT_EQ(manual_config.rates.tf, defaults.rates.tf);
  EXPECT_EQ(manual_config.rates.odom, defaults.rates.odom);
  EXPECT_EQ(manual_config.rates.contact, defaults.rates.contact);
  EXPECT_EQ(manual_config.rates.markers, defaults.rates.markers);
  EXPECT_EQ(manual_config.rates.link_states, defaults.rates.link_states);
  EXPECT_EQ(manual_config.rates.step_report, defaults.rates.step_report);
  EXPECT_TRUE(manual_config.robots.empty() && manual_config.environments.empty() && manual_config.objects.empty());
}

TEST(Manual, HoldsEveryKnownKey) {
  const YAML::Node document = manual(true);
  std::set<std::string> known, written;
  const SimulationConfig config = parseConfig(document, "default.yaml", "", &known);
  EXPECT_EQ(config.robots.size(), 2u);
  EXPECT_EQ(config.robots[0].sensors.size(), 10u);
  ASSERT_TRUE(config.robots[0].controllers);
  EXPECT_EQ(config.robots[0].controllers->size(), 6u);
  EXPECT_FALSE(config.robots[1].controllers);
  EXPECT_EQ(config.objects.size(), 2u);
  ASSERT_EQ(config.environments.size(), 6u);
  EXPECT_EQ(config.environments[4].live.type, LiveConfig::Type::GRID);
  EXPECT_EQ(config.environments[4].live.wall_height, 1);
  collectKeys(document, "", &written);
  EXPECT_GT(known.size(), 90u);
  for (const std::string& key : known) EXPECT_TRUE(holdsKey(written, key)) << key << " is not in config/default.yaml";
}

}  // namespace
}  // namespace blem_sim::sim
