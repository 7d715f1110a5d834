// Contacts and sensors as arrays.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/sensor_values.h"
#include "simulation.h"
#include "simulation_contact.h"
#include "thread_turn.h"

namespace py = pybind11;

namespace blem_sim::python {

void addContactType() { PYBIND11_NUMPY_DTYPE(SimulationContact, body_a, body_b, point, normal, force, depth, of_layer); }

py::array Simulation::contacts() {
  const ThreadTurn turn(&turn_);
  const std::vector<sim::ContactReport>& reports = simulator_->report().contacts;
  py::array_t<SimulationContact> array(static_cast<Py_ssize_t>(reports.size()));
  SimulationContact* row = array.mutable_data();
  const auto rowOf = [&](int body) { return body == dynamics::WORLD_BODY ? -1 : rows_[static_cast<std::size_t>(body)]; };
  for (const sim::ContactReport& report : reports) {
    row->body_a = rowOf(report.body_a);
    row->body_b = rowOf(report.body_b);
    std::copy_n(report.point.data(), 3, row->point);
    std::copy_n(report.normal_BA.data(), 3, row->normal);
    std::copy_n(report.force.data(), 3, row->force);
    row->depth = report.depth;
    row->of_layer = report.of_layer;
    ++row;
  }
  return array;
}

py::dict Simulation::sensors() {
  const ThreadTurn turn(&turn_);
  const std::vector<std::string> names = sim::sensorNames(*simulator_);
  py::dict readings;
  for (std::size_t sensor = 0; sensor < names.size(); ++sensor) {
    if (!readings_[sensor]) continue;
    const std::vector<double> values = sim::sensorValues(*readings_[sensor]).values;
    readings[py::str(names[sensor])] = py::array_t<double>(static_cast<Py_ssize_t>(values.size()), values.data());
  }
  return readings;
}

std::vector<std::string> Simulation::sensorFields(const std::string& sensor) const {
  const std::vector<std::string> names = sim::sensorNames(*simulator_);
  const auto found = std::find(names.begin(), names.end(), sensor);
  if (found == names.end())
    throw InputError(fmt::format("sensor: there is no sensor '{}'; there is {}", sensor,
                                 names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  return sim::sensorFields(*simulator_, simulator_->sensors()[static_cast<std::size_t>(found - names.begin())]);
}

}  // namespace blem_sim::python
