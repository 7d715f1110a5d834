#include "settings/reconfigure_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"

namespace blem_sim::node {

namespace {

using dynamic_reconfigure::Config;

const char* const GROUP = "Default";  // the one that dynamic_reconfigure's clients begin with
constexpr std::size_t LONGEST_NAME = 200;

void checkTypes(const Config& request) {
  if (!request.bools.empty() || !request.ints.empty() || !request.strs.empty())
    throw InputError("all settings are numbers; send them as doubles");
}

}  // namespace

ReconfigureServer::ReconfigureServer(ros::NodeHandle node)
    : descriptions_(node.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true)),
      updates_(node.advertise<Config>("parameter_updates", 1, true)),
      services_(node) {
  services_.add<dynamic_reconfigure::Reconfigure>("set_parameters", [this](const auto& request, auto* response) {
    try {
      serve(request.config);
    } catch (const InputError& error) {
      ROS_ERROR("set_parameters: %s", error.what());
    }
    response->config = values([](const Setting& setting) { return setting.get(); });
    updates_.publish(response->config);
  });
}

void ReconfigureServer::offer(std::vector<Setting> settings) {
  settings_ = std::move(settings);
  descriptions_.publish(describe());
  tellValues();
}

void ReconfigureServer::tellValues() {
  updates_.publish(values([](const Setting& setting) { return setting.get(); }));
}

const Setting& ReconfigureServer::settingOf(const std::string& name) const {
  const auto known = std::find_if(settings_.begin(), settings_.end(), [&](const Setting& setting) { return setting.name == name; });
  if (known == settings_.end())
    throw InputError(
        fmt::format("there is no setting '{}'; parameter_descriptions has their names", geometry::oneLine(name.substr(0, LONGEST_NAME))));
  return *known;
}

// Clients send all values though one was changed: those that hold already are no changes.
void ReconfigureServer::serve(const Config& request) {
  checkTypes(request);
  std::vector<std::pair<const Setting*, double>> changes;
  for (const dynamic_reconfigure::DoubleParameter& given : request.doubles) {
    const Setting& setting = settingOf(given.name);
    if (given.value == setting.get()) continue;
    if (!(given.value >= setting.least && given.value <= setting.most))
      throw InputError(fmt::format("{}: is {:g}; give it {:g} to {:g}", setting.name, given.value, setting.least, setting.most));
    changes.emplace_back(&setting, given.value);
  }
  for (const auto& [setting, value] : changes) setting->set(value);
}

Config ReconfigureServer::values(const std::function<double(const Setting&)>& value) const {
  Config config;
  for (const Setting& setting : settings_) {
    dynamic_reconfigure::DoubleParameter number;
    number.name = setting.name;
    number.value = value(setting);
    config.doubles.push_back(number);
  }
  dynamic_reconfigure::GroupState group;
  group.name = GROUP;
  group.state = true;
  config.groups.push_back(group);
  return config;
}

dynamic_reconfigure::ConfigDescription ReconfigureServer::describe() const {
  dynamic_reconfigure::Group group;
  group.name = GROUP;
  for (const Setting& setting : settings_) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = setting.name;
    parameter.type = "double";
    parameter.description = setting.description;
    group.parameters.push_back(parameter);
  }
  dynamic_reconfigure::ConfigDescription description;
  description.groups.push_back(group);
  description.min = values([](const Setting& setting) { return setting.least; });
  description.max = values([](const Setting& setting) { return setting.most; });
  description.dflt = values([](const Setting& setting) { return setting.get(); });
  return description;
}

}  // namespace blem_sim::node
