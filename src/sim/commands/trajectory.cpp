#include "blem_sim/sim/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "numbers/nearest_name.h"

namespace blem_sim::sim {

namespace {

void checkNames(const JointTrajectory& trajectory, const std::vector<std::string>& known_joints) {
  std::set<std::string> seen;
  for (const std::string& joint : trajectory.joints) {
    if (std::find(known_joints.begin(), known_joints.end(), joint) == known_joints.end()) {
      const std::string nearest = nearestName(joint, known_joints);
      throw InputError(fmt::format("trajectory: joint '{}' is unknown; {}", joint,
                                   nearest.empty() ? "the robot has no movable joint" : "the nearest known one is '" + nearest + "'"));
    }
    if (!seen.insert(joint).second) throw InputError(fmt::format("trajectory: joint '{}' is named twice; name it once", joint));
  }
}

/** One value per joint, all finite. */
void checkValues(const JointTrajectory& trajectory, std::size_t point, const char* field, const std::vector<double>& values,
                 bool required) {
  if (values.empty() && !required) return;
  if (values.size() != trajectory.joints.size())
    throw InputError(fmt::format("trajectory: points[{}].{}: {} values for {} joints; give one per joint", point, field, values.size(),
                                 trajectory.joints.size()));
  for (std::size_t j = 0; j < values.size(); ++j)
    if (!isCommand(values[j]))
      throw InputError(fmt::format("trajectory: points[{}].{}: joint '{}' is not a finite number within {:g}; correct it", point, field,
                                   trajectory.joints[j], LARGEST_COMMAND));
}

void checkPoint(const JointTrajectory& trajectory, std::size_t index) {
  const TrajectoryPoint& point = trajectory.points[index];
  checkValues(trajectory, index, "positions", point.positions, true);
  checkValues(trajectory, index, "velocities", point.velocities, false);
  checkValues(trajectory, index, "accelerations", point.accelerations, false);
  checkValues(trajectory, index, "effort", point.effort, false);
  if (!point.accelerations.empty() && point.velocities.empty())
    throw InputError(fmt::format("trajectory: points[{}]: accelerations without velocities; give both", index));
}

}  // namespace

void checkTrajectory(const JointTrajectory& trajectory, const std::vector<std::string>& known_joints) {
  checkNames(trajectory, known_joints);
  if (!(std::abs(trajectory.start_time) <= LATEST_COMMAND))
    throw InputError(fmt::format("trajectory: the start time is not a finite number within {:g} s; 0 means now", LATEST_COMMAND));
  if (trajectory.joints.empty() && !trajectory.points.empty()) throw InputError("trajectory: points without joint names; name the joints");
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const double time = trajectory.points[i].time_from_start;
    if (!(std::abs(time) <= LATEST_COMMAND))
      throw InputError(
          fmt::format("trajectory: points[{}].time_from_start: must be a finite number within {:g} s, not {}", i, LATEST_COMMAND, time));
    if (i > 0 && time <= trajectory.points[i - 1].time_from_start)
      throw InputError(fmt::format("trajectory: points[{}].time_from_start: {} does not come after {}; times must increase strictly", i,
                                   time, trajectory.points[i - 1].time_from_start));
    checkPoint(trajectory, i);
  }
}

}  // namespace blem_sim::sim
