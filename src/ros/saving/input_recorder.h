// Record of a running simulation.
#pragma once

#include <blem_sim/RecordedSteps.h>
#include <rosbag/bag.h>

#include <memory>
#include <string>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

/** Writes what decides a simulation's bits into a bag, as it is taken. A bag that cannot be written on is closed, and the log says why. */
class InputRecorder : public sim::SimulatorWatcher {
 public:
  /** @param configuration YAML that the simulation was loaded from, all that has changed since being part of its state */
  InputRecorder(sim::Simulator* simulator, const std::string& configuration);
  ~InputRecorder() override;

  /** Begins with the state at hand. @throws InputError: it records already, models are not those of the start, the file cannot be written
   */
  void start(const std::string& file);
  /** Ends the record. @return in words, its length @throws InputError if there is none, or its end cannot be written */
  std::string stop();
  /** Ends the record if there is one; what fails is logged. */
  void end();

  void told(const sim::SimulatorInput& input) override;
  void stepped() override;

 private:
  template <typename Message>
  void write(const char* topic, const Message& message);
  void writeSteps();
  /** Ends the record without its last message. */
  void giveUp(const char* why);
  /** Closes the bag. One that cannot write its end stays in memory: its destructor would write again, throw, and end the node.
   *  @return whether its end is written */
  bool closeBag();

  sim::Simulator* simulator_;
  std::string configuration_, first_layout_;
  std::string file_;                  // empty: nothing is recorded
  std::string given_up_;              // why the last record ended by itself
  std::unique_ptr<rosbag::Bag> bag_;  // while it records
  ros::Time last_stamp_;
  RecordedSteps steps_;  // that are not written yet
  std::uint64_t inputs_ = 0;
};

}  // namespace blem_sim::node
