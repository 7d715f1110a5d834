#include "publishers/reports/step_report_publisher.h"

#include <blem_sim/StepReport.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "messages/conversions.h"
#include "messages/status_text.h"

namespace blem_sim::node {

namespace {
constexpr int REPORT_QUEUE = 100;
}

StepReportPublisher::StepReportPublisher(ros::NodeHandle private_node, SimulationLoop* loop)
    : loop_(*loop),
      simulator_(loop->simulator()),
      schedule_(simulator_.config().rates.step_report),
      publisher_(ListenedPublisher::advertise<blem_sim::StepReport>(&private_node, "step_report", REPORT_QUEUE)),
      sender_(loop->sender()) {}

void StepReportPublisher::timeRestarted() {
  schedule_.restart();
  collector_.take();
  collector_.resume();
}

void StepReportPublisher::publish(const sim::StepReport& report) {
  collector_.add(report);
  if (!schedule_.due(report.time)) return;
  const StepStatistics statistics = collector_.take();
  // Publishing time up to the step before; this step's messages are still going out.
  const double published = loop_.publishingTime().wall, publishing = published - std::exchange(published_, published);
  if (!publisher_.listened()) return;
  const auto sent = boost::make_shared<blem_sim::StepReport>();
  blem_sim::StepReport& message = *sent;
  message.header.stamp = toStamp(report.time);
  message.step = report.step;
  message.steps = statistics.steps;
  message.state_hash = simulator_.stateHash();
  message.time_step = simulator_.config().time_step;
  message.status = statistics.status;
  message.status_names = statusNames(statistics.status);
  message.real_time_factor = statistics.realTimeFactor();
  message.substeps = report.substeps;
  message.raw_contacts = report.raw_contacts;
  message.reduced_contacts = report.reduced_contacts;
  message.wrench_error = statistics.wrench_error;
  message.max_depth = statistics.max_depth;
  message.max_of_layer = statistics.max_of_layer;
  if (statistics.deepest_a >= 0) message.deepest_a = simulator_.colliders()[statistics.deepest_a].name;
  if (statistics.deepest_b >= 0) message.deepest_b = simulator_.colliders()[statistics.deepest_b].name;
  message.energy = report.energy;
  message.energy_gained = statistics.energy_gained;
  message.solver_residual = statistics.solver_residual;
  message.solver_creep = statistics.solver_creep;
  message.solver_iterations = static_cast<double>(statistics.solver_iterations) / statistics.steps;
  for (std::size_t i = 0; i < statistics.stage_seconds.size(); ++i) {
    message.stages.emplace_back(sim::STAGE_NAMES[i]);
    message.stage_seconds.push_back(statistics.stage_seconds[i] / statistics.steps);
  }
  message.stages.emplace_back("publish");
  message.stage_seconds.push_back(publishing / statistics.steps);
  sender_->add(&publisher_, sent);
}

}  // namespace blem_sim::node
