#include "csv_table.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

namespace {

/** Bodies whose pose a row holds: the first of each free robot and object. */
std::vector<int> freeBodies(const sim::Simulator& simulator) {
  std::set<int> fixed;
  for (const sim::RobotInfo& robot : simulator.robots())
    if (robot.fixed_base) fixed.insert(robot.model);
  std::vector<int> bodies;
  for (std::size_t m = 0; m < simulator.models().size(); ++m) {
    const sim::ModelInfo& model = simulator.models()[m];
    if (model.kind != sim::ModelKind::ENVIRONMENT && !model.bodies.empty() && fixed.count(static_cast<int>(m)) == 0)
      bodies.push_back(model.bodies[0]);
  }
  return bodies;
}

void put(std::ostream& stream, double value) {
  stream << ',';
  if (!std::isnan(value)) stream << fmt::format("{}", value);
}

}  // namespace

CsvTable::CsvTable(const sim::Simulator& simulator, const std::string& file, double rate)
    : simulator_(simulator), file_(file), stream_(file), rate_(rate), readings_(simulator) {
  if (!stream_) throw InputError(fmt::format("{}: cannot be written; check the folder", file));
  writeHeader();
}

void CsvTable::close() {
  stream_.close();
  if (!stream_) throw InputError(fmt::format("{}: its rows could not all be written; make room on its disk", file_));
}

void CsvTable::writeHeader() {
  stream_ << "time";
  for (const sim::RobotInfo& robot : simulator_.robots())
    for (const std::string& joint : robot.joint_names)
      for (const char* suffix : {"", "_vel", "_effort", "_desired"}) stream_ << ',' << robot.name << "::" << joint << suffix;
  for (const int body : freeBodies(simulator_))
    for (const char* suffix : {"_x", "_y", "_z", "_qx", "_qy", "_qz", "_qw"}) stream_ << ',' << simulator_.bodyName(body) << suffix;
  for (const std::string& name : readings_.names()) stream_ << ',' << name;
  stream_ << '\n';
}

void CsvTable::add(const sim::StepReport& report) {
  readings_.add(report);
  // Instant n / rate is due in the first step that reaches it; the tolerance absorbs the rounding of step times.
  const double tolerance = 1e-6 * report.dt;
  const bool due = rate_ <= 0 || std::floor((report.time + tolerance) * rate_) > std::floor((report.time - report.dt + tolerance) * rate_);
  if (due) writeRow(report);
}

void CsvTable::writeRow(const sim::StepReport& report) {
  stream_ << fmt::format("{}", report.time);
  for (std::size_t r = 0; r < simulator_.robots().size(); ++r) {
    const sim::RobotInfo& robot = simulator_.robots()[r];
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const dynamics::JointState& state = report.joints[static_cast<std::size_t>(robot.joints[j])];
      const double desired = simulator_.desiredState(static_cast<int>(r), static_cast<int>(j)).position;
      for (const double value : {state.position, state.velocity, state.effort, desired}) put(stream_, value);
    }
  }
  for (const int body : freeBodies(simulator_)) {
    const Pose& X_WB = report.bodies[static_cast<std::size_t>(body)].X_WB;
    const Quaternion q(X_WB.linear());
    for (const double value : {X_WB.translation().x(), X_WB.translation().y(), X_WB.translation().z(), q.x(), q.y(), q.z(), q.w()})
      put(stream_, value);
  }
  for (const double value : readings_.values()) put(stream_, value);
  stream_ << '\n';
}

}  // namespace blem_sim
