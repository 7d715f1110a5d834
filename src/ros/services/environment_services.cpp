#include "services/environment_services.h"

#include <blem_sim/LoadEnvironment.h>
#include <blem_sim/UnloadEnvironment.h>
#include <yaml-cpp/yaml.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/config.h"
#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

YAML::Node settingsOf(const std::string& text) {
  YAML::Node settings;
  try {
    settings = sim::loadYaml(text);
  } catch (const YAML::Exception& error) {
    throw InputError(std::string("load_environment: settings: no YAML: ") + error.what());
  }
  if (settings.IsNull()) return YAML::Node(YAML::NodeType::Map);
  if (!settings.IsMap()) throw InputError("load_environment: settings: must be a map such as {friction: 0.7}");
  return settings;
}

sim::EnvironmentConfig fromRequest(const LoadEnvironment::Request& request) {
  YAML::Node row = settingsOf(request.settings);
  row["name"] = request.name;
  row["uri"] = request.uri;
  const geometry_msgs::Vector3& scale = request.scale;
  if (scale.x != 0 || scale.y != 0 || scale.z != 0) {
    row["scale"] = YAML::Node(YAML::NodeType::Sequence);
    for (const double factor : {scale.x, scale.y, scale.z}) row["scale"].push_back(factor);
  }
  if (request.friction != 0) row["friction"] = request.friction;
  if (request.boundary_width != 0) row["boundary_width"] = request.boundary_width;
  sim::EnvironmentConfig environment = sim::parseEnvironment(row, "load_environment");
  environment.X_WE = fromPose(request.pose, "load_environment: " + request.name);
  return environment;
}

}  // namespace

EnvironmentServices::EnvironmentServices(const ros::NodeHandle& private_node, SimulationLoop* loop) : services_(private_node) {
  services_.add<LoadEnvironment>("load_environment", [loop](const auto& request, auto* response) {
    loop->simulator().loadEnvironment(fromRequest(request));
    loop->modelsChanged();
    response->status_message = "loaded " + request.name;
  });
  services_.add<UnloadEnvironment>("unload_environment", [loop](const auto& request, auto* response) {
    loop->simulator().unloadEnvironment(request.name);
    loop->modelsChanged();
    response->status_message = "unloaded " + request.name;
  });
}

}  // namespace blem_sim::node
