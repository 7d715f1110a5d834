#pragma once

#include <string>

namespace blem_sim::sim {

/**
 * Reads a YAML file's lists and maps without building any node, which would take kilobytes for each.
 * @throws InputError in one line (file:line, path of the key, cure) as soon as one of them has more than MOST_MODELS entries: no simulation
 * needs as many. YAML::ParserException if it is no YAML. A file that cannot be read is left to its reader.
 */
void checkYamlSize(const std::string& file);

}  // namespace blem_sim::sim
