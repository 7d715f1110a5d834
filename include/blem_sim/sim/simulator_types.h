// Models, commands and saved states as plain data: what a simulation is asked with and answers with.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

enum class ModelKind { ENVIRONMENT, ROBOT, OBJECT };

/** Something that gravity does not act on. */
struct WeightlessPart {
  int body = 0;
  int link = -1;  ///< of the robot's description; -1: the whole body

  friend bool operator<(const WeightlessPart& a, const WeightlessPart& b) { return std::tie(a.body, a.link) < std::tie(b.body, b.link); }
};

/** A file whose faces are a surface that is simulated: scaled as told, otherwise where they are but for repairs too small to see. */
struct SurfaceFile {
  std::string path, uri;  ///< the file, and its name for other programs: package:// as configured, else file://
  Vector3 scale = Vector3::Ones();
};

/** A robot, object or environment in the simulation. */
struct ModelInfo {
  std::string name;
  ModelKind kind = ModelKind::OBJECT;
  std::vector<int> bodies;       ///< world bodies; [0] holds the root link
  std::vector<int> joints;       ///< world joints, movable ones, in the robot's order
  Pose X_WM = Pose::Identity();  ///< root link, object's frame or environment at the start
  std::set<WeightlessPart> weightless;
  std::optional<SurfaceFile> file;  ///< of an environment, if it shows what is simulated
  bool alive = true;                ///< false: unloaded, and its slot is free
};

/** A robot as publishers and commands see it. */
struct RobotInfo {
  int model = 0;
  std::string name, name_space;
  bool fixed_base = false;
  std::shared_ptr<const model::RobotModel> description;
  std::shared_ptr<const model::LumpedRobot> lumped;
  std::string root_link;
  Pose X_WR = Pose::Identity();          ///< root link at the start; a fixed base's for good
  std::vector<int> bodies;               ///< world body of lumped body i; WORLD_BODY for a fixed base
  std::vector<int> world_joints;         ///< world joint of lumped joint i, fixed ones kept for a sensor too; -1 for a floating one
  std::vector<std::string> joint_names;  ///< movable joints
  std::vector<int> joints;               ///< their world joints
  std::vector<model::JointLimits> limits;
  std::vector<bool> continuous;  ///< turns without end
  std::vector<bool> driven;      ///< has a motor of its own: no mimic
  std::string tf_prefix;         ///< of its frames, without slashes at its ends; no other robot has it that has links of the same name
  bool publish_tf = true;
  OdometryConfig odom;
  std::vector<ControllerConfig> drives;  ///< of its URDF
};

struct SensorInfo {
  int robot = 0;
  SensorConfig config;   ///< of a force_torque, link and X_LS say where its axes and their origin are
  std::string frame_id;  ///< link the reading's axes are fixed in
};

/**
 * Targets for joints by name; empty vectors = not commanded. Modes: positions (held, with velocities as their rate), velocities alone,
 * efforts alone; efforts beside the others add to the motor's.
 */
struct JointCommandMessage {
  std::vector<std::string> joints;
  std::vector<double> positions, velocities, efforts;
};

/** Velocities that motors keep as exactly as their efforts allow, whatever their gains are. */
struct JointVelocityCommand {
  std::vector<std::string> joints;
  std::vector<double> velocities;  ///< [rad/s or m/s] one per joint
  double acceleration = 0;         ///< [rad/s^2 or m/s^2] on the way, from the velocity commanded before; 0: at once
  double max_effort = 0;           ///< [N m or N] beside the motors' limits; 0: these alone
};

/** Velocity over the ground that a free base keeps, pushed from outside. */
struct BaseVelocityCommand {
  double x = 0, y = 0;    ///< [m/s] ahead and to the left, of a link's frame
  double turn = 0;        ///< [rad/s] to the left
  double max_force = 0;   ///< [N] along each of the world's x and y; 0: twice the robot's weight
  double max_torque = 0;  ///< [N m]; 0: max_force at twice the radius of gyration
};

/** A link, or what stands for one: an object's body, an environment as a whole. */
struct LinkPart {
  std::string name;  ///< "model::link"
  int model = -1, robot = -1;
  int link = -1;                    ///< of the robot's description
  int body = dynamics::WORLD_BODY;  ///< that it is part of
  Pose X_BL = Pose::Identity();     ///< in the body's frame; in the world's if it is part of that
};

