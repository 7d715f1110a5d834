#include "services/environment_services.h"

#include <ros/console.h>
#include <yaml-cpp/yaml.h>

#include "blem_sim/geometry/input_error.h"
#include "messages/conversions.h"

namespace blem_sim {

namespace {

/** Runs an action that may refuse its input and puts the outcome in the response. */
template <typename Response, typename Act>
void answer(const char* service, Response* response, const Act& act) {
  try {
    act();
    response->success = true;
  } catch (const std::exception& error) {
    response->success = false;
    response->status_message = error.what();
    ROS_ERROR("%s: %s", service, error.what());
  }
}

YAML::Node settingsOf(const std::string& text) {
  YAML::Node settings;
  try {
    settings = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(std::string("load_environment: settings: no YAML: ") + error.what());
  }
  if (settings.IsNull()) return YAML::Node(YAML::NodeType::Map);
  if (!settings.IsMap()) throw InputError("load_environment: settings: must be a map such as {friction: 0.7}");
  return settings;
}

EnvironmentConfig fromRequest(const LoadEnvironment::Request& request) {
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
  EnvironmentConfig environment = parseEnvironment(row, "load_environment");
  environment.X_WE = fromPose(request.pose, "load_environment: " + request.name);
  return environment;
}

}  // namespace

EnvironmentServices::EnvironmentServices(ros::NodeHandle private_node, SimulationLoop* loop)
    : loop_(loop),
      load_(private_node.advertiseService("load_environment", &EnvironmentServices::onLoad, this)),
      unload_(private_node.advertiseService("unload_environment", &EnvironmentServices::onUnload, this)) {}

bool EnvironmentServices::onLoad(LoadEnvironment::Request& request, LoadEnvironment::Response& response) {
  answer("load_environment", &response, [&] {
    loop_->simulator().loadEnvironment(fromRequest(request));
    loop_->geometryChanged();
    response.status_message = "loaded " + request.name;
  });
  return true;
}

bool EnvironmentServices::onUnload(UnloadEnvironment::Request& request, UnloadEnvironment::Response& response) {
  answer("unload_environment", &response, [&] {
    loop_->simulator().unloadEnvironment(request.name);
    loop_->geometryChanged();
    response.status_message = "unloaded " + request.name;
  });
  return true;
}

}  // namespace blem_sim
