#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "blem_sim/geometry/input_error.h"
#include "config/config_sections.h"
#include "config/scene_limits.h"
#include "config/yaml_size.h"
#include "config/yaml_text.h"

namespace blem_sim::sim {

namespace {

PublishRates readRates(YamlReader& reader) {
  PublishRates rates;
  reader.readRate("clock_rate", &rates.clock);
  reader.readRate("joint_state_rate", &rates.joint_state);
  reader.readRate("tf_rate", &rates.tf);
  reader.readRate("odom_rate", &rates.odom);
  reader.readRate("contact_rate", &rates.contact);
  reader.readRate("marker_rate", &rates.markers);
  reader.readRate("link_states_rate", &rates.link_states);
  reader.readRate("step_report_rate", &rates.step_report);
  return rates;
}

std::vector<std::string> readFolders(YamlReader& reader, const std::string& key) {
  std::vector<std::string> folders;
  const YAML::Node list = reader.node(key);
  if (!list.IsDefined() || list.IsNull()) return folders;
  if (!list.IsSequence()) reader.refuse(key, "must be a list of folders");
  for (const YAML::Node& folder : list) {
    if (!folder.IsScalar()) reader.refuse(key, "must be a list of folders");
    folders.push_back(folder.Scalar());
  }
  return folders;
}

/** Reads a list of models, whose names must differ from all others'. */
template <typename Model, typename Read>
std::vector<Model> readModels(YamlReader& root, const std::string& key, std::set<std::string>* names, Read read) {
  std::vector<Model> models;
  // Checked before any model is read.
  const YAML::Node list = root.node(key);
  if (list.IsDefined() && list.size() > MOST_MODELS)
    root.refuse(key, fmt::format("{} entries are more than the {} that are simulated; give fewer", list.size(), MOST_MODELS));
  root.forEachItem(key, [&](YamlReader& reader) {
    Model model = read(reader);
    if (!names->insert(model.name).second)
      reader.refuse("name", fmt::format("'{}' is taken; robots, objects and environments need names of their own", model.name));
    models.push_back(std::move(model));
  });
  return models;
}

}  // namespace

SimulationConfig parseConfig(const YAML::Node& root, const std::string& source, const std::string& base_directory,
                             std::set<std::string>* known_keys) {
  YamlReader reader(root, source, known_keys);
  SimulationConfig config;
  config.base_directory = base_directory;
  reader.read("time_step", &config.time_step, NumberRange::positive());
  reader.read("real_time_factor", &config.real_time_factor, NumberRange::notNegative());
  reader.read("busy_wait", &config.busy_wait);
  reader.read("paused", &config.paused);
  reader.read("gravity", &config.gravity);
  reader.read("random_seed", &config.random_seed);
  reader.read("allow_file_services", &config.allow_file_services);
  reader.read("checkpoint_period", &config.checkpoint_period, NumberRange::notNegative());
  reader.read("checkpoint_file", &config.checkpoint_file);
  reader.read("record", &config.record_file);
  config.file_roots = readFolders(reader, "file_roots");
  config.solver = readSolver(reader.section("solver"));
  config.contact = readContact(reader.section("contact"));
  config.rates = readRates(reader);
  reader.read("layer_markers", &config.layer_markers);
  std::set<std::string> names;
  config.environments = readModels<EnvironmentConfig>(reader, "environments", &names, readEnvironment);
  config.robots = readModels<RobotConfig>(reader, "robots", &names, readRobot);
  config.objects = readModels<ObjectConfig>(reader, "objects", &names, readObject);
  reader.finish();
  return config;
}

SimulationConfig parseConfig(const YAML::Node& root, const std::string& source, const std::string& base_directory) {
  return parseConfig(root, source, base_directory, nullptr);
}

SimulationConfig loadConfigFile(const std::string& file) {
  return parseConfig(loadYamlFile(file), file, std::filesystem::absolute(file).parent_path().string());
}

YAML::Node loadYaml(const std::string& text) { return YAML::Load(endingYaml(text)); }

YAML::Node loadYamlFile(const std::string& file) {
  if (std::filesystem::is_directory(file)) throw InputError(fmt::format("{}: is a folder; give a YAML file in it", file));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read; check the path", file));
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  try {
    const std::string text = endingYaml(bytes.str());
    checkYamlSize(text, file);
    return YAML::Load(text);
  } catch (const YAML::ParserException& error) {
    throw InputError(fmt::format("{}:{}: is not YAML: {}", file, error.mark.line + 1, error.msg));
  }
}

EnvironmentConfig parseEnvironment(const YAML::Node& node, const std::string& source) {
  YamlReader reader(node, source);
  EnvironmentConfig environment = readEnvironment(reader);
  reader.finish();
  return environment;
}

}  // namespace blem_sim::sim
