// Interface of publishers, which the simulation loop calls after each step; one family of topics each.
#pragma once

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

class StepPublisher {
 public:
  virtual ~StepPublisher() = default;
  /** Called after every step, and once with the state at hand when the node is ready or time has started again. */
  virtual void publish(const sim::StepReport& report) = 0;
  /** Returns when messages of earlier steps are published that are made beside the steps. */
  virtual void drain() {}
  /** Called when simulated time starts again at 0. */
  virtual void timeRestarted() {}
  /** Called when steps are about to be made again after a pause: measurements on the wall clock start anew. */
  virtual void resumed() {}
  /** Called when models came or went; all messages about those that went are out. @throws InputError: a name that clashes */
  virtual void modelsChanged() {}
  /** Called now and then while live environments are exchanged for others. */
  virtual void cloudsChanged() {}
};

}  // namespace blem_sim::node
