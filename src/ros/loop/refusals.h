// Messages that were refused: told in the log, counted in /diagnostics.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "blem_sim/geometry/input_error.h"
#include "loop/checked_transport.h"

namespace blem_sim::node {

/** Counts by topic. The log has the first lines of each second, so that a flood fills no disk. */
class Refusals {
 public:
  /** @param what happened, such as "command refused" */
  void add(const std::string& topic, const char* what, const std::string& why);
  /** Writes how many there were since the start, by topic; warns if some came since it was called last. */
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void tell(const std::string& line);

  std::map<std::string, std::uint64_t> counts_;
  std::uint64_t total_ = 0, described_ = 0, untold_ = 0;
  int told_ = 0;  // in the second at hand
  std::chrono::steady_clock::time_point next_second_;
  std::string last_;
};

/** Subscribes. A message that is none of the type, or that `act` throws InputError for, is refused. @param what the log then says */
template <typename Message, typename Act>
ros::Subscriber subscribeCounted(ros::NodeHandle node, const char* topic, const char* what, Refusals* refusals, Act act) {
  constexpr std::uint32_t QUEUE = 100;
  const std::string name = node.resolveName(topic);
  const boost::function<void(const boost::shared_ptr<const Message>&)> take = [name, what, refusals, act](const auto& message) {
    try {
      act(*message);
    } catch (const InputError& error) {
      refusals->add(name, what, error.what());
    }
  };
  ros::SubscribeOptions options =
      checkedSubscription<Message>(topic, QUEUE, take, [name, what, refusals](const std::string& why) { refusals->add(name, what, why); });
  return node.subscribe(options);
}

}  // namespace blem_sim::node
