#include "loop/refusals.h"

#include <ros/console.h>

#include "blem_sim/geometry/one_line.h"

namespace blem_sim::node {

namespace {
constexpr int MOST_LINES = 20;             // told in a second
constexpr std::size_t LONGEST_LINE = 500;  // characters of a reason
}  // namespace

void Refusals::add(const std::string& topic, const char* what, const std::string& why) {
  ++counts_[topic];
  ++total_;
  last_ = topic + ": " + what + ": " + geometry::oneLine(why.substr(0, LONGEST_LINE));
  tell(last_);
}

void Refusals::tell(const std::string& line) {
  const auto now = std::chrono::steady_clock::now();  // simulated time may stand still
  if (now >= next_second_) {
    if (untold_ > 0) ROS_ERROR("%lu more messages were refused; /diagnostics counts them by topic", static_cast<unsigned long>(untold_));
    next_second_ = now + std::chrono::seconds(1);
    untold_ = 0;
    told_ = 0;
  }
  if (++told_ > MOST_LINES)
    ++untold_;
  else
    ROS_ERROR("%s", line.c_str());
}

void Refusals::describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (total_ == described_)
    status.summaryf(diagnostic_msgs::DiagnosticStatus::OK, "%lu since the start", static_cast<unsigned long>(total_));
  else
    status.summaryf(diagnostic_msgs::DiagnosticStatus::WARN, "%lu in the last second, the last: %s",
                    static_cast<unsigned long>(total_ - described_), last_.c_str());
  described_ = total_;
  for (const auto& [topic, count] : counts_) status.add(topic + " refused", count);
}

}  // namespace blem_sim::node
