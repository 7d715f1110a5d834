// What the mesh and cloud readers do not check: announced counts against what the file holds, indices against their range.
#pragma once

#include <string>
#include <vector>

namespace blem_sim {

/** Bytes of a file and what was found out about them. @throws InputError if it is missing, unreadable or empty */
std::string readBytes(const std::string& file);

/** Refuses a truncated STL, binary or ASCII. Bytes beyond the announced triangles of a binary one are cut off, with a note. */
void checkStl(const std::string& file, std::string* bytes, std::vector<std::string>* notes);

/** Refuses an OFF whose header, rows or face indices are wrong. */
void checkOff(const std::string& file, const std::string& bytes);

/** What a PLY's header announces. */
struct PlyCounts {
  std::size_t vertices = 0;
  std::size_t faces = 0;
};

/** Refuses a PLY that cannot hold what its header announces. */
PlyCounts checkPly(const std::string& file, const std::string& bytes);

/** Refuses a COLLADA file that is not XML, or whose references and counts lead nowhere. */
void checkCollada(const std::string& file, const std::string& bytes);

/** Refuses a PCD that cannot hold what its header announces. */
void checkPcd(const std::string& file, const std::string& bytes);

}  // namespace blem_sim
