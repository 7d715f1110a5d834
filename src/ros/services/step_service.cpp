#include "services/step_service.h"

#include "messages/conversions.h"
#include "messages/status_text.h"

namespace blem_sim::node {

StepService::StepService(const ros::NodeHandle& private_node, SimulationLoop* loop) : loop_(loop), services_(private_node) {
  services_.add<Step>("step", [this](const auto& request, auto* response) { step(request, response); });
}

void StepService::step(const Step::Request& request, Step::Response* response) {
  const std::uint32_t made = loop_->stepPaused(request.steps);
  const sim::StepReport& report = loop_->simulator().report();
  response->success = made == request.steps && (made == 0 || (report.status & sim::STATE_NOT_FINITE) == 0);
  if (!response->success) response->status_message = stoppedText(made, request.steps, report.status);
  response->step = loop_->simulator().steps();
  response->stamp = toStamp(loop_->simulator().time());
}

}  // namespace blem_sim::node
