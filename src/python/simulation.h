// A simulation as Python has it: threads take turns, arrays show the state at hand.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "live_array.h"

namespace blem_sim::python {

class SimulationClearance;

/** Tells numpy the fields of rows of Simulation::contacts; once, when the module is loaded. */
void addContactType();

/** Numbers of one command, by the joints of a robot; None where nothing is commanded. */
struct CommandArguments {
  pybind11::object positions, velocities, efforts;
  pybind11::object joints;  ///< None: all of the robot
};

/**
 * Owns a simulator. Calls from several threads wait for each other, without the interpreter's lock; arrays are written only while it is
 * held. Input is refused by InputError, nothing being changed.
 */
class Simulation {
 public:
  explicit Simulation(std::unique_ptr<sim::Simulator> simulator);

  /** @param count of steps; ends before if the state stops being finite, or by a signal, whose Python exception is thrown */
  void step(std::int64_t count);
  void reset();
  pybind11::bytes save();
  void restore(const pybind11::bytes& state);
  std::string stateHash();

  double time();
  std::uint64_t steps();
  double timeStep();
  double energy();
  std::vector<std::string> status() const;  ///< bits that any of the steps of the last call set
  const std::vector<std::string>& notes() const { return simulator_->notes(); }

  std::vector<std::string> robots() const;
  std::vector<std::string> robotJoints(const std::string& robot) const;
  const std::vector<std::string>& jointNames() const { return joint_names_; }
  const std::vector<std::string>& bodyNames() const { return body_names_; }
  const LiveArray& positions() const { return positions_; }
  const LiveArray& velocities() const { return velocities_; }
  const LiveArray& efforts() const { return efforts_; }
  const LiveArray& poses() const { return poses_; }
  const LiveArray& bodyVelocities() const { return body_velocities_; }
  pybind11::array contacts();
  pybind11::dict sensors();
  std::vector<std::string> sensorFields(const std::string& sensor) const;
  std::unique_ptr<SimulationClearance> clearance(const std::string& robot);

  void command(const std::string& robot, const CommandArguments& arguments);
  /** @param points velocities may be None; efforts are not taken @param start [s] simulated; 0: now */
  void commandTrajectory(const std::string& robot, const pybind11::object& times, const CommandArguments& points, double start);
  void setJointPositions(const std::string& robot, const pybind11::object& positions, const pybind11::object& joints);
  void applyEffort(const std::string& joint, double effort, double duration);
  void applyWrench(const std::string& body, const sim::BodyLoad& load, double duration);
  void clearEfforts(const std::string& joint);
  void clearWrenches(const std::string& body);

 private:
  void stepWhileAllowed(std::int64_t count);
  /** Writes what the simulator's report says into the arrays. */
  void show();
  void showBodies();
  /** Calls this in the thread's turn, then shows what it changed. */
  void change(const std::function<void()>& call);
  int bodyIndex(const std::string& name) const;
  int worldJoint(const std::string& name) const;

  std::unique_ptr<sim::Simulator> simulator_;
  std::mutex turn_;
  std::uint32_t status_ = 0;
  std::vector<std::string> joint_names_, body_names_;
  std::vector<int> joints_, bodies_;  // of the world, in the order of the names
  std::vector<int> rows_;             // of a body of the world in body_names_, or -1
  std::vector<std::optional<sim::SensorReading>> readings_;
  LiveArray positions_, velocities_, efforts_, poses_, body_velocities_;
};

}  // namespace blem_sim::python
