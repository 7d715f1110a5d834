// <gazebo> blocks of a URDF, which urdfdom leaves out.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/model/gazebo_blocks.h"

namespace tinyxml2 {
class XMLElement;
}

namespace blem_sim::model {

/**
 * Blocks of a <robot>, in the file's order. An attribute `value` is its element's text. Texts and names are cut where they are absurdly
 * long; elements that are too deep, and those beyond the most that are read, are left out with a note. Never throws.
 */
std::vector<GazeboBlock> readGazeboBlocks(const tinyxml2::XMLElement& robot, std::vector<std::string>* notes);

}  // namespace blem_sim::model
