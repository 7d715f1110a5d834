// The simulation: models from a configuration, one step, commands between steps.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/dynamics/world.h"
#include "blem_sim/sim/simulator_input.h"
#include "blem_sim/sim/simulator_types.h"
#include "blem_sim/sim/step_report.h"
#include "blem_sim/sim/trajectory.h"

namespace blem_sim::sim {

/**
 * Owns the world and steps it. Single-threaded: call everything from one thread, between steps. The constructor and the load functions
 * throw InputError for bad input and leave the simulation as it was; step() never throws on physics trouble.
 */
class Simulator {
 public:
  /**
   * @param loaded another simulation, with the same resolver: surfaces and robots that it holds are shared instead of read again, unless
   * their files were written since. It may end at any time after the constructor, and the result does not depend on it.
   */
  Simulator(const SimulationConfig& config, const model::UriResolver& resolver, LoadLog log = {}, const Simulator* loaded = nullptr);
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  /** One time step, as in the table of docs/architecture.md. The report lives until the next step. */
  const StepReport& step();
  /** The state at hand without stepping: bodies and joints now, contacts of the last step. */
  const StepReport& report() const;

  double time() const;  ///< [s] simulated, steps * time_step while that stays: never goes back except by reset_simulation
  std::uint64_t steps() const;
  const SimulationConfig& config() const;
  const Vector3& gravity() const;

  const std::vector<ModelInfo>& models() const;
  const std::vector<RobotInfo>& robots() const;
  const std::vector<SensorInfo>& sensors() const;
  const std::vector<contact::Collider>& colliders() const;  ///< with pose on the body, geometry, width; markers draw them
  const std::vector<geometry::MeshReport>& loadReport() const;
  const std::vector<std::string>& notes() const;  ///< repairs and assumptions made while loading, in words
  std::string bodyName(int body) const;           ///< "model::link", "world" for WORLD_BODY
  const dynamics::World& world() const;

  int robotIndex(const std::string& name) const;  ///< -1 if there is none
  int modelIndex(const std::string& name) const;
  Pose linkPose(int robot, int link) const;  ///< X_WL now

  /** @throws InputError: unknown joint, NaN, wrong sizes; nothing is changed then */
  void commandTrajectory(int robot, const JointTrajectory& trajectory);
  void commandJoints(int robot, const JointCommandMessage& command);
  void driveJoints(int robot, const JointVelocityCommand& command);
  /**
   * Pushes a robot from outside so that a link over the ground, or the root link if a joint moves it, keeps a velocity in all steps to
   * come.
   * @throws InputError: a fixed base, a stepper that knows no such drive, numbers that are none or too large
   */
  void driveBase(int robot, int link, const BaseVelocityCommand& command);
  void releaseBase(int robot);
  /** Changes nothing. @throws InputError: a base that driveBase cannot push */
  void checkBase(int robot) const;
  const BaseVelocityCommand* baseCommand(int robot) const;  ///< with the bounds that hold; null: nothing drives the base
  /** Changes nothing. @throws InputError as commandJoints would */
  void checkJointCommand(int robot, const JointCommandMessage& command) const;
  JointSample desiredState(int robot, int joint) const;  ///< command of the motor now; joint = index into joint_names
  /** The same at another time [s], if nothing new is commanded. */
  JointSample desiredState(int robot, int joint, double time) const;
  /** Path that the joint's motor follows; null while it keeps a velocity, and for a joint without a motor. */
  const JointSpline* followedPath(int robot, int joint) const;
  /** Motors hold the joints where they are now, at rest. @param joints indices into joint_names */
  void holdJoints(int robot, const std::vector<int>& joints);
  /** The joint's motor holds a position [rad or m] from now on; a joint that turns without end takes the nearest turn. */
  void holdJoint(int robot, int joint, double position);

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

  /**
   * Makes a live environment that of these points or triangles, between steps. Those that appear inside a layer of something rise into it,
   * and those that something stood on sink away, both at the environment's fade_speed: nothing is thrown or let fall. Points inside a
   * closed mesh, and triangles with such corners, count for nothing until the next update. Corners of triangles that have come into a
   * body's lower side, by 2 cm at most, lift it out instead. Its slots are used again; contacts with it are new ones.
   * @param surface made for it; one of triangles without geometry takes all away at once. What was there before after the call, for the
   * caller to free where it takes no time from steps
   * @param ahead from searchAhead with this surface, or nothing
   * @throws InputError if there is no such live environment, or it is of the other kind; nothing is changed then
   */
  void updateCloud(const std::string& environment, CloudSurface* surface, std::vector<SearchedAhead> ahead = {});
  /** Colliders that a live environment may touch, for searchAhead; none if there is no such live environment. */
  CloudNeighbours cloudNeighbours(const std::string& environment) const;

