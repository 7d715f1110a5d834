#include "services/spawn_services.h"

#include <blem_sim/DeleteLight.h>
#include <blem_sim/GetLightProperties.h>
#include <blem_sim/SetLightProperties.h>

#include "blem_sim/geometry/input_error.h"
#include "messages/pid_gains.h"
#include "messages/ros_names.h"
#include "services/door/reference_frame.h"

namespace blem_sim::node {

namespace {

constexpr std::size_t LARGEST_URDF = 64u << 20;  // [bytes]

const char* const NO_LIGHTS = "nothing is rendered here, so there are no lights; take the call out";

/** Robot of a request: joints without a <transmission> or gains are free, as in Gazebo. */
sim::RobotConfig robotOf(const sim::Simulator& simulator, const SpawnModel::Request& request) {
  sim::RobotConfig robot;
  robot.name = request.model_name;
  robot.name_space = request.robot_namespace;
  robot.urdf_xml = request.model_xml;
  robot.motors = sim::MotorDefault::TRANSMISSIONS;
  robot.pid_gains = pidGainsIn(request.robot_namespace);
  robot.tf_prefix = tfPrefixIn(request.robot_namespace);
  const sim::LinkMotion frame = frameMotion(simulator, request.reference_frame, "reference_frame");
  robot.X_WR = inWorld(frame, request.initial_pose, {}, "initial_pose").X_WL;
  return robot;
}

void checkRequest(const SpawnModel::Request& request) {
  if (request.model_name.empty()) throw InputError("model_name: is empty; give the model a name");
  if (request.model_xml.empty()) throw InputError("model_xml: is empty; give the text of a URDF");
  if (request.model_xml.size() > LARGEST_URDF) throw InputError("model_xml: is larger than 64 MB; let meshes be files");
  if (!request.robot_namespace.empty() && !isRosName(request.robot_namespace))
    throw InputError("robot_namespace: '" + request.robot_namespace + "' is no ROS name; use letters, digits, _ and /");
}

/** Refuses a robot that would take another one's commands. */
void checkJoints(const sim::Simulator& simulator, const std::string& model) {
  const int index = simulator.robotIndex(model);
  if (index < 0) return;
  for (const sim::RobotInfo& other : simulator.robots()) {
    const std::string joint = other.name == model ? "" : sharedJoint(simulator.robots()[index], other);
    if (joint.empty()) continue;
    throw InputError("robot_namespace: '" + other.name + "' has a joint '" + joint + "' in this namespace too; give '" + model +
                     "' one of its own");
  }
}

}  // namespace

SpawnServices::SpawnServices(const ros::NodeHandle& private_node, SimulationLoop* loop) : loop_(loop), services_(private_node) {
  services_.add<SpawnModel>("spawn_urdf_model", [this](const auto& request, auto* response) { spawn(request, response); });
  services_.add<DeleteModel>("delete_model", [this](const auto& request, auto*) { remove(request.model_name); });
  addRefusals();
}

void SpawnServices::addRefusals() {
  services_.add<SpawnModel>("spawn_sdf_model", [](const auto&, auto*) {
    throw InputError("SDF is not read here; make URDF of the model by rosrun blem_sim world_from_sdf, and call spawn_urdf_model");
  });
  services_.add<GetLightProperties>("get_light_properties", [](const auto&, auto*) { throw InputError(NO_LIGHTS); });
  services_.add<SetLightProperties>("set_light_properties", [](const auto&, auto*) { throw InputError(NO_LIGHTS); });
  services_.add<DeleteLight>("delete_light", [](const auto&, auto*) { throw InputError(NO_LIGHTS); });
}

void SpawnServices::spawn(const SpawnModel::Request& request, SpawnModel::Response* response) {
  checkRequest(request);
  sim::Simulator& simulator = loop_->simulator();
  const std::size_t known_notes = simulator.notes().size();
  simulator.spawn(robotOf(simulator, request));
  try {
    checkJoints(simulator, request.model_name);
    loop_->modelsChanged();
  } catch (...) {
    remove(request.model_name);
    throw;
  }
  response->status_message = "spawned " + request.model_name;
  for (std::size_t note = known_notes; note < simulator.notes().size(); ++note) {
    ROS_WARN("%s", simulator.notes()[note].c_str());
    response->status_message += "; " + simulator.notes()[note];
  }
}

void SpawnServices::remove(const std::string& model) {
  loop_->simulator().removeModel(model);
  loop_->modelsChanged();
}

}  // namespace blem_sim::node