/** A model welded to a part of another one, or of the world, until it is detached or the weld breaks. */
struct AttachedModel {
  std::string object;  ///< name of the model that is carried
  int model = -1;
  int body = -1;                                                ///< its root's
  LinkPart part;                                                ///< that carries it
  int joint = -1;                                               ///< of the world
  double max_force = std::numeric_limits<double>::infinity();   ///< [N] mean of a step beyond which the weld breaks
  double max_torque = std::numeric_limits<double>::infinity();  ///< [N m] the same, about the origin of the body
  Wrench wrench;                                 ///< from the part on the body, about its origin, world axes; mean of the last step
  std::vector<std::pair<int, int>> never_touch;  ///< colliders that do not meet while it lasts, sorted pairs
};

/** Colliders that move and the layer of a live environment, as they are between two steps. */
struct CloudNeighbours {
  /** A collider and where its geometry is. */
  struct Neighbour {
    int collider;
    std::shared_ptr<const contact::CollisionGeometry> geometry;
    double radius;  ///< [m] of its layer
    Pose X_WC;
  };
  double width = 0;  ///< [m] of the environment's layer
  std::vector<Neighbour> colliders;
};

/** Points or triangles of a live environment as contact takes them. */
struct CloudSurface {
  std::shared_ptr<const contact::CollisionGeometry> geometry;  ///< null: no triangle, as a map without walls
  double radius = 0;                 ///< [m] of each point; 0: triangles, whose layer is the environment's boundary_width
  Vector3 origin = Vector3::Zero();  ///< [m] of the geometry's frame in the world: zero unless the surface is far away
  geometry::MeshReport report;

  bool isMesh() const { return radius == 0; }
};

/**
 * Filters points, joins them to triangles if `as` is MESH, and makes their tree. Any thread may call it, beside the steps; that is where
 * the time of an update goes.
 * @param cloud [m] in the world @param name of the environment, in messages
 * @throws InputError: filters that cannot be met, no point left, a mesher that does not suit the cloud, no triangle
 */
CloudSurface makeCloudSurface(model::SensedCloud cloud, const model::CloudOptions& options, const std::string& name);

/** Cleans and mends triangles and makes their tree, as makeCloudSurface. @param mesh [m] in the world @throws InputError: none is left */
CloudSurface makeMeshSurface(geometry::TriangleMesh mesh, const std::string& name);

/** Memory of searches for a collider's contacts with the next surface of a live environment. */
struct SearchedAhead {
  int collider;
  contact::NarrowPhaseMemory memory;
};

/**
 * Searches the contacts of a surface with what is near it, so that Simulator::updateCloud need not: it takes less time then, the less
 * things move in between, and its result is the same. Any thread may call it, beside the steps.
 */
std::vector<SearchedAhead> searchAhead(const CloudNeighbours& neighbours, const CloudSurface& surface);

/** A time of simulation in which a load acts, from a step's start to another's. */
struct LoadTime {
  double start = 0;     ///< [s] simulated; in the past: now
  double duration = 0;  ///< [s] below 0: until it is cleared; a step at least
};

/** Wrench from outside on a body. */
struct BodyLoad {
  int body = 0;
  Wrench wrench;                  ///< [N, N m] world axes
  Vector3 p_B = Vector3::Zero();  ///< [m] in the body's frame, where the force acts
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

/** Memories of controllers from step to step, by robot and controller; no step depends on them. */
using ControllerMemories = std::map<std::string, std::map<std::string, std::vector<double>>>;

/** Everything a simulation needs to replay bit for bit: world, motors, trajectories, sensors, random generators, contact memory. */
struct SimulationState {
  StateHeader header;
  std::uint64_t step = 0;
  dynamics::WorldState world;
  std::vector<double> numbers;
  std::vector<std::uint64_t> words;
  std::string
      layout;  ///< things the state belongs to: settings, models, bodies, joints, colliders, sensors; each with a hash of its content
  ControllerMemories memories;
};

}  // namespace blem_sim::sim
