// Errors of a URDF that urdfdom swallows or reports badly: its text is checked before urdfdom reads it.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/model/robot_model.h"

namespace blem_sim::model {

/** Names in the file's order (urdfdom sorts them) and notes on blocks left out of the simulation. */
struct UrdfOutline {
  std::vector<std::string> links;
  std::vector<std::string> joints;
  std::vector<Transmission> transmissions;
  std::vector<GazeboBlock> gazebo;
  std::vector<std::string> notes;
  std::string simulated;  ///< the text that urdfdom shall read
};

/**
 * @param source names the text in messages.
 * @throws InputError with the link or joint and the cure: not XML, no robot, unexpanded xacro, names missing or given twice, numbers that
 * are missing or not finite, masses below zero, unknown joint types, missing limits, unknown or cyclic mimic joints, parents or children
 * that do not exist, loops, several roots.
 */
UrdfOutline checkUrdf(const std::string& xml, const std::string& source);

}  // namespace blem_sim::model
