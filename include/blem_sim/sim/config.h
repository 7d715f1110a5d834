// Configuration of a simulation, as in the YAML of the interface. Filled by config_parser, or by hand in tests.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/model/loaders.h"
#include "blem_sim/model/voxel_map.h"
#include "blem_sim/sim/controller_config.h"
#include "blem_sim/sim/rates.h"

namespace YAML {
class Node;
}

namespace blem_sim::sim {

/** Width r of the layer around a mesh: a length, or chosen when the mesh is loaded (docs/boundary_widths.md). */
struct BoundaryWidth {
  BoundaryWidth(double metres = 0) : metres(metres) {}
  static BoundaryWidth chosen() {
    BoundaryWidth width;
    width.automatic = true;
    return width;
  }

  double metres;  ///< [m]
  bool automatic = false;
};

/** Contact settings that may be set again per environment, robot, object or link; unset ones inherit. */
struct ContactOverrides {
  std::optional<BoundaryWidth> boundary_width;
  std::optional<double> friction, restitution, impact_friction_factor, impact_friction_speed, stiffness, damping;
  std::optional<bool> shrink;
};

struct ContactConfig {
  BoundaryWidth boundary_width = 0.0025;  ///< robots and objects; environments default to 0, or are chosen as well
  bool shrink = false;  ///< meshes by their boundary_width, so that outer dimensions stay (shrinkMesh); cylinders of a URDF always
  contact::SurfaceProperties surface;
  contact::FrictionRule friction_rule = contact::FrictionRule::MIN;
  int max_contacts_per_robot = 50;
  int max_contacts_per_object = 20;
  std::string reduction = "hull";
  model::Mending mending = model::Mending::ON;  ///< of the meshes of robots, objects and environments
};

/** A cloud, a mesh or a map that is sent anew again and again. */
struct LiveConfig {
  enum class Type { CLOUD, MESH, GRID };
  enum class Update { REPLACE, ACCUMULATE };
  std::string topic;            ///< empty: the environment is no live one
  Type type = Type::CLOUD;      ///< of the messages: sensor_msgs/PointCloud2, shape_msgs/Mesh, nav_msgs/OccupancyGrid
  std::string frame = "world";  ///< that clouds and grids are turned into, taken for the world's; of a mesh, which names none, its own
  Update update = Update::REPLACE;
  model::VoxelMapOptions map;   ///< of ACCUMULATE
  double fade_speed = 0.00025;  ///< [m/s] at which points and triangles come and go below what stands on them
  int occupied = 50;            ///< GRID: value of a cell from which it is a wall
  double wall_height = 1;       ///< [m] GRID
};

struct EnvironmentConfig {
  std::string name;
  std::string uri;                       ///< file, or
  std::optional<Eigen::Vector4d> plane;  ///< a x + b y + c z = d, solid below, or
  LiveConfig live;                       ///< a topic (node only): Simulator::updateCloud brings the points
  Pose X_WE = Pose::Identity();
  Vector3 scale = Vector3::Ones();
  model::CloudOptions cloud;
  ContactOverrides contact;
};

/** Eq. 7's gains. */
struct JointGains {
  double p = 0, i = 0, d = 0;
  double i_clamp = std::numeric_limits<double>::infinity();  ///< [N m or N] bound on the integral term
};

enum class MotorLaw { PID, IMPLICIT_PD };

/** Motors of joints without gains. */
enum class MotorDefault {
  COMPUTED,       ///< gains computed from what the joints carry: the robot holds its pose
  TRANSMISSIONS,  ///< the same where the URDF has a `<transmission>`, as Gazebo needs it; others are free
  FREE,           ///< none: joints move freely, friction stays
};

struct JointFriction {
  double dry = 0, viscous = 0;
};

enum class SensorType {
  FORCE_TORQUE,
  IMU,
  CONTACT,
  CONTACT_SWITCH,
  CENTRE_OF_PRESSURE,
  TILT,
  MOTOR_CURRENT,
  ODOMETRY,
  DEPTH_CAMERA,
  LIDAR
};

enum class RangeNoise { GAUSSIAN, KINECT };

/** Range and resolution of a quantity that a sensor measures. */
struct QuantityLimits {
  double saturation = std::numeric_limits<double>::infinity();  ///< a reading goes from - this to + this
  double resolution = 0;                                        ///< step of its numbers; 0: as fine as they are

