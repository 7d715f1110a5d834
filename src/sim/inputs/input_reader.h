// Arguments of a call, read from an input that nobody vouches for.
#pragma once

#include <limits>
#include <string>

#include "blem_sim/sim/simulator.h"
#include "blem_sim/sim/simulator_input.h"
#include "inputs/field_visitor.h"
#include "inputs/input_fields.h"

namespace blem_sim::sim {

/** Reads in the order of writing; throws InputError where arguments are missing, too many, or none that the simulation has. */
class InputReader : public FieldVisitor<InputReader> {
 public:
  InputReader(const SimulatorInput& input, const Simulator& simulator) : input_(input), simulator_(simulator) {}

  /** The next argument. */
  template <typename T>
  T take() {
    T value = T();
    (*this)(value);
    return value;
  }
  /** A position that can be commanded. */
  double takeCommand();
  /** Mass properties with an inertia that is symmetric. */
  geometry::MassProperties takeInertial();
  int takeRobot() { return takeIndex("robot", simulator_.robots().size()); }
  int takeJointOf(int robot) { return takeIndex("joint", simulator_.robots()[robot].joint_names.size()); }
  int takeSensor() { return takeIndex("sensor", simulator_.sensors().size()); }
  int takeModel();
  int takeBody();
  /** A joint of the world. */
  int takeJoint();
  /** A link of the body's robot; -1 for the body of an object. */
  int takeLinkOf(int body);
  /** Throws unless everything was read. */
  void finish() const;

  void number(double* value);
  void integer(int* value, int least = std::numeric_limits<int>::min(), int most = std::numeric_limits<int>::max());
  void text(std::string* value);
  void check(const Pose& pose) const;
  std::size_t count(std::size_t);

 private:
  [[noreturn]] void refuse(const std::string& why) const;
  int takeIndex(const char* kind, std::size_t count);

  const SimulatorInput& input_;
  const Simulator& simulator_;
  std::size_t texts_read_ = 0, numbers_read_ = 0;
};

}  // namespace blem_sim::sim
