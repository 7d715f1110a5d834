#include "publishers/reports/diagnostics_publisher.h"

#include <algorithm>
#include <numeric>

#include "messages/status_text.h"

namespace blem_sim::node {

namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double SLOW = 0.9;  // of the real-time factor asked for

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace

DiagnosticsPublisher::DiagnosticsPublisher(ros::NodeHandle node, ros::NodeHandle private_node, SimulationLoop* loop)
    : loop_(*loop), simulator_(loop->simulator()), updater_(node, private_node), next_(std::chrono::steady_clock::now()) {
  updater_.setHardwareID("none");
  updater_.add("simulation speed", [this](DiagnosticStatusWrapper& status) { describeSpeed(status); });
  updater_.add("contacts", [this](DiagnosticStatusWrapper& status) { describeContacts(status); });
}

void DiagnosticsPublisher::add(const std::string& name, std::function<void(DiagnosticStatusWrapper&)> describe) {
  updater_.add(name, describe);
}

void DiagnosticsPublisher::timeRestarted() {
  collector_.take();
  collector_.resume();
  energy_gained_ = 0;
  contacts_left_ = 0;
}

void DiagnosticsPublisher::serve(bool paused) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = std::max(next_ + std::chrono::seconds(1), now);
  paused_ = paused;
  statistics_ = collector_.take();
  const PublishingTime published = loop_.publishingTime();
  publishing_time_ = {published.wall - published_.wall, published.processor - published_.processor};
  published_ = published;
  energy_gained_ += statistics_.energy_gained;
  contacts_left_ += statistics_.contacts_left;
  updater_.force_update();
}

void DiagnosticsPublisher::describeSpeed(DiagnosticStatusWrapper& status) const {
  const double asked = simulator_.config().real_time_factor;
  const double reached = statistics_.realTimeFactor();
  const auto slowest = std::max_element(statistics_.stage_seconds.begin(), statistics_.stage_seconds.end());
  const char* stage = sim::STAGE_NAMES[slowest - statistics_.stage_seconds.begin()];
  if (paused_ || statistics_.steps == 0) {
    status.summary(DiagnosticStatus::OK, paused_ ? "paused" : "no step in the last second");
  } else if (asked > 0 && reached < SLOW * asked) {
    status.summaryf(DiagnosticStatus::WARN,
                    "%.2f of real time instead of %.2f, most of it in %s: fewer contacts, coarser meshes or a larger time_step", reached,
                    asked, stage);
  } else {
    status.summaryf(DiagnosticStatus::OK, "%.2f of real time", reached);
  }
  status.addf("real_time_factor", "%.4f", reached);
  status.addf("real_time_factor asked (0 = as fast as possible)", "%.4f", asked);
  status.addf("steps in the last second", "%u", statistics_.steps);
  status.addf("simulated time [s]", "%.3f", simulator_.time());
  const double steps = std::max(1U, statistics_.steps);
  const double computed = std::accumulate(statistics_.stage_seconds.begin(), statistics_.stage_seconds.end(), 0.0);
  status.addf("mean computing time per step [ms]", "%.4f", 1e3 * computed / steps);
  for (std::size_t i = 0; i < statistics_.stage_seconds.size(); ++i) {
    status.addf(std::string("stage ") + sim::STAGE_NAMES[i] + " [ms]", "%.4f", 1e3 * statistics_.stage_seconds[i] / steps);
  }
  status.addf("publishing [ms]", "%.4f", 1e3 * publishing_time_.wall / steps);
  status.addf("publishing, processor time [ms]", "%.4f", 1e3 * publishing_time_.processor / steps);
}

void DiagnosticsPublisher::describeContacts(DiagnosticStatusWrapper& status) const {
  const sim::StepReport& report = simulator_.report();
  const std::uint32_t bits = statistics_.status;
  if ((bits & sim::STATE_NOT_FINITE) != 0) {
    status.summary(DiagnosticStatus::ERROR, joined(statusAdvice(sim::STATE_NOT_FINITE)));
  } else if ((bits & (sim::CONTACT_UNRELIABLE | sim::SOLVER_TROUBLE | sim::STEP_SHORTENED | sim::ENERGY_GAINED | sim::MOTION_TOO_FAST)) !=
             0) {
    status.summary(DiagnosticStatus::WARN, joined(statusAdvice(bits)));
  } else {
    const std::string advice = joined(statusAdvice(bits));
    status.summary(DiagnosticStatus::OK, advice.empty() ? "within the boundary layers" : advice);
  }
  const auto outside = std::count_if(report.contacts.begin(), report.contacts.end(),
                                     [](const sim::ContactReport& contact) { return contact.pierced || contact.of_layer > 1; });
  status.addf("contacts", "%d", report.reduced_contacts);
  status.addf("contacts before reduction", "%d", report.raw_contacts);
  status.addf("wrench off by contacts left out in the last second, at most, of the normal force", "%.4f", statistics_.wrench_error);
  status.addf("contacts outside the boundary layers", "%d", static_cast<int>(outside));
  status.addf("steps with such contacts in the last second", "%u", statistics_.unreliable_steps);
  status.addf("deepest contact in the last second [m]", "%.6f", statistics_.max_depth);
  status.addf("the same, of its boundary layers", "%.4f", statistics_.max_of_layer);
  if (statistics_.deepest_a >= 0 && statistics_.deepest_b >= 0) {
    status.add("between",
               simulator_.colliders()[statistics_.deepest_a].name + " and " + simulator_.colliders()[statistics_.deepest_b].name);
  }
  status.add("times that contacts left their boundary layers since the start", contacts_left_);
  status.addf("energy [J]", "%.6f", report.energy);
  status.addf("energy gained out of nothing since the start [J]", "%.6g", energy_gained_);
  status.add("status", joined(statusNames(bits)));
}

}  // namespace blem_sim::node
