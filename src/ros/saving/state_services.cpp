#include "saving/state_services.h"

#include <blem_sim/RestoreState.h>
#include <blem_sim/SaveState.h>

#include "blem_sim/sim/state_file.h"

namespace blem_sim::node {

namespace {

template <typename Response>
void describeState(const sim::Simulator& simulator, const std::string& text, Response* response) {
  response->status_message = text;
  response->step = simulator.steps();
  response->state_hash = simulator.stateHash();
}

}  // namespace

StateServices::StateServices(const ros::NodeHandle& private_node, SimulationLoop* loop, const ServiceFiles& files)
    : services_(private_node) {
  services_.add<SaveState>("save_state", [loop, files](const auto& request, auto* response) {
    const std::string file = files.allowed(request.file);
    sim::saveState(loop->simulator().save(), file);
    describeState(loop->simulator(), "saved " + file, response);
  });
  services_.add<RestoreState>("restore_state", [loop, files](const auto& request, auto* response) {
    const std::string file = files.allowed(request.file);
    const sim::SimulationState state = sim::loadState(file);
    loop->restore(state);
    describeState(loop->simulator(), "restored " + file, response);
  });
}

}  // namespace blem_sim::node
