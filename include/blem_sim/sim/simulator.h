// The simulation: models from a configuration, one step, commands between steps.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "blem_sim/sim/step_report.h"
#include "blem_sim/sim/trajectory.h"

namespace blem_sim {

enum class ModelKind { ENVIRONMENT, ROBOT, OBJECT };

/** A robot, object or environment in the simulation. */
struct ModelInfo {
  std::string name;
  ModelKind kind = ModelKind::OBJECT;
  std::vector<int> bodies;  ///< world bodies; [0] holds the root link
  std::vector<int> joints;  ///< world joints, movable ones, in the robot's order
  bool alive = true;        ///< false: unloaded, and its slot is free
};

/** A robot as publishers and commands see it. */
struct RobotInfo {
  int model = 0;
  std::string name, name_space;
  bool fixed_base = false;
  std::shared_ptr<const RobotModel> description;
  std::shared_ptr<const LumpedRobot> lumped;
  std::string root_link;
  Pose X_WR = Pose::Identity();          ///< root link at the start; a fixed base's for good
  std::vector<int> bodies;               ///< world body of lumped body i; WORLD_BODY for a fixed base
  std::vector<int> world_joints;         ///< world joint of lumped joint i, fixed ones kept for a sensor too; -1 for a floating one
  std::vector<std::string> joint_names;  ///< movable joints
  std::vector<int> joints;               ///< their world joints
  std::vector<JointLimits> limits;
};

struct SensorInfo {
  int robot = 0;
  SensorConfig config;
  std::string frame_id;  ///< link the reading is expressed in
};

/** Targets for joints by name; empty vectors = not commanded. Position and velocity go to the motor, effort adds to it. */
struct JointCommandMessage {
  std::vector<std::string> joints;
  std::vector<double> positions, velocities, efforts;
};

/** Log of long loads: their progress, and the size of the loaded model: names, stages, seconds, triangles, memory. */
struct LoadLog {
  std::function<void(const std::string& line)> tell;  ///< also called by a thread of its own, never by two at once; may be empty
  double interval = 1;                                ///< [s] between lines; shorter loads are not told
};

/** Header of a saved state; restore checks it against the content. */
struct StateHeader {
  std::uint64_t format = 0;    ///< a mark, and the version of the content
  std::uint64_t layout = 0;    ///< hash of SimulationState::layout
  std::uint64_t length = 0;    ///< of the content, in words of 64 bits
  std::uint64_t checksum = 0;  ///< of layout and content
};

/** Everything a simulation needs to replay bit for bit: world, motors, trajectories, sensors, random generators, contact memory. */
struct SimulationState {
  StateHeader header;
  std::uint64_t step = 0;
  WorldState world;
  std::vector<double> numbers;
  std::vector<std::uint64_t> words;
  std::string
      layout;  ///< things the state belongs to: settings, models, bodies, joints, colliders, sensors; each with a hash of its content
};

/**
 * Owns the world and steps it. Single-threaded: call everything from one thread, between steps. The constructor and the load functions
 * throw InputError for bad input and leave the simulation as it was; step() never throws on physics trouble.
 */
class Simulator {
 public:
  Simulator(const SimulationConfig& config, const UriResolver& resolver, LoadLog log = {});
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  /** One time step, as in the table of docs/architecture.md. The report lives until the next step. */
  const StepReport& step();
  /** The state at hand without stepping: bodies and joints now, contacts of the last step. */
  const StepReport& report() const;

  double time() const;  ///< [s] simulated, steps * time_step: never goes back except by reset_simulation
  std::uint64_t steps() const;
  const SimulationConfig& config() const;
  const Vector3& gravity() const;

  const std::vector<ModelInfo>& models() const;
  const std::vector<RobotInfo>& robots() const;
  const std::vector<SensorInfo>& sensors() const;
  const std::vector<Collider>& colliders() const;  ///< with pose on the body, geometry, width; markers draw them
  const std::vector<MeshReport>& loadReport() const;
  const std::vector<std::string>& notes() const;  ///< repairs and assumptions made while loading, in words
  std::string bodyName(int body) const;           ///< "model::link", "world" for WORLD_BODY
  const World& world() const;

  int robotIndex(const std::string& name) const;  ///< -1 if there is none
  int modelIndex(const std::string& name) const;
  Pose linkPose(int robot, int link) const;  ///< X_WL now

  /** @throws InputError: unknown joint, NaN, wrong sizes; nothing is changed then */
  void commandTrajectory(int robot, const JointTrajectory& trajectory);
  void commandJoints(int robot, const JointCommandMessage& command);
  JointSample desiredState(int robot, int joint) const;  ///< command of the motor now; joint = index into joint_names

  /** Adds static geometry between steps, in the lowest slots that are free. @throws InputError if it cannot be loaded or the name is taken
   */
  void loadEnvironment(const EnvironmentConfig& environment);
  /**
   * Takes an environment out with all memory of its contacts, so report() holds none until the next step, which tells that pairs outside
   * their layers are gone. Its slots (indices of model and collider) are free; if an environment takes them before that step, those pairs
   * are not told.
   * @throws InputError if there is no such environment
   */
  void unloadEnvironment(const std::string& name);

  /** Models back to their start poses, at rest (objects at their configured velocity), commands and sensors cleared; time goes on. */
  void resetWorld();
  /** The same, and time and random generators start again. */
  void resetSimulation();

  SimulationState save() const;
  /**
   * Goes on from a saved state with the same bits.
   * @throws InputError in one line, nothing being changed: the state is another version's, was changed or cut short after it was saved,
   * belongs to other models or settings (it says which body's mass, joint's gains, collider's mesh), or has content that no simulation
   * saves
   */
  void restore(const SimulationState& state);
  /** 64-bit hash of all state that steps depend on. */
  std::uint64_t stateHash() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blem_sim
