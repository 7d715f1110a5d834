// --set: one parameter of a YAML document replaced before it is read.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace blem_sim {

/**
 * Sets `path` ("contact.friction", "robots.0.gains.default.p" or "robots[0]...") to `value`, itself YAML. Maps that are missing are
 * made; list items are not. @throws InputError
 */
void overrideSetting(YAML::Node* root, const std::string& path, const std::string& value);

}  // namespace blem_sim
