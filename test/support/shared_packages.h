// Package folders of the shared robots, as the README of the shared data names them.
#pragma once

#include <map>
#include <string>

#include "support/shared_data.h"

namespace blem_sim {

/** NAME -> folder; empty without the shared data. */
inline std::map<std::string, std::string> sharedPackages() {
  std::map<std::string, std::string> packages;
  for (const char* name : {"huboplus", "atlas", "pr2gripper", "tx90pr2", "tx90l"})
    if (const auto folder = sharedData(std::string("robots/klampt/") + name)) packages[name] = *folder;
  for (const char* name : {"example-robot-data", "robotiq_arg85_description"})
    if (const auto folder = sharedData(std::string("robots/") + name)) packages[name] = *folder;
  return packages;
}

}  // namespace blem_sim
