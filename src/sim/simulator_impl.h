// Content of a Simulator. Its work is split by concept: simulator_step.cpp, simulator_report.cpp,
// simulator_commands.cpp, simulator_clouds.cpp, simulator_models.cpp, simulator_attachments.cpp, simulator_motion.cpp, simulator_state.cpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "build/simulated_world.h"
#include "build/world_builder.h"
#include "clouds/fading_points.h"
#include "clouds/inner_points.h"
#include "clouds/leaving_triangles.h"
#include "commands/applied_loads.h"
#include "commands/base_drives.h"
#include "contacts/constraints/constraint_maker.h"
#include "contacts/constraints/early_pushes.h"
#include "contacts/constraints/made_solve.h"
#include "contacts/search/pair_searches.h"
#include "guard/energy_balance.h"
#include "guard/layer_watch.h"
#include "guard/step_guard.h"
#include "guard/sweep_guard.h"
#include "guard/taut_links.h"
#include "inputs/input_writer.h"
#include "part_reports.h"
#include "sensors/sensor_set.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/** Step at which the time step was set, and its time [s]. */
struct Epoch {
  double time = 0;
  std::uint64_t step = 0;
};

/** A live environment. */
struct LiveGround {
  contact::SurfaceProperties surface;
  BoundaryWidth width;    ///< of triangles; chosen with the first ones if it is automatic
  double fade_speed = 0;  ///< [m/s]
  bool is_mesh = false;   ///< made of triangles
  int cloud = -1;         ///< collider of its points or triangles; -1: none have come
};

struct Simulator::Impl {
  Impl(const SimulationConfig& config, const model::UriResolver& resolver, LoadLog log, const Impl* loaded);

  // One step, stage by stage: simulator_step.cpp. Values that a stage gives are valid until it gives the next.
  const StepReport& step();
  void startStep();
  void planSubstep();
  void sampleCommands();
  const std::vector<dynamics::JointDrive>& motorTorque();
  const SolverContacts& reduction();
  /** Wrenches from outside in the solve to come. */
  const std::vector<BodyLoad>& loadsNow();
  /** Solves the substep. None if the state is not finite any more; the last finite one is then restored. */
  std::optional<MadeSolve> solve(const SolverContacts& contacts, const std::vector<dynamics::JointDrive>& drives);
  /** Pairs that may meet within this part (0 to 1) of a step. @param faster states that bodies may get to as well; null: none are known */
  WatchedPairs& broadPhase(const std::vector<dynamics::BodyState>* faster, double part);
  /** @param pairs swapped for those of a state before */
  const FoundContacts& narrowPhase(WatchedPairs* pairs);
  bool hasEarlyPushes(const MadeSolve& made, const FoundContacts& found);
  /** Makes the substep again, with the ways of early pushes' pairs as a solve without them shows them. */
  void repeatSubstep(const std::vector<dynamics::JointDrive>& drives);
  /** Accepts the solve, or has the substep made again, shorter. */
  void stepGuard(const MadeSolve& made, const FoundContacts& found);
  /** Whether a layer was used up, or links in tension swing too fast for it. @param close from the sweep guard */
  bool isTooLong(const MadeSolve& made, const FoundContacts& found, const std::vector<ClosePass>& close);
  void acceptSubstep(const MadeSolve& made);
  void redoSubstep(const std::vector<ClosePass>& close);
  /** Reads sensors whose time has come. */
  void sensors();
  /** Bodies go back to where the substep started. */
  void rewind();
  /** States that bodies may reach in the rest of the step, if a solve that was thrown away has shown them; else null. */
  const std::vector<dynamics::BodyState>* foreseen();
  const StepReport& stop();
  /** Contacts of the state at hand become those that the next solve starts from. */
  void findFirstContacts();
  /** Contacts at the end of the last solve become those that the next one starts from. */
  void startFromFound() { std::swap(at_hand_, found_); }
  void jointStates(std::vector<dynamics::JointState>* out) const;
  bool bodiesAreFinite() const;

  // simulator_report.cpp
  void recordContacts(const MadeSolve& made);
  /** @param found contacts where the part started, before reduction */
  void recordFound(const FoundContacts& found);
  /** A contact of the part at hand, with its moments: its links have moved on since the step began. */
  ContactReport withMoments(ContactReport contact) const;
  void recordSolve(const dynamics::SolveResult& solved);
  /** Says whether the step's contact forces miss Coulomb's law by too much. */
  void recordMisses();
  void recordEnergy(const MadeSolve& made);
  void recordMotors(const MadeSolve& made);
  void report();
  /** Report of the state at hand, nothing having happened. */
  void reportWithoutStep();

