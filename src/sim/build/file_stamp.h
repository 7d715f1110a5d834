// Time and size of a file, by which a change of it shows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

namespace blem_sim::sim {

struct FileStamp {
  std::filesystem::file_time_type written;
  std::uintmax_t bytes = 0;

  bool operator==(const FileStamp& other) const { return written == other.written && bytes == other.bytes; }
  bool operator!=(const FileStamp& other) const { return !(*this == other); }
};

/** Stamp of a file; what is no file has always the same. */
inline FileStamp stampOf(const std::string& file) {
  std::error_code failed;
  FileStamp stamp;
  stamp.written = std::filesystem::last_write_time(file, failed);
  if (!failed) stamp.bytes = std::filesystem::file_size(file, failed);
  return failed ? FileStamp() : stamp;
}

}  // namespace blem_sim::sim
