// Joint trajectories with joint_trajectory_controller's semantics, without ROS.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::sim {

/** Largest position, velocity, acceleration and effort that may be commanded, in its SI unit. */
constexpr double LARGEST_COMMAND = 1e7;
/** Latest time [s] of a command. */
constexpr double LATEST_COMMAND = 1e10;
inline bool isCommand(double value) { return std::abs(value) <= LARGEST_COMMAND; }

struct TrajectoryPoint {
  double time_from_start = 0;         ///< [s], strictly increasing; old points, negative times among them, are left out
  std::vector<double> positions;      ///< one per joint
  std::vector<double> velocities;     ///< empty, or one per joint: cubic
  std::vector<double> accelerations;  ///< empty, or one per joint: quintic (needs velocities)
  std::vector<double> effort;         ///< empty, or one per joint: feed-forward
};

/** A command for some or all joints of a robot; no points = hold the present position. */
struct JointTrajectory {
  std::vector<std::string> joints;
  double start_time = 0;  ///< [s] simulated; <= 0: now
  std::vector<TrajectoryPoint> points;
};

/** Desired state of one joint at one time. */
struct JointSample {
  double position = 0, velocity = 0, acceleration = 0, effort = 0;
};

/** One joint's piecewise polynomial: the part of trajectories that is in force for it. */
class JointSpline {
 public:
  struct Knot {
    double time;  ///< [s] simulated
    double position, velocity, acceleration, effort;
    int order;  ///< highest order of a segment at this knot: 1 linear (positions only), 3 cubic (velocities), 5 quintic (accelerations)
  };
  JointSpline() = default;
  /** A spline that holds a position. */
  explicit JointSpline(double position);
  /**
   * From `now` on: follows the present spline until the new trajectory's start, then the new knots (times absolute, strictly
   * increasing). As joint_trajectory_controller has it: knots at or before `now`, or before the start, are dropped; the first one left is
   * reached by a bridge from the present spline, of that knot's own order; between two knots the lower of their orders counts. Nothing
   * changes if none is left. No knots given: hold the spline's present position.
   * @param continuous positions are taken to the turn nearest to the present one.
   */
  void splice(double now, double start, std::vector<Knot> knots, bool continuous);
  JointSample sample(double time) const;
  double startTime() const;  ///< [s] of what is known of the path: earlier times are held at its first position
  double endTime() const;
  Knot lastKnot() const;
  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  std::vector<Knot> knots_;
};

/** True for the end of one path; that of another differs in time or place. */
inline bool sameKnot(const JointSpline::Knot& a, const JointSpline::Knot& b) {
  return a.time == b.time && a.position == b.position && a.velocity == b.velocity;
}

/** Checks a command against a robot's joints. @throws InputError: unknown or repeated joint, sizes, NaN, beyond LARGEST_COMMAND, times not
 * increasing */
void checkTrajectory(const JointTrajectory& trajectory, const std::vector<std::string>& known_joints);

/** Reads a CSV with a `time` column, NAME and NAME_vel columns; `#` starts a comment. Columns of no known joint are listed in
 *  the output `ignored`. @throws InputError */
JointTrajectory loadTrajectoryCsv(const std::string& file, const std::vector<std::string>& known_joints, std::vector<std::string>* ignored);

}  // namespace blem_sim::sim
