// Files that are there as a whole or not at all.
#pragma once

#include <string>

namespace blem_sim::sim {

/**
 * Writes bytes into FILE.part, sees them onto the disk and renames: after a crash or a power cut the file has its old content or the new
 * one. @throws InputError in one line with the system's reason; the old file stays then, and what is no file is left alone
 */
void writeWhole(const std::string& file, const std::string& bytes);

}  // namespace blem_sim::sim
