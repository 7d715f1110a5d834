#include "services/state_services.h"

#include <blem_sim/RestoreState.h>
#include <blem_sim/SaveState.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/state_file.h"

namespace blem_sim {

namespace {

template <typename Response>
void describeState(const Simulator& simulator, const std::string& text, Response* response) {
  response->status_message = text;
  response->step = simulator.steps();
  response->state_hash = simulator.stateHash();
}

}  // namespace

StateServices::StateServices(const ros::NodeHandle& private_node, SimulationLoop* loop, const FileRoots& roots)
    : loop_(loop), roots_(roots), services_(private_node) {
  services_.add<SaveState>("save_state", [this](const auto& request, auto* response) {
    const std::string file = allowed(request.file);
    saveState(loop_->simulator().save(), file);
    describeState(loop_->simulator(), "saved " + file, response);
  });
  services_.add<RestoreState>("restore_state", [this](const auto& request, auto* response) {
    const std::string file = allowed(request.file);
    const SimulationState state = loadState(file);
    loop_->restore(state);
    describeState(loop_->simulator(), "restored " + file, response);
  });
}

std::string StateServices::allowed(const std::string& file) const {
  if (file.empty()) throw InputError("file: is empty; give a path");
  const std::string& folder = loop_->simulator().config().base_directory;
  const std::string path = file.front() == '/' || folder.empty() ? file : folder + "/" + file;
  roots_.require(path);
  return path;
}

}  // namespace blem_sim
