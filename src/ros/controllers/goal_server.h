// An action whose newest goal is the only one.
#pragma once

#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>

#include <string>

#include "loop/refusals.h"
#include "sending/publish_schedule.h"

namespace blem_sim::node {

/** Name of an action, how often it tells feedback, and where its refused goals are counted. */
struct ActionSettings {
  ros::NodeHandle node;
  std::string name;          ///< below the node's
  double feedback_rate = 0;  ///< [1/s simulated]
  Refusals* refusals;        ///< lives longer than the action
};

/** Keeps the active goal of an action of one type, and ends it once. Refused goals are told and counted by the action's name. */
template <typename Action>
class GoalServer {
 public:
  using Server = actionlib::ActionServer<Action>;
  using Handle = typename Server::GoalHandle;
  using Result = typename Action::_action_result_type::_result_type;
  using Feedback = typename Action::_action_feedback_type::_feedback_type;

  /** @param take gets each goal, and rejects it or makes it active @param cancel is called when the active goal is cancelled */
  template <typename Take, typename Cancel>
  GoalServer(const ActionSettings& settings, Take take, Cancel cancel)
      : name_(settings.node.resolveName(settings.name)),
        refusals_(settings.refusals),
        feedback_schedule_(settings.feedback_rate),
        server_(
            settings.node, settings.name, [take](Handle goal) { take(goal); },
            [this, cancel](Handle goal) {
              if (active_ && goal == goal_) cancel();
            },
            false) {
    server_.start();
  }

  const std::string& name() const { return name_; }
  bool active() const { return active_; }

  /** Makes a goal the active one; the one before ends as pre-empted. */
  void activate(Handle goal) {
    preempt(Result(), "a new goal came");
    goal.setAccepted();
    goal_ = goal;
    active_ = true;
    feedback_schedule_.restart();
  }
  void reject(Handle* goal, const Result& result, const std::string& why) {
    goal->setRejected(result, why);
    refusals_->add(name_, "goal refused", why);
  }
  void preempt(const Result& result, const std::string& why) {
    if (release()) goal_.setCanceled(result, why);
  }
  void succeed(const Result& result) {
    if (release()) goal_.setSucceeded(result);
  }
  void abort(const Result& result, const std::string& why) {
    if (release()) goal_.setAborted(result, why);
  }

  /** True if the active goal is due a feedback. @param time [s] simulated */
  bool feedbackDue(double time) { return active_ && feedback_schedule_.due(time); }
  void publish(const Feedback& feedback) { goal_.publishFeedback(feedback); }
  void restartTime() { feedback_schedule_.restart(); }

 private:
  bool release() {
    const bool was_active = active_;
    active_ = false;
    return was_active;
  }

  std::string name_;
  Refusals* refusals_;
  PublishSchedule feedback_schedule_;
  bool active_ = false;
  Handle goal_;
  Server server_;  // last: it uses the others
};

}  // namespace blem_sim::node
