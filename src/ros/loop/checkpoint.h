// States kept now and then, from which a node that was killed goes on.
#pragma once

#include <string>

#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/** From now on checkpoints stay when the node ends. May be called by a signal's handler. */
void keepCheckpoints();

/** Writes the state into a file every checkpoint_period; a node that ends in order takes the file away, but for
 *  keepCheckpoints(). */
class Checkpoint : public StepPublisher {
 public:
  /** Goes on from the file, if it is there. One that does not fit is put aside as FILE.refused. @param file absolute */
  Checkpoint(sim::Simulator* simulator, const std::string& file);
  ~Checkpoint() override;

  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  void goOn();

  sim::Simulator* simulator_;
  std::string file_;
  PublishSchedule schedule_;
};

}  // namespace blem_sim::node
