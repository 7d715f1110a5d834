// Folders that files may come from and go to.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::model {

/** Rule for files that others name: below these folders alone, wherever links lead. */
class FileRoots {
 public:
  /** @param folders that exist; others allow nothing. None: no file is allowed */
  explicit FileRoots(std::vector<std::string> folders);

  /** @param path of a file, whether it exists or not @throws InputError that names the folders, if it is not below one of them */
  void require(const std::string& path) const;

 private:
  std::vector<std::string> folders_;  // without links
};

}  // namespace blem_sim::model
