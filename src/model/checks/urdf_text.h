// The part of a URDF that is simulated, as urdfdom reads it without stumbling.
#pragma once

#include <tinyxml2.h>

#include <string>

namespace blem_sim::model {

/**
 * Text of a URDF without what is only drawn (<visual>, <material>), and with numbers that single spaces part. urdfdom leaves out all of a
 * link behind a <visual> that it cannot read, its collisions too, and stumbles over white space behind a number.
 * @param urdf the text as it was read; loses these parts. A text without them comes back as it is
 */
std::string simulatedText(const std::string& xml, tinyxml2::XMLDocument* urdf);

}  // namespace blem_sim::model