  // simulator_commands.cpp
  void commandTrajectory(int robot, const JointTrajectory& trajectory);
  void commandJoints(int robot, const JointCommandMessage& command);
  void driveJoints(int robot, const JointVelocityCommand& command);
  void driveBase(int robot, int link, const BaseVelocityCommand& command);
  void releaseBase(int robot);
  void checkBase(int robot) const;
  void checkJointCommand(int robot, const JointCommandMessage& command) const;
  JointSample desiredState(int world_joint, double time) const;
  /** A position as the joint takes it: a joint that turns without end takes the turn nearest to its present position. */
  double nearestTurn(int world_joint, double position) const;

  // simulator_state.cpp
  /** Content of the next save, without a header. */
  SimulationState content() const;
  /** Loads, a time step that was set, tares, steps in even parts, drives of bases. */
  void saveRarities(geometry::StateWriter* writer) const;
  SimulationState save() const;
  /** A state that is refused changes nothing. */
  void restore(const SimulationState& state);
  struct StateParts;
  StateParts partsOf(const SimulationState& state) const;
  /** Layout of the state, made on demand; models come and go seldom. */
  const std::string& layout() const;

  void loadEnvironment(const EnvironmentConfig& environment);
  void unloadEnvironment(const std::string& name);
  /** A model has come: no event tells of its slots' earlier colliders. */
  void forgetLayers(const std::string& model);

  // simulator_clouds.cpp
  void addLive(const EnvironmentConfig& environment);
  void updateCloud(const std::string& environment, CloudSurface* surface, std::vector<SearchedAhead>* ahead);
  CloudNeighbours cloudNeighbours(const std::string& environment) const;
  /** Takes the surface and its remains away. @param surface what was there, out */
  void clearCloud(int model, LiveGround* live, CloudSurface* surface);
  /** [m] Layer of a live surface; an automatic one is chosen with the first mesh, and stays. */
  double layerOf(const CloudSurface& surface, LiveGround* live) const;
  /** A contact by which something stands on a live environment. */
  struct StoodOn {
    const contact::Contact& contact;
    int live, other;  ///< colliders
    bool is_a;        ///< the environment is the contact's A
  };
  void forStoodOn(int model, const std::function<void(const StoodOn&)>& tell) const;
  /** Points, or triangles, that something stands on now, where they are sunk to. @param X_CW from the world to the frame wanted */
  SunkSurface pointsStoodOn(int model, const Pose& X_CW) const;
  SunkSurface trianglesStoodOn(int model, const Pose& X_CW) const;
  /** Adds what sinks away, or else rises. @return its collider, -1 if the surface is empty */
  int addFading(const LiveGround& live, SunkSurface surface, bool leaves);
  /**
   * Buried points, so far below their places that they just touch, sunk in thicker layers: as balls they rise to where they are. A body
   * stands on them until it is out of the new surface.
   */
  SunkSurface belowBuried(const LiveGround& live, const InnerPoints& inner) const;
  /** [m] Way up after which a body only touches what it is buried in. */
  double wayOut(const BuriedPoints& buried, const LiveGround& live) const;
  /**
   * [m] Sink of what a contact touches, infinite for what lies in each other and pushes otherwise than up. What lies around a buried body
   * must not hold it: that rises no sooner than the body. @param buried null: the other body is not
   */
  double sinkTouched(const LiveGround& live, const contact::ContactManifold& manifold, const contact::Contact& contact,
                     const BuriedPoints* buried) const;
  /** [m] Deepest contact with a model, by the other collider; those that touch no more are 0. */
  std::map<int, double> depthsOn(int model) const;
  /** Sinks what has become a border of triangles that leave, and would push more than the mesh did. @param depths before the exchange */
  void sinkBorders(int leaving, const std::map<int, double>& depths);
  /** [m] Way that a place on a collider's body makes while a live environment is exchanged some times, world. */
  Vector3 wayAhead(int collider, const Vector3& p_W) const;
  /** Finds contacts with a live environment's new surfaces, those that will be found from now on: what crosses them counts for nothing. */
  void searchBeside(int model);
  /** Unit vector against gravity; zero without gravity. */
  Vector3 wayUp() const;
  /** Sinks those vertices of a new cloud or mesh that are inside layers, so that they touch and no more. */
  void sinkIntoTouch(const LiveGround& live, const InnerPoints& inner);
  /** @param buried as sinkTouched takes it @param sunk gets those that the pair's contacts touch, some perhaps twice */
  void addSunk(const LiveGround& live, const contact::ContactManifold& manifold, const BuriedPoints* buried,
               std::vector<SunkPoint>* sunk) const;
  /** Nothing comes or goes any more: clouds are as they were last sent. */
  void endFading();

