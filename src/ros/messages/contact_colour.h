#pragma once

#include <std_msgs/ColorRGBA.h>

#include "blem_sim/sim/step_report.h"

namespace blem_sim {

/** Colour of a contact's markers: green at no depth, yellow where the boundary layers are used up, red beyond and where bare meshes cross.
 */
std_msgs::ColorRGBA contactColour(const ContactReport& contact);

}  // namespace blem_sim
