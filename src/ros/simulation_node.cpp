#include "simulation_node.h"

#include <ros/console.h>

#include <algorithm>
#include <filesystem>

#include "attachments/attachment_publisher.h"
#include "attachments/attachment_services.h"
#include "blem_sim/sim/simulator.h"
#include "clouds/live_clouds.h"
#include "controllers/controller_sets.h"
#include "loop/checkpoint.h"
#include "loop/logger_services.h"
#include "loop/simulation_loop.h"
#include "parameters.h"
#include "publishers/clock_publisher.h"
#include "publishers/contact_publisher.h"
#include "publishers/markers/geometry_publishers.h"
#include "publishers/reports/diagnostics_publisher.h"
#include "publishers/reports/layer_event_publisher.h"
#include "publishers/reports/step_report_publisher.h"
#include "publishers/robot_publishers.h"
#include "publishers/sensor_publisher.h"
#include "publishers/state_publisher.h"
#include "robot_commands.h"
#include "saving/input_recorder.h"
#include "saving/record_services.h"
#include "saving/state_services.h"
#include "services/environment_services.h"
#include "services/force_services.h"
#include "services/learner_service.h"
#include "services/motion_services.h"
#include "services/physics_services.h"
#include "services/property_services.h"
#include "services/query_services.h"
#include "services/sensor_services.h"
#include "services/spawn_services.h"
#include "services/step_service.h"
#include "settings/live_settings.h"

namespace blem_sim::node {

namespace {

/** Log of long loads, in the node's log. */
sim::LoadLog consoleLog() {
  return {[](const std::string& line) { ROS_INFO("%s", line.c_str()); }};
}

ros::NodeHandle nodeOn(ros::CallbackQueue* callbacks, const std::string& name) {
  ros::NodeHandle node(name);
  node.setCallbackQueue(callbacks);
  return node;
}

}  // namespace

struct SimulationNode::Impl {
  // A queue of the node's own: callbacks are served between steps, in the thread that steps.
  ros::CallbackQueue callbacks;
  ros::NodeHandle node = nodeOn(&callbacks, "");
  ros::NodeHandle private_node = nodeOn(&callbacks, "~");
  const NodeParameters parameters = readParameters(private_node);
  sim::Simulator simulator{parameters.config, model::UriResolver(), consoleLog()};
  InputRecorder recorder{&simulator, parameters.yaml};
  SimulationLoop loop{&simulator};
  DiagnosticsPublisher* diagnostics = nullptr;
  std::unique_ptr<RobotCommands> commands;
  std::unique_ptr<PhysicsServices> physics;
  std::unique_ptr<StepService> step;
  std::unique_ptr<LearnerService> learner;
  std::unique_ptr<EnvironmentServices> environments;
  std::unique_ptr<QueryServices> queries;
  std::unique_ptr<MotionServices> motions;
  std::unique_ptr<ForceServices> forces;
  std::unique_ptr<AttachmentServices> attachments;
  std::unique_ptr<SpawnServices> spawns;
  std::unique_ptr<SensorServices> sensors;
  std::unique_ptr<PropertyServices> properties;
  std::unique_ptr<LiveSettings> settings;
  std::unique_ptr<StateServices> states;
  std::unique_ptr<RecordServices> records;
  ros::ServiceServer loggers = advertiseLoggers(private_node);