  bool any() const { return resolution > 0 || saturation < std::numeric_limits<double>::infinity(); }
};
/** force_torque: force [N], torque [N m]; imu: acceleration, rate; tilt: angles, rate; motor_current: current [A], effort;
 *  contact_switch: force; centre_of_pressure: position [m]. */
using SensorLimits = std::array<QuantityLimits, 2>;

/** Noise and bias of a quantity that a sensor measures, the same for all of its numbers. */
struct QuantityNoise {
  double stddev = 0;       ///< standard deviation of white noise
  double bias_stddev = 0;  ///< of a bias that walks: its standard deviation after one second
  double bias = 0;         ///< mean of a constant bias,
  double bias_spread = 0;  ///< and the standard deviation it is drawn with, with the first reading

  bool remembers() const { return bias_stddev > 0 || bias != 0 || bias_spread > 0; }
  bool any() const { return stddev > 0 || remembers(); }
};
/** Noise of the quantities of SensorLimits; all of odometry's have the first one's stddev [m, rad, m/s, rad/s]. */
using SensorNoise = std::array<QuantityNoise, 2>;

/** Rays of a depth camera or a lidar. */
struct RangeSensorConfig {
  double nearest = 0.4, farthest = 5;  ///< [m] along the optical axis of a camera, along the beam of a lidar
  RangeNoise noise = RangeNoise::GAUSSIAN;
  double stddev = 0;                              ///< [m] of gaussian noise
  int width = 640, height = 480;                  ///< [pixels] depth_camera
  double hfov = 1;                                ///< [rad] depth_camera: between the outer borders of the outer columns
  int beams = 720, layers = 1;                    ///< lidar
  double first_angle = -2.35, last_angle = 2.35;  ///< [rad] lidar: of the outer beams, counter-clockwise about z from x
  double lowest_angle = 0, highest_angle = 0;     ///< [rad] lidar: of the outer layers above the plane of x and y
};

/** Topics of a depth camera; empty: image_raw and so on below depth/ below the sensor's topic. */
struct CameraTopics {
  std::string image_raw, image, camera_info, points;
};

/** Sensors that look: depth_camera and lidar. */
inline bool isRangeSensor(SensorType type) { return type == SensorType::DEPTH_CAMERA || type == SensorType::LIDAR; }

struct SensorConfig {
  std::string name;
  SensorType type = SensorType::IMU;
  std::string joint;                        ///< force_torque
  std::string frame = "child";              ///< force_torque: axes and origin, child | parent | sensor (the joint's at 0) | a link
  std::string measure = "parent_to_child";  ///< force_torque: parent_to_child (the wrench on the child) | child_to_parent
  std::string link;                         ///< that the sensor sits on; not of force_torque and motor_current
  std::string topic;                        ///< empty: the sensor's name
  std::string frame_id;                     ///< of the messages; empty: what the readings are in. odometry: name of the world
  Pose X_LS = Pose::Identity();             ///< sensor in the link; centre_of_pressure: z is the sole's normal. Not of contacts
  Pose X_offset = Pose::Identity();         ///< odometry: shift [m] of what is told, and turn about the world's axes
  double threshold = 0;                     ///< [N] contact_switch, centre_of_pressure: force beyond which there is contact
  std::string twist = "link";               ///< odometry: axes of the velocities, link (the sensor's) | world
  double rate = 0;                          ///< [Hz], 0 = every step, RATE_OFF = never
  SensorNoise noise;
  SensorLimits limits;
  double delay = 0;                               ///< [s] by which readings are old; not of contact, odometry and those that look
  std::map<std::string, double> torque_constant;  ///< motor_current, by joint, "default"
  RangeSensorConfig rays;                         ///< depth_camera, lidar
  CameraTopics camera_topics;                     ///< depth_camera
};

/** Ground truth of a robot's root link (node only). */
struct OdometryConfig {
  std::string topic = "odom", frame = "world";
  Pose X_WF = Pose::Identity();  ///< frame in the world
};

struct RobotConfig {
  std::string name;
  std::string urdf;               ///< file or URI, or
  std::string description_param;  ///< ROS parameter that holds the text (node), or
  std::string urdf_xml;           ///< the text itself (set by the node; spawned robots)
  std::string name_space;
  bool fixed_base = false;
  Pose X_WR = Pose::Identity();  ///< root link in the world
  std::map<std::string, double> initial_positions;
  std::optional<bool> self_collision;          ///< links touch each other; none given: what the URDF says, else they do not
  std::set<std::string> self_colliding_links;  ///< links that touch any other of the robot, if self_collision is not given
  std::set<std::string> weightless_links;      ///< that gravity does not act on
  std::vector<std::pair<std::string, std::string>> disable_collisions;
  ContactOverrides contact;
  std::map<std::string, ContactOverrides> links;
  std::map<std::string, ContactOverrides> described_links;  ///< of the URDF's `<gazebo>` blocks; beaten by contact and links
  std::map<std::string, JointGains> gains;                  ///< by joint, "default"
  std::map<std::string, JointGains> pid_gains;   ///< by joint, of gazebo_ros_control; gains beat them, names of no joint are left out
  MotorDefault motors = MotorDefault::COMPUTED;  ///< of joints that gains do not name
  std::map<std::string, MotorLaw> motor;         ///< by joint, "default"; implicit_pd where there is none
  std::map<std::string, JointFriction> joint_friction;  ///< by joint, "default"; beats the URDF's
  std::map<std::string, double> effort_limits;          ///< beats the URDF's
  std::map<std::string, double> velocity_limits;        ///< [rad/s or m/s] beats the URDF's
  double command_timeout = 0;                           ///< [s] after which velocity and effort commands end and joints hold; 0: never
  std::map<std::string, double> armature;               ///< [kg m^2 or kg] rotor inertia seen at the joint; by joint, "default"
  std::vector<SensorConfig> sensors;
  std::optional<std::vector<ControllerConfig>> controllers;  ///< none given: one of all joints (node only)
  std::vector<ControllerConfig> drives;                      ///< of the URDF's `<gazebo>` blocks; controllers of their names beat them
  std::optional<int> max_contacts;                           ///< k of this robot
  std::string tf_prefix;                                     ///< of its frames (node only)
  bool publish_tf = true;                                    ///< /tf has where its root link is, and children of floating and planar joints
  OdometryConfig odom;
};

struct ObjectConfig {
  std::string name;
  std::string uri;       ///< mesh or cloud, or
  std::string urdf;      ///< a one-body URDF, or
  std::string urdf_xml;  ///< the text of one (spawned objects)
  Vector3 scale = Vector3::Ones();
  Pose X_OM = Pose::Identity();  ///< mesh in the object's frame
  Pose X_WO = Pose::Identity();
  std::optional<double> mass;
  std::optional<Vector3> com;                                                     ///< in the object's frame
  std::optional<Matrix3> inertia;                                                 ///< about com, object's axes
  Vector3 linear_velocity = Vector3::Zero(), angular_velocity = Vector3::Zero();  ///< [m/s, rad/s] at the start, world axes
  model::CloudOptions cloud;
  ContactOverrides contact;
  std::optional<int> max_contacts;
};

struct SimulationConfig {
  double time_step = 0.001;
  double real_time_factor = 1.0;
  bool busy_wait = false;  ///< of the node: between steps the stepping thread does not sleep
  bool paused = false;
  Vector3 gravity = Vector3(0, 0, -9.81);
  std::uint64_t random_seed = 1;
  dynamics::SolverSettings solver;
  ContactConfig contact;
  std::vector<EnvironmentConfig> environments;
  std::vector<RobotConfig> robots;
  std::vector<ObjectConfig> objects;
  PublishRates rates;
  bool layer_markers = false;           ///< of the node: boundary layers for rviz
  double checkpoint_period = 0;         ///< [s] simulated; 0: the node keeps no checkpoint
  std::string checkpoint_file;          ///< of the node; empty: below ROS_HOME, named after the node
  std::string record_file;              ///< of the node: all inputs from the first step on; empty: none
  std::string base_directory;           ///< of relative files
  bool allow_file_services = true;      ///< false: no service of the node reads or writes files
  std::vector<std::string> file_roots;  ///< folders that services may use beside base_directory and ROS_PACKAGE_PATH
};

/**
 * Reads a configuration. @param source names the file or the node in messages. @param base_directory for relative files.
 * @throws InputError for an unknown key (names the nearest known one), a wrong type or range, a missing field.
 */
SimulationConfig parseConfig(const YAML::Node& root, const std::string& source, const std::string& base_directory);
SimulationConfig loadConfigFile(const std::string& file);
/** The document in a text, by a way that ends with every yaml-cpp. @throws YAML::Exception if it is not YAML */
YAML::Node loadYaml(const std::string& text);
/** The document in a file, unread. @throws InputError if it cannot be read or is not YAML */
YAML::Node loadYamlFile(const std::string& file);

/** Gains by joint as the parameter gazebo_ros_control/pid_gains has them: p, i, d, i_clamp (or i_clamp_max); other keys are left. */
std::map<std::string, JointGains> parsePidGains(const YAML::Node& node, const std::string& source);

/** One environment entry, as the load_environment service takes it. */
EnvironmentConfig parseEnvironment(const YAML::Node& node, const std::string& source);

}  // namespace blem_sim::sim
