// Joint commands that are dated to a step.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

/**
 * Keeps commands whose stamp lies in the future until the step that starts then, so that it does not matter when they came. Those of one
 * stamp are given in the order they came. They are no part of a saved state.
 */
class StampedCommands {
 public:
  static constexpr std::size_t MOST = 10000;      ///< that wait at once
  static constexpr double FARTHEST_AHEAD = 3600;  ///< [s]

  explicit StampedCommands(sim::Simulator* simulator) : simulator_(*simulator) {}

  /** Changes nothing. @param stamp [s] simulated @throws InputError as give would */
  void check(int robot, const sim::JointCommandMessage& command, double stamp) const;
  /** Gives a command now if its stamp is not beyond the step to come, else in its step. @throws InputError: nothing is kept then */
  void give(int robot, const sim::JointCommandMessage& command, double stamp);
  /** Gives what is due in the step that starts now. A robot that is gone takes no commands. */
  void giveDue();
  void clear() { waiting_.clear(); }

 private:
  struct Waiting {
    std::string robot;
    sim::JointCommandMessage command;
  };
  bool isDue(double stamp) const;

  sim::Simulator& simulator_;
  std::multimap<double, Waiting> waiting_;  // by stamp [s]
};

}  // namespace blem_sim::node
