// Names that a user may have mistyped.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::sim {

/** A name as messages show it: its first 200 characters, in one line. */
std::string shownName(const std::string& name);

/** The known name with the fewest edits from `name`, the first of them on a tie; empty if none is known. Its
 * first 200 characters count. [Levenshtein 1966] */
std::string nearestName(const std::string& name, const std::vector<std::string>& known);

/** @throws InputError "WHERE: no KIND 'name'; the nearest is 'other'" unless `name` is one of `known` */
void requireName(const std::string& name, const std::vector<std::string>& known, const std::string& where, const std::string& kind);

}  // namespace blem_sim::sim
