#include "sending/poll_rounds.h"

#include <ros/init.h>
#include <ros/poll_manager.h>

#include <chrono>

namespace blem_sim::node {

PollRounds& PollRounds::instance() {
  static PollRounds rounds;
  return rounds;
}

void PollRounds::watchBegin() {
  ros::PollManager::instance()->addPollThreadListener([this] { begin(); });
}

void PollRounds::watchEnd() {
  std::call_once(end_watched_, [this] {
    ros::PollManager::instance()->addPollThreadListener([this] { end(); });
    both_ends_ = true;
  });
}

std::unique_lock<std::recursive_timed_mutex> PollRounds::betweenHandOvers() {
  return {mutex_, std::chrono::milliseconds(ros::isShuttingDown() ? 0 : 100)};
}

void PollRounds::begin() {
  if (!both_ends_) return;
  mutex_.lock();
  held_ = true;
}

void PollRounds::end() {
  ++count_;
  if (!held_) return;
  held_ = false;
  mutex_.unlock();
}

}  // namespace blem_sim::node
