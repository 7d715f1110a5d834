// Files that services may read and write.
#pragma once

#include <string>

#include "blem_sim/model/loaders.h"

namespace blem_sim::node {

class ServiceFiles {
 public:
  /** @param roots folders of the files @param folder that relative paths are meant against; empty: the node's own */
  ServiceFiles(const model::FileRoots& roots, const std::string& folder) : roots_(roots), folder_(folder) {}

  /** Path of a file. @throws InputError if services may not use it */
  std::string allowed(const std::string& file) const;

 private:
  model::FileRoots roots_;
  std::string folder_;
};

}  // namespace blem_sim::node
