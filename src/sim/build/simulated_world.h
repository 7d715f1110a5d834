// All parts of a simulation once it is built: the world, its models, and their colliders.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/dynamics/world.h"
#include "blem_sim/reduction/reduction.h"
#include "blem_sim/sim/simulator_types.h"
#include "commands/joint_motor.h"

namespace blem_sim::sim {

struct SimulatedWorld {
  SimulatedWorld(const Vector3& gravity, const dynamics::SolverSettings& solver) : world(gravity, solver) {}

  dynamics::World world;
  std::vector<ModelInfo> models;
  std::vector<RobotInfo> robots;  ///< in the order of their models
  std::vector<SensorInfo> sensors;
  std::vector<JointMotor> motors;                 ///< one per joint slot of the world
  std::vector<dynamics::BodyState> start_states;  ///< one per body slot: where a reset puts the body
  std::vector<double> start_positions;            ///< [rad or m] one per joint slot
  std::vector<contact::Collider> colliders;
  std::vector<reduction::ContactBudget> budgets;  ///< one per model
  contact::CollisionFilter filter;
  std::set<std::pair<int, int>> disabled_pairs;  ///< (smaller, larger) index of colliders that never touch
  std::vector<AttachedModel> attachments;        ///< in the order they were made
  std::vector<geometry::MeshReport> load_report;
  std::vector<std::string> notes;

  /** @throws InputError if the name is empty or taken. @param section of the configuration, for the message */
  void checkNewName(const std::string& name, const std::string& section) const;
  /** Adds a model in the lowest free slot. @param max_contacts its k @return its index */
  int addModel(const std::string& name, ModelKind kind, int max_contacts);
  /** Adds a collider and its line in the load report. @param width [m] of the layer @return its index */
  int addCollider(contact::Collider collider, double width, const contact::SurfaceProperties& surface, geometry::MeshReport report);
  /** Adds a body that stands or moves so at the start. @return its index */
  int addBody(const dynamics::BodySpec& spec, const Vector3& v_WCom = Vector3::Zero(), const Vector3& w_WB = Vector3::Zero());
  /** Adds a joint at its start position [rad or m] with its motor. @return its index */
  int addJoint(const dynamics::JointSpec& spec, double position, const JointMotor& motor);
  void removeJoint(int joint);
  /** Adds a robot, whose model has its slot, in the order of models. @return its index */
  int addRobot(const RobotInfo& robot);
  /** Removes a model, whose slots are free then; robots and sensors behind it move up. Precondition: it exists. @return slots of its
   *  colliders */
  std::vector<int> removeModel(const std::string& name);

  /** Takes a model's colliders out, with their lines of the load report; the model stays. @return their slots, free now */
  std::vector<int> removeShapes(int model);

  /** Takes a collider of a model out, with its line. */
  void removeShape(int collider);

  int modelIndex(const std::string& name) const;  ///< among the living; -1 if there is none
  int robotOf(int model) const;                   ///< -1: it is no robot
  std::vector<int> collidersOf(int model) const;
  /** Pose of a link in the world now. */
  Pose linkPose(const RobotInfo& robot, int link) const;
  /** Pose of a link in the world when the bodies have these states. */
  Pose linkPose(const RobotInfo& robot, int link, const std::vector<dynamics::BodyState>& bodies) const;
  /** [m] Origin, in the world, of the link that a collider is on when the bodies have these states; of the body where it is on no link. */
  Vector3 linkOrigin(const contact::Collider& collider, const std::vector<dynamics::BodyState>& bodies) const;
  /** [m/s^2] Gravity that layers and gains are chosen for: that at hand, the earth's at least, which may be switched on later. */
  double gravityToHold() const;
  /** State of every body slot. */
  void bodyStates(std::vector<dynamics::BodyState>* out) const;

 private:
  void removeColliders(const std::vector<int>& removed);
  void removeBodies(const ModelInfo& model);
  void removeRobot(int robot);
  void removeReports(const std::string& name);

  std::map<std::string, int> model_named_;  ///< the living
  std::set<int> free_models_, free_colliders_;
};

/** Names of the models that are alive. */
std::vector<std::string> modelNames(const std::vector<ModelInfo>& models);

}  // namespace blem_sim::sim
