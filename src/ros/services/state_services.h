#pragma once

#include <string>

#include "loop/simulation_loop.h"
#include "services/service_group.h"

namespace blem_sim {

/** `~save_state`, `~restore_state`, of files below the folders that services may use. */
class StateServices {
 public:
  /** @param roots of files that the services may read and write */
  StateServices(const ros::NodeHandle& private_node, SimulationLoop* loop, const FileRoots& roots);

 private:
  /** Path of a file that the services may use. @throws InputError */
  std::string allowed(const std::string& file) const;

  SimulationLoop* loop_;
  FileRoots roots_;
  ServiceGroup services_;
};

}  // namespace blem_sim
