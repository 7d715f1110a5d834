#include "simulation_clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/geometry/input_error.h"
#include "numbers_of.h"
#include "thread_turn.h"

namespace py = pybind11;

namespace blem_sim::python {

namespace {

constexpr double UNIT_TO = 1e-6;  // to which a quaternion's length is 1

/** @param row x y z [m], quaternion x y z w @param number of the row, for messages */
Pose poseOf(const std::vector<double>& row, std::size_t number) {
  const auto refuse = [&](const char* what) { throw InputError(fmt::format("poses: row {}: {}", number, what)); };
  if (row.size() != 7) refuse("must be x y z and a quaternion x y z w");
  for (const double value : row)
    if (!(std::abs(value) <= geometry::FARTHEST_PLACE)) refuse("must be finite numbers of metres");
  const Quaternion turn(row[6], row[3], row[4], row[5]);
  if (std::abs(turn.norm() - 1) > UNIT_TO) refuse("its quaternion is not of length 1");
  Pose pose = Pose::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() << row[0], row[1], row[2];
  return pose;
}

}  // namespace

void addApproachType() { PYBIND11_NUMPY_DTYPE(SimulationApproach, a, b, gap, crossed, point, normal); }

py::array SimulationClearance::find(const py::object& poses, double distance) {
  const std::vector<std::vector<double>> rows = rowsOf(poses, "poses");
  std::vector<Pose> X_WL;
  for (const std::vector<double>& row : rows) X_WL.push_back(poseOf(row, X_WL.size()));
  const ThreadTurn turn(&turn_);
  const std::vector<sim::Approach> found = clearance_.find(X_WL, distance);
  py::array_t<SimulationApproach> array(static_cast<Py_ssize_t>(found.size()));
  SimulationApproach* row = array.mutable_data();
  for (const sim::Approach& approach : found) {
    row->a = approach.a;
    row->b = approach.b;
    row->gap = approach.gap;
    row->crossed = approach.crossed;
    std::copy_n(approach.point.data(), 3, row->point);
    std::copy_n(approach.normal_BA.data(), 3, row->normal);
    ++row;
  }
  return array;
}

}  // namespace blem_sim::python
