// How near a robot comes to things, as Python asks it.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "blem_sim/sim/clearance.h"

namespace blem_sim::python {

/** Two colliders near each other, as one row of an array of numpy. */
struct SimulationApproach {
  std::int32_t a, b;           ///< rows of SimulationClearance::colliders, a of the robot
  double gap;                  ///< [m] between their layers
  bool crossed;                ///< bare meshes cross
  double point[3], normal[3];  ///< [m], 1: world, the normal from B to A
};

/** Tells numpy the fields of rows of SimulationClearance::find; once, when the module is loaded. */
void addApproachType();

/** A robot among the things around it. Calls from several threads wait for each other. */
class SimulationClearance {
 public:
  explicit SimulationClearance(sim::RobotClearance clearance) : clearance_(std::move(clearance)) {}

  const std::vector<std::string>& links() const { return clearance_.links(); }
  const std::vector<std::string>& colliders() const { return clearance_.colliders(); }
  /** @param poses of the links, rows as Simulation::poses has them @param distance [m] @throws InputError: other numbers than those */
  pybind11::array find(const pybind11::object& poses, double distance);

 private:
  std::mutex turn_;
  sim::RobotClearance clearance_;
};

}  // namespace blem_sim::python