  // simulator_models.cpp
  void spawn(RobotConfig robot);
  void removeModel(const std::string& name);
  /** A model's colliders are elsewhere, or others: nothing is remembered of their contacts. */
  void forgetContacts(const std::vector<int>& colliders);
  /** The same, but what the solver knows of them. @return their ids there */
  std::vector<std::uint64_t> forgetPairs(const std::vector<int>& colliders);
  void setLinkInertial(int body, int link, const geometry::MassProperties& inertial);
  void setLinkGravity(int body, int link, bool acts);
  void setJointLimits(int robot, int joint, double lower, double upper);
  void setPhysics(const Vector3& gravity, double time_step, double real_time_factor);

  // simulator_attachments.cpp
  void attach(const std::string& object, const LinkPart& part, double max_force, double max_torque);
  void detach(const std::string& object);
  /** Detaches a model from whatever carries it, and all that it carries. */
  void detachAll(int model);
  void removeAttachment(std::size_t index);
  /** Finds anew which colliders never touch because they hang rigidly together. */
  void partWelded();
  /** The attachment by which a model is carried; null if none does. */
  const AttachedModel* carrierOf(int model) const;
  /** Puts all that a model carries, and what that carries, to where it belongs. */
  void carryAlong(int model);
  /** Notes the welds' wrenches of the step at hand, and breaks those that were overloaded. */
  void watchAttachments();

  // simulator_motion.cpp
  /** moveModel without its checks, and without what is attached. */
  void moveRigidly(int model, int body, const dynamics::BodyState& to);
  void moveModel(int body, const dynamics::BodyState& to);
  void setJointPositions(int robot, const std::vector<std::string>& joints, const std::vector<double>& positions);
  /** @throws InputError: no model, or one that is gone */
  void requireAlive(int model) const;
  void resetModel(int model);
  /** Bodies, joints, motors and loads of a model as they were at the start; joints within the limits that hold now. */
  void restart(const ModelInfo& model, int robot);
  /** Moves a robot's joints whose start positions are beyond their limits to these. */
  void moveIntoLimits(int robot);
  void resetWorld();
  int modelOfBody(int body) const;
  bool isOfRobot(int body) const { return world_.robotOf(modelOfBody(body)) >= 0; }
  geometry::MassProperties linkInertial(int body, int link) const;

  /** Tells the watcher, if there is one, of a call that was taken. */
  template <typename... Arguments>
  void tell(const char* call, const Arguments&... arguments) const {
    if (watcher_) watcher_->told(inputOf(call, arguments...));
  }

  double time() const { return epoch_.time + static_cast<double>(step_count_ - epoch_.step) * config_.time_step; }
  /** Simulated time at which the substep at hand starts. */
  double substepTime() const { return time() + substeps_.fractionDone() * config_.time_step; }
  double substepLength() const { return substeps_.fraction() * config_.time_step; }

  SimulatorWatcher* watcher_ = nullptr;
  SimulationConfig config_;
  SimulatedWorld world_;
  WorldBuilder builder_;
  StepThreads threads_;
  PairWatch pair_watch_;
  PairSearches pair_searches_;
  ConstraintMaker constraint_maker_;
  FoundContacts at_hand_;  ///< of the accepted state; its crossings are part of the saved state
  FadingPoints fading_;    ///< points that come and go: contacts that are found from now on are those of points as they are sunk
  EarlyPushes early_pushes_;
  SweepGuard sweep_guard_;
  TautLinks taut_links_;
  LayerWatch layer_watch_;
  EnergyBalance energy_balance_;
  std::map<std::string, LiveGround> live_;  ///< by environment
  SensorSet sensors_;
  AppliedLoads loads_;
  BaseDrives base_drives_;
  std::vector<BodyLoad> loads_now_;
  Epoch epoch_;
  ControllerMemories memories_;
  mutable std::string layout_;  ///< empty: not known

  std::uint64_t step_count_ = 0;
  int most_ticks_ = Substeps::MAX_SUBSTEPS;  ///< of the next step's substeps, as links in tension can take them
  bool stopped_ = false;                     ///< the state is not finite any more

  // The step at hand.
  Substeps substeps_;
  StepReport report_;
  std::vector<dynamics::JointDrive> drives_;
  WatchedPairs pairs_;
  FoundContacts found_;  ///< of the state that the last solve led to
  dynamics::WorldState substep_start_;
  std::vector<dynamics::BodyState> bodies_before_;  ///< at the start of the step
  std::vector<dynamics::BodyState> bodies_before_substep_, bodies_;
  std::vector<dynamics::BodyState>
      foreseen_;  ///< velocities of the last solve that was thrown away, with the poses of bodies_; none if empty
  std::vector<std::pair<int, int>> passed_;  ///< colliders, in the substep at hand
  std::vector<dynamics::JointState> joints_;
  PartReports part_reports_;
};

}  // namespace blem_sim::sim
