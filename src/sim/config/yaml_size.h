#pragma once

#include <string>

namespace blem_sim::sim {

/**
 * Reads a YAML text's lists and maps without building any node, which would take kilobytes for each.
 * @throws InputError in one line (file:line, path of the key, cure) as soon as one of them has more than MOST_MODELS entries: no simulation
 * needs as many. YAML::ParserException if it is no YAML.
 * @param file that has the text, for messages
 */
void checkYamlSize(const std::string& text, const std::string& file);

}  // namespace blem_sim::sim
