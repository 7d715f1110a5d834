// A folder for one test's files, removed at its end.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace blem_sim {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "blem_sim_XXXXXX").string();
    if (!mkdtemp(&name[0])) std::abort();
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& relative = "") const { return relative.empty() ? path_.string() : (path_ / relative).string(); }

  /** Writes a file, folders included. @return its path */
  std::string write(const std::string& relative, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / relative).parent_path());
    std::ofstream(path_ / relative, std::ios::binary) << bytes;
    return path(relative);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace blem_sim