  void addPublishers() {
    // The clock goes last: a node that wakes by it finds the messages of that time on their way.
    loop.add(std::make_unique<JointStatePublisher>(node, simulator, loop.sender()));
    loop.add(std::make_unique<TransformPublisher>(node, &loop));
    loop.add(std::make_unique<OdometryPublisher>(node, simulator, loop.sender()));
    loop.add(std::make_unique<SensorPublisher>(node, simulator, loop.sender()));
    loop.add(std::make_unique<ContactPublisher>(private_node, simulator, loop.sender()));
    loop.add(std::make_unique<ContactMarkerPublisher>(private_node, simulator, loop.sender()));
    loop.add(std::make_unique<LayerEventPublisher>(private_node, simulator, loop.sender()));
    loop.add(std::make_unique<GeometryMarkerPublisher>(private_node, simulator));
    loop.add(std::make_unique<LoadReportPublisher>(private_node, simulator));
    loop.add(std::make_unique<AttachmentPublisher>(private_node, simulator, loop.sender()));
    loop.add(std::make_unique<StatePublisher>(private_node, simulator, loop.sender()));
    loop.add(std::make_unique<StepReportPublisher>(private_node, &loop));
    auto diagnostics_publisher = std::make_unique<DiagnosticsPublisher>(node, private_node, &loop);
    diagnostics = diagnostics_publisher.get();
    loop.add(std::move(diagnostics_publisher));
    diagnostics->add("refused messages", [this](auto& status) { loop.refusals()->describe(status); });
    addLiveClouds();
    loop.add(std::make_unique<ControllerSets>(node, &loop));
    loop.add(std::make_unique<ClockPublisher>(node, simulator.config().rates.clock, loop.sender()));
  }

  void addLiveClouds() {
    const auto& environments = simulator.config().environments;
    if (std::none_of(environments.begin(), environments.end(), [](const sim::EnvironmentConfig& e) { return !e.live.topic.empty(); }))
      return;
    auto live_clouds = std::make_unique<LiveClouds>(node, private_node, &loop);
    diagnostics->add("live clouds", [clouds = live_clouds.get()](auto& status) { clouds->describe(status); });
    loop.add(std::move(live_clouds));
  }

  // Last: controllers that start give commands, which the state goes over; it is kept as they leave it after a step.
  void addCheckpoint() {
    if (simulator.config().checkpoint_period > 0)
      loop.add(std::make_unique<Checkpoint>(&simulator, checkpointFile(simulator.config(), private_node)));
  }

  void addInputs() {
    commands = std::make_unique<RobotCommands>(node, &loop);
    physics = std::make_unique<PhysicsServices>(private_node, &loop);
    step = std::make_unique<StepService>(private_node, &loop);
    learner = std::make_unique<LearnerService>(private_node, &loop);
    sensors = std::make_unique<SensorServices>(node, &simulator);
    loop.onModelsChanged([this] {
      commands->modelsChanged();
      sensors->modelsChanged();
    });
    const model::FileRoots roots(serviceFolders(simulator.config()));
    simulator.restrictFiles(roots);
    environments = std::make_unique<EnvironmentServices>(private_node, &loop);
    queries = std::make_unique<QueryServices>(private_node, &loop);
    motions = std::make_unique<MotionServices>(private_node, &loop);
    forces = std::make_unique<ForceServices>(private_node, &simulator);
    attachments = std::make_unique<AttachmentServices>(private_node, &simulator);
    spawns = std::make_unique<SpawnServices>(private_node, &loop);
    properties = std::make_unique<PropertyServices>(private_node, &loop);
    settings = std::make_unique<LiveSettings>(private_node, &loop);
    const ServiceFiles files(roots, simulator.config().base_directory);
    states = std::make_unique<StateServices>(private_node, &loop, files);
    records = std::make_unique<RecordServices>(private_node, &recorder, files);
  }

  void startRecord() {
    const sim::SimulationConfig& config = simulator.config();
    if (!config.record_file.empty()) recorder.start((std::filesystem::path(config.base_directory) / config.record_file).string());
  }
};

SimulationNode::SimulationNode() : impl_(std::make_unique<Impl>()) {
  for (const std::string& note : impl_->simulator.notes()) ROS_WARN("%s", note.c_str());
  impl_->addPublishers();
  impl_->addInputs();
  impl_->addCheckpoint();
  impl_->startRecord();
}

SimulationNode::~SimulationNode() = default;

void SimulationNode::run() {
  const sim::Simulator& simulator = impl_->simulator;
  ROS_INFO("ready: %zu robots, %zu models, %zu colliders, time step %g s%s", simulator.robots().size(), simulator.models().size(),
           simulator.colliders().size(), simulator.config().time_step, impl_->loop.paused() ? ", paused" : "");
  impl_->loop.run(&impl_->callbacks, [this](bool paused) { impl_->diagnostics->serve(paused); });
  impl_->recorder.end();
}

}  // namespace blem_sim::node
