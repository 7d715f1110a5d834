#pragma once

#include <string>

namespace blem_sim::sim {

/**
 * A YAML text with the same meaning that every yaml-cpp ends with: 0.6.2 (Ubuntu 20.04) takes all memory at a colon inside of brackets or
 * braces that the text's end or a ] follows, so a space is put there.
 * @throws YAML::ParserException if the control character 4 is in it, which yaml-cpp takes for an end
 */
std::string endingYaml(const std::string& text);

}  // namespace blem_sim::sim
