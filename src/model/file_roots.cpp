#include "blem_sim/model/file_roots.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::model {
namespace {

namespace fs = std::filesystem;

constexpr int MOST_LINKS = 40;  // in a row, as Linux follows them

/** Target of a link that leads to no file yet: whoever writes through it makes that file. */
fs::path writtenAt(fs::path path) {
  std::error_code error;
  for (int links = 0; links < MOST_LINKS && fs::is_symlink(fs::symlink_status(path, error)) && !fs::exists(path, error); ++links)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

/** Path without links, dots and a slash at its end; empty if it cannot be followed. */
fs::path followed(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(writtenAt(fs::absolute(path, error)), error);
  if (error) return {};
  return whole.has_filename() ? whole : whole.parent_path();
}

bool isBelow(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

FileRoots::FileRoots(std::vector<std::string> folders) {
  for (const std::string& folder : folders) {
    const fs::path path = folder.empty() ? fs::path() : followed(folder);
    if (!path.empty()) folders_.push_back(path.string());
  }
}

void FileRoots::require(const std::string& path) const {
  const fs::path file = followed(path);
  const auto holds = [&](const std::string& folder) { return isBelow(file, folder); };
  if (!file.empty() && std::any_of(folders_.begin(), folders_.end(), holds)) return;
  if (folders_.empty())
    throw InputError(fmt::format("'{}': services read and write no files; set allow_file_services and file_roots", path));
  throw InputError(fmt::format("'{}': is not below a folder that services may use ({}); move it, or add its folder to file_roots", path,
                               fmt::join(folders_, ", ")));
}

}  // namespace blem_sim::model
