// Checks that the mesh and cloud readers leave out: announced counts against the file's content, indices against their range.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::model {

/** Bytes of a file. @throws InputError if it is missing, unreadable or empty */
std::string readBytes(const std::string& file);

/** Refuses a truncated STL, binary or ASCII. Bytes beyond the announced triangles of a binary one are cut off, with a note. */
void checkStl(const std::string& file, std::string* bytes, std::vector<std::string>* notes);

/** Refuses an OFF whose header, rows or face indices are wrong. What was checked is left: without comments, one row each, the counts on
 *  a row of their own; another reader cannot take the rows otherwise. */
void checkOff(const std::string& file, std::string* bytes);

/** Refuses a COLLADA file that is not XML, or whose references and counts lead nowhere. */
void checkCollada(const std::string& file, const std::string& bytes);

/** Refuses a PCD too short for the points that its header announces. */
void checkPcd(const std::string& file, const std::string& bytes);

}  // namespace blem_sim::model
