// The extension module blem_sim._simulator; the package blem_sim shows what is in it.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "blem_sim/geometry/input_error.h"
#include "numbers_of.h"
#include "python_config.h"
#include "simulation.h"
#include "simulation_clearance.h"

namespace py = pybind11;
using py::arg;

namespace blem_sim::python {

namespace {

using Class = py::class_<Simulation>;

const char SIMULATOR[] =
    "A simulation: Simulator(config, packages=None, folder=None, settings=None).\n\n"
    "config: path of a YAML file (config/default.yaml is the manual), a dictionary of the same keys, or a text of YAML: one with a line\n"
    "  break, or that begins with {.\n"
    "packages: {name: folder} for package:// URIs, asked before ROS_PACKAGE_PATH.\n"
    "folder: of relative files; by default that of the YAML file, else the working directory.\n"
    "settings: {'contact.friction': 0.3}: values that replace the configuration's, as --set of blem_sim_run.\n\n"
    "The arrays positions, velocities, efforts, poses and body_velocities show the state at hand: each is one array, read-only, whose\n"
    "numbers change with step, reset, restore and set_joint_positions. Copy what shall stay. They may outlive the Simulator.\n"
    "contacts and sensors are new arrays each time. Units are SI, axes the world's unless said otherwise.\n"
    "Several threads may use one Simulator; they wait for each other. step lets the others run meanwhile.\n"
    "Bad input raises InputError, a ValueError of one line, and changes nothing.";

std::unique_ptr<Simulation> makeSimulation(const py::object& config, const py::object& packages, const py::object& folder,
                                           const py::object& settings) {
  const sim::SimulationConfig read = configOf(config, {folder, settings});
  const model::UriResolver resolver(packagesOf(packages));
  std::unique_ptr<sim::Simulator> simulator;
  {
    const py::gil_scoped_release others_go_on;
    simulator = std::make_unique<sim::Simulator>(read, resolver);
  }
  return std::make_unique<Simulation>(std::move(simulator));
}

/** An array that goes on to show the simulation. */
template <const LiveArray& (Simulation::*ARRAY)() const>
py::array shown(const Simulation& simulation) {
  return (simulation.*ARRAY)().array();
}

void addTime(Class* simulator) {
  simulator->def("step", &Simulation::step, arg("n") = 1,
                 "Makes n time steps; fewer if the state stops being finite (STATE_NOT_FINITE in status). Other threads run meanwhile.");
  simulator->def("reset", &Simulation::reset, "Back to the start: time 0, models at their start poses, random generators anew.");
  simulator->def("save", &Simulation::save, "State as bytes, as the files of blem_sim_run --save-state have them.");
  simulator->def("restore", &Simulation::restore, arg("state"),
                 "Goes on from bytes of save with the same bits. InputError: they are none, altered, or of another world.");
  simulator->def("state_hash", &Simulation::stateHash, "Hash of all that later steps depend on, as state_hash of blem_sim_run's report.");
  simulator->def_property_readonly("time", &Simulation::time, "[s] simulated.");
  simulator->def_property_readonly("steps", &Simulation::steps, "Steps made since the start.");
  simulator->def_property_readonly("time_step", &Simulation::timeStep, "[s] of one step.");
  simulator->def_property_readonly("energy", &Simulation::energy, "[J] kinetic and potential, after the last step.");
  simulator->def_property_readonly("status", &Simulation::status,
                                   "Names of what any step of the last call of step had to tell; STEP_STATUS explains them.");
  simulator->def_property_readonly("notes", &Simulation::notes, "Repairs and assumptions made while loading, in words.");
}

void addState(Class* simulator) {
  simulator->def_property_readonly("robots", &Simulation::robots, "Names of the robots.");
  simulator->def("robot_joints", &Simulation::robotJoints, arg("robot"), "Names of a robot's movable joints, in the order of commands.");
  simulator->def_property_readonly("joint_names", &Simulation::jointNames, "'robot::joint' of the rows of positions, velocities, efforts.");
  simulator->def_property_readonly("positions", shown<&Simulation::positions>, "[rad or m] of the joints; read-only, goes on with step.");
  simulator->def_property_readonly("velocities", shown<&Simulation::velocities>,
                                   "[rad/s or m/s] of the joints; read-only, goes on with step.");
  simulator->def_property_readonly("efforts", shown<&Simulation::efforts>,
                                   "[N m or N] of the joints' motors, means over the last step; read-only, goes on with step.");
  simulator->def_property_readonly("body_names", &Simulation::bodyNames, "'model::link' of the rows of poses and body_velocities.");
  simulator->def_property_readonly("poses", shown<&Simulation::poses>,
                                   "N x 7: x y z [m] of the bodies' origins, quaternion x y z w; read-only, goes on with step.");
  simulator->def_property_readonly("body_velocities", shown<&Simulation::bodyVelocities>,
                                   "N x 6: velocity [m/s] of the bodies' origins, angular velocity [rad/s]; read-only, goes on with step.");
  simulator->def_property_readonly(
      "contacts", &Simulation::contacts,
      "Contacts that acted in the last step, a structured array: body_a, body_b (rows of body_names, -1 the\n"
      "world), point [m], normal (from B to A), force [N] on A, depth [m], of_layer (depth over both layers).");
  simulator->def_property_readonly("sensors", &Simulation::sensors,
                                   "{name: last reading since the start, reset or restore}, arrays in the order of sensor_fields.");
  simulator->def("sensor_fields", &Simulation::sensorFields, arg("sensor"), "Names of the numbers of a sensor's readings.");
}

void addCommands(Class* simulator) {
  simulator->def(
      "command",
      [](Simulation& simulation, const std::string& robot, const py::object& positions, const py::object& velocities,
         const py::object& efforts, const py::object& joints) {
        simulation.command(robot, {positions, velocities, efforts, joints});
      },
      arg("robot"), arg("positions") = py::none(), arg("velocities") = py::none(), arg("efforts") = py::none(), arg("joints") = py::none(),
      "Targets of a robot's motors from now on, one number for each of joints (all of robot_joints if left out). Positions are held, with\n"
      "velocities as their rate; velocities alone are kept; efforts alone act, beside the others they add.");
  simulator->def(
      "command_trajectory",
      [](Simulation& simulation, const std::string& robot, const py::object& times, const py::object& positions,
         const py::object& velocities, const py::object& joints, double start) {
        simulation.commandTrajectory(robot, times, {positions, velocities, py::none(), joints}, start);
      },
      arg("robot"), arg("times"), arg("positions"), arg("velocities") = py::none(), arg("joints") = py::none(), arg("start") = 0.0,
      "Points to be reached at times [s] after start [s] simulated (0: now), a row of positions for each; cubic with velocities.");
  simulator->def("set_joint_positions", &Simulation::setJointPositions, arg("robot"), arg("positions"), arg("joints") = py::none(),
                 "Puts joints there [rad or m], moved into their limits, at rest; motors hold them.");
}

void addLoads(Class* simulator) {
  simulator->def("apply_effort", &Simulation::applyEffort, arg("joint"), arg("effort"), arg("duration") = 0.0,
                 "Effort [N m or N] beside the motor's for a duration [s] (0: the next step alone); below 0: until clear_efforts.");
  simulator->def(
      "apply_wrench",
      [](Simulation& simulation, const std::string& body, const py::object& force, const py::object& torque, const py::object& point,
         double duration) {
        sim::BodyLoad load;
        load.wrench = {vectorOf(force, "force"), vectorOf(torque, "torque")};
        load.p_B = vectorOf(point, "point");
        simulation.applyWrench(body, load, duration);
      },
      arg("body"), arg("force"), arg("torque") = py::make_tuple(0, 0, 0), arg("point") = py::make_tuple(0, 0, 0), arg("duration") = 0.0,
      "Force [N] and torque [N m], world axes, at a point [m] in the link's frame, for a duration [s] (0: the next step alone); below 0: "
      "until\n"
      "clear_wrenches. body: 'model::link'.");
  simulator->def("clear_efforts", &Simulation::clearEfforts, arg("joint"), "Ends all apply_effort of a joint.");
  simulator->def("clear_wrenches", &Simulation::clearWrenches, arg("body"), "Ends all apply_wrench of a body.");
}

void addClearance(Class* simulator, const py::module& module) {
  py::class_<SimulationClearance> clearance(
      module, "Clearance",
      "A robot in any pose among the things around it, which stand as they stood when it was made, by\n"
      "Simulator.clearance. Links that a joint joins, that disable_collisions lists, or that crossed each\n"
      "other then are never told of. A link that is wholly inside a mesh is near nothing.");
  clearance.attr("__module__") = "blem_sim";
  clearance.def_property_readonly("links", &SimulationClearance::links, "Names of the robot's links, in the order of poses.");
  clearance.def_property_readonly("colliders", &SimulationClearance::colliders, "'model::link' of the rows a and b of find.");
  clearance.def(
      "find", &SimulationClearance::find, arg("poses"), arg("distance"),
      "Pairs with less than a distance [m] between their layers, were the links at these poses (N x 7: x y z, quaternion x y z w,\n"
      "world). A structured array: a, b (rows of colliders, a of the robot), gap [m] (below 0: layers overlap), crossed (bare meshes\n"
      "do, and the gap is rough), point [m], normal (from B to A).");
  simulator->def("clearance", &Simulation::clearance, arg("robot"), "A Clearance of a robot, everything else being where it is now.");
}

}  // namespace

PYBIND11_MODULE(_simulator, module) {
  addContactType();
  addApproachType();
  module.doc() = "Simulations of robots in contact with meshes and clouds; use it as blem_sim.";
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  module.attr("InputError").attr("__module__") = "blem_sim";
  py::dict status;
  for (const sim::StatusBit& bit : sim::STEP_STATUS) status[bit.name] = py::make_tuple(bit.meaning, bit.cure);
  module.attr("STEP_STATUS") = status;
  Class simulator(module, "Simulator", SIMULATOR);
  simulator.attr("__module__") = "blem_sim";
  simulator.def(py::init(&makeSimulation), arg("config"), arg("packages") = py::none(), arg("folder") = py::none(),
                arg("settings") = py::none());
  addTime(&simulator);
  addState(&simulator);
  addCommands(&simulator);
  addLoads(&simulator);
  addClearance(&simulator, module);
}

}  // namespace blem_sim::python
