#include "messages/contact_colour.h"

#include <algorithm>

namespace blem_sim {

std_msgs::ColorRGBA contactColour(const ContactReport& contact) {
  const bool outside = contact.pierced || contact.of_layer > 1;
  std_msgs::ColorRGBA colour;
  colour.r = outside ? 1.0F : static_cast<float>(0.9 * std::clamp(contact.of_layer, 0.0, 1.0));
  colour.g = outside ? 0.0F : 0.8F;
  colour.b = 0.1F;
  colour.a = 1;
  return colour;
}

}  // namespace blem_sim