  /**
   * Adds a robot between steps; one of a single free body becomes an object, and one whose root link is called world has a fixed base.
   * A joint without gains in the configuration is free. Indices of robots and sensors that come after it go up by its own.
   * @throws InputError, nothing being changed: the name is taken, or whatever the configuration would be refused for
   */
  void spawn(const RobotConfig& robot);
  /**
   * Takes a model out between steps, with its sensors and all memory of its contacts. Indices of robots and sensors behind it go down.
   * @throws InputError if there is no such model
   */
  void removeModel(const std::string& name);
  /** Lets all later loads read files below these folders alone. */
  void restrictFiles(const model::FileRoots& roots);

  /**
   * Welds a model that can move, as it stands now, to a part of another model. In the next step both come to move as one, momentum staying
   * as it is, as in an impact of things that stick. They do not touch each other while it lasts.
   * @param object name of the model
   * @param max_force [N], max_torque [N m] about the object's origin, means of a step: beyond them the weld breaks after the step
   * @throws InputError, nothing being changed: no such model, a fixed base, attached already, or the part hangs on the object itself
   */
  void attach(const std::string& object, const LinkPart& part, double max_force, double max_torque);
  /** @throws InputError: the model is not attached */
  void detach(const std::string& object);
  const std::vector<AttachedModel>& attachments() const;  ///< in the order they were made

  /** Moves a body, and its whole model with it as if it were rigid: joints keep their positions and stop. What is attached goes along.
   * @throws InputError: a fixed base, an attached model, numbers that are none or too large */
  void moveModel(int body, const dynamics::BodyState& to);
  /**
   * Sets joint positions [rad or m], moved into the limits, at rest; motors hold them. The root link and other joints go on as they are.
   * @param joints with or without the robot's name before :: @throws InputError, nothing being changed
   */
  void setJointPositions(int robot, const std::vector<std::string>& joints, const std::vector<double>& positions);
  /** A model back to its start pose, as resetWorld does. */
  void resetModel(int model);

  /** Lets a wrench act in all steps of a time. @throws InputError: numbers that are none or too large, too many loads */
  void applyLoad(const BodyLoad& load, const LoadTime& when);
  /** Lets an effort [N m or N] act beside the motor's. @param joint of the world @throws InputError */
  void applyEffort(int joint, double effort, const LoadTime& when);
  void clearLoads(int body);
  void clearEfforts(int joint);

  /** Lets a force-torque sensor take what it measures next for zero. @throws InputError: it is none */
  void tareSensor(int sensor);

  /** @param gravity [m/s^2], time_step [s]; all or nothing is taken. @throws InputError */
  void setPhysics(const Vector3& gravity, double time_step, double real_time_factor);
  /** Gives a robot's link, or an object's body, other mass properties in the link's frame. @throws InputError, nothing being changed */
  void setLinkInertial(int body, int link, const geometry::MassProperties& inertial);
  /** Lets gravity act on a robot's link, or an object's body, or act no more. @throws InputError: the robot has no such link */
  void setLinkGravity(int body, int link, bool acts);
  geometry::MassProperties linkInertial(int body, int link) const;  ///< @param link of the body's robot, -1: the body itself
  void setJointDamping(int robot, int joint, double damping);
  /** @throws InputError: limits that do not hold the joint's position, or of a joint that takes none */
  void setJointLimits(int robot, int joint, double lower, double upper);
  /** Gives the motor of a robot's joint other gains; its targets and its integral term stay. @param joint index into joint_names
   *  @throws InputError: numbers that are none or below 0, a joint that has no motor of its own */
  void setMotorGains(int robot, int joint, const JointGains& gains);
  JointGains motorGains(int robot, int joint) const;
  /** Gives all surfaces of a model this Coulomb coefficient. @throws InputError: it is no number, or below 0 */
  void setFriction(int model, double friction);
  double friction(int model) const;            ///< of its first surface, and of clouds to come; 0: it has none
  double jointDamping(int world_joint) const;  ///< [N m s/rad or N s/m]

  /** Models back to their start poses, at rest (objects at their configured velocity), commands and sensors cleared; time goes on. */
  void resetWorld();
  /** The same, and time and random generators start again. */
  void resetSimulation();

  /**
   * Lets a saved state have what a robot's controller keeps from step to step, until the robot is removed; hashes and records know nothing
   * of it, as no step depends on it. Empty: nothing is kept.
   */
  void remember(const std::string& robot, const std::string& controller, const std::vector<double>& memory);
  /** The memory that remember was told last, or that the restored state had; empty: nothing. */
  std::vector<double> memory(const std::string& robot, const std::string& controller) const;

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

  /** Tells the watcher of every step and of every call above that changes the simulation, file roots apart. @param watcher null: nobody */
  void watch(SimulatorWatcher* watcher);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blem_sim::sim
