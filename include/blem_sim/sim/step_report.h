// Report of one step, as immutable plain data: sensors, statistics and publishers read this and nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/sim/step_status.h"

namespace blem_sim::sim {

/** Stages of a step, as the table of docs/architecture.md has them. */
enum class Stage { SAMPLE_COMMANDS, MOTOR_TORQUE, BROAD_PHASE, NARROW_PHASE, REDUCTION, SOLVE, STEP_GUARD, SENSORS, REPORT, COUNT };
extern const std::array<const char*, static_cast<int>(Stage::COUNT)> STAGE_NAMES;  ///< "sample_commands", ...

/** Wall time [s] per stage of one step. */
struct StepProfile {
  std::array<double, static_cast<int>(Stage::COUNT)> seconds{};
};

/**
 * A contact that acted in a step, for publishing: at the start of the step, or of its parts. Contacts of one identity that acted in
 * several parts are one: the point is the mean weighted with the impulses, the normal that of the largest impulse.
 */
struct ContactReport {
  int collider_a = -1, collider_b = -1;
  int body_a = dynamics::WORLD_BODY, body_b = dynamics::WORLD_BODY;
  Vector3 point = Vector3::Zero(), normal_BA = Vector3::Zero();  ///< world
  double depth = 0;                                              ///< [m] largest in the step
  double of_layer = 0;                                           ///< depth / (rA + rB); above 1 a bare mesh is pierced; 0 without a layer
  Vector3 force = Vector3::Zero();  ///< [N] on A, world; mean over the step: times StepReport::dt it is the impulse
  bool pierced = false;
  /** [N m] world. The mean torque on A about the origin of its link (an object's frame), which moves on from part to part, is
   *  (point - that origin at the start of the step) x force + moment_a; that on B likewise, of -force. 0 in a step of one part. */
  Vector3 moment_a = Vector3::Zero(), moment_b = Vector3::Zero();
};

/** The contacts of two colliders left their boundary layers, or came back. */
struct LayerEventReport {
  double time = 0;                       ///< [s] simulated, of the state whose contacts they are: the start of the (sub)step
  int collider_a = -1, collider_b = -1;  ///< a < b
  bool outside = false;                  ///< true: more than the layers is used up, or bare meshes cross, there or on the way to the next
                                         ///< state; false: not any more
  double depth = 0;                      ///< [m] of their deepest contact, 0 without one
  double of_layer = 0;                   ///< depth / (rA + rB); 0 without a layer
  bool pierced = false;                  ///< bare meshes cross, there or on the way
};

struct ForceTorqueReading {
  Vector3 force, torque;  ///< means over the step, in the frame, as it begins, and of the sign the sensor's configuration asks for
  std::string frame_id;   ///< link that frame is fixed in
};
struct ImuReading {
  Quaternion orientation;       ///< sensor in the world
  Vector3 angular_velocity;     ///< [rad/s] sensor axes
  Vector3 linear_acceleration;  ///< [m/s^2] specific force, sensor axes: +9.81 up at rest
  double accel_stddev, gyro_stddev;
};
struct ContactReading {
  std::vector<int> contacts;     ///< indices into StepReport::contacts
  std::vector<Wrench> wrenches;  ///< of each, on the link, world axes, about the link's origin where it acted; means over the step
  int link_body = -1;
  Wrench total;  ///< their sum
};
struct ContactSwitchReading {
  double force = 0;  ///< [N] by which the link is pressed: sum of its contacts' forces along their normals, mean over the step
  bool closed = false;
};
/** There is none while nothing presses on the sole. */
struct CentreOfPressureReading {
  double x = 0, y = 0;  ///< [m] in the sensor's plane of x and y, where contacts' forces have no moment about x and y
  double force = 0;     ///< [N] along z on the link
};
struct TiltReading {
  Quaternion orientation;
  Vector3 angular_velocity;
  double roll = 0, pitch = 0;  ///< [rad]
  double angle_stddev = 0, gyro_stddev = 0;
};
struct MotorCurrentReading {
  std::vector<std::string> joints;
  std::vector<double> efforts, currents;  ///< [N m or N], [A] means over the step
};
struct OdometryReading {
  Vector3 position;                           ///< [m] sensor in the world
  Quaternion orientation;                     ///< sensor in the world
  Vector3 linear_velocity, angular_velocity;  ///< [m/s, rad/s] of the sensor's origin and axes, in the axes its configuration asks for
  double stddev;                              ///< of each of them
};
struct RangeView;
/** A view that is taken, not drawn: depthsOf (range_view.h) draws it when somebody wants to see it. */
struct DepthCameraReading {
  std::shared_ptr<const RangeView> view;
};
/** The same for rangesOf. */
struct LidarReading {
  std::shared_ptr<const RangeView> view;
};
/** A new sensor is one alternative; sensorValues and the visits in ros do not compile until they know it. */
using SensorReading = std::variant<ForceTorqueReading, ImuReading, ContactReading, TiltReading, MotorCurrentReading, OdometryReading,
                                   DepthCameraReading, LidarReading, ContactSwitchReading, CentreOfPressureReading>;

struct SensorSample {
  int sensor = 0;  ///< index into Simulator::sensors()
  SensorReading reading;
  std::optional<SensorReading> truth;  ///< of the end of this step, without error and delay; none if the sensor has neither
};

struct StepReport {
  std::uint64_t step = 0;
  double time = 0;  ///< [s] simulated, after the step
  double dt = 0;
  std::uint32_t status = STEP_OK;
  int substeps = 1;
  int redone_solves = 0;   ///< solves thrown away: of steps that used up a layer, or that pushed what is not met
  int searched_pairs = 0;  ///< of colliders, after the step: pairs whose contacts were searched
  int raw_contacts = 0, reduced_contacts = 0;
  double wrench_error = 0;                 ///< worst over the step, where contacts were left out: ReductionLoss::wrench
  double max_depth = 0, max_of_layer = 0;  ///< over this step's contacts
  int deepest_a = -1, deepest_b = -1;      ///< colliders
  double energy = 0;                       ///< [J] kinetic + potential
  /** [J] rise of energy (bodies, rotors, springs of compliant contacts) in this step beyond the work of motors and joint friction (effort
   *  times joint motion): the sum over islands, so that none's gain is hidden by another's loss, which contacts may cause.
   *  Corrections of depth count, and integration errors of order dt. */
  double energy_gained = 0;
  /** [J] the part of energy_gained that nothing explains: without the work of contacts on purpose (correcting depth, parting meshes that
   *  cross) and without their apparent work. ENERGY_GAINED is set if that of an island is beyond its bound. */
  double energy_out_of_nothing = 0;
  double solver_residual = 0;  ///< [N] SolveResult::residual, mean over the parts as the contacts' forces are
  double solver_creep = 0;     ///< [rad/s or m/s] worst over the step: SolveResult::creep
  int solver_iterations = 0;   ///< over the step's solves
  StepProfile profile;
  std::vector<ContactReport> contacts;          ///< that acted in any part of the step
  std::vector<LayerEventReport> layer_events;   ///< in order of time, then of colliders
  std::vector<std::string> broken_attachments;  ///< models whose weld the step's forces broke
  std::vector<dynamics::BodyState> bodies;      ///< one per body slot
  std::vector<dynamics::JointState> joints;     ///< one per joint slot; efforts are means over the step
  std::vector<SensorSample> samples;            ///< those whose time has come
};

}  // namespace blem_sim::sim
