#include "loop/checkpoint.h"

#include <ros/console.h>

#include <atomic>
#include <filesystem>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/state_file.h"

namespace blem_sim::node {

namespace {
std::atomic<bool> checkpoints_stay{false};
}  // namespace

void keepCheckpoints() { checkpoints_stay = true; }

Checkpoint::Checkpoint(sim::Simulator* simulator, const std::string& file)
    : simulator_(simulator), file_(file), schedule_(1 / simulator->config().checkpoint_period) {
  std::error_code error;
  if (std::filesystem::exists(file_, error)) goOn();
  schedule_.due(simulator_->time());
}

Checkpoint::~Checkpoint() {
  if (checkpoints_stay) return;
  std::error_code error;
  std::filesystem::remove(file_, error);
}

void Checkpoint::goOn() {
  try {
    simulator_->restore(sim::loadState(file_));
    ROS_WARN("checkpoint_file: goes on at t = %.3f s from %s", simulator_->time(), file_.c_str());
  } catch (const InputError& refusal) {
    std::error_code error;
    std::filesystem::rename(file_, file_ + ".refused", error);
    ROS_ERROR("checkpoint_file: starts anew, %s.refused keeps what was there: %s", file_.c_str(), refusal.what());
  }
}

void Checkpoint::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time)) return;
  try {
    sim::saveState(simulator_->save(), file_);
  } catch (const InputError& refusal) {
    ROS_ERROR("checkpoint_file: %s", refusal.what());
  }
}

}  // namespace blem_sim::node
