// <transmission> blocks of a URDF, which urdfdom leaves out.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/model/robot_model.h"

namespace tinyxml2 {
class XMLElement;
}

namespace blem_sim::model {

/**
 * Transmissions of a <robot>, in the file's order, as ros_control writes them and as PR2 does. One that names no joint of the robot is left
 * out with a note.
 * @param source names the text in messages. @throws InputError for a reduction or an offset that is no finite number, or a reduction of 0
 */
std::vector<Transmission> readTransmissions(const tinyxml2::XMLElement& robot, const std::vector<std::string>& joints,
                                            const std::string& source, std::vector<std::string>* notes);

}  // namespace blem_sim::model
