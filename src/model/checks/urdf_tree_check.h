// Check that links and joints of a URDF form one tree.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::model {

/** A joint by names, as the file gives it. */
struct JointOutline {
  std::string name, type, parent, child;
  std::string mimic;  ///< empty: none
};

/** @throws InputError for names missing or given twice, unknown links, links with two parents, loops, several roots, bad mimic joints. */
void checkTree(const std::vector<std::string>& links, const std::vector<JointOutline>& joints, const std::string& source);

}  // namespace blem_sim::model
