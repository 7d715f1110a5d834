// Paths of the shared robots, scans and worlds, if they are on this machine.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace blem_sim {

/** Path of a file or folder below the shared data (environment variable BLEM_SIM_SHARED_DATA, else ../shared/data beside the sources). */
inline std::optional<std::string> sharedData(const std::string& relative = "") {
  const char* set = std::getenv("BLEM_SIM_SHARED_DATA");
  const std::filesystem::path root = set ? set : std::filesystem::path(BLEM_SIM_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path path = (root / relative).lexically_normal();
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path.string();
}

}  // namespace blem_sim

/** Ends a test in words where the shared data are missing. */
#define SKIP_WITHOUT_SHARED_DATA(path) \
  if (!blem_sim::sharedData(path)) GTEST_SKIP() << "shared data not found: " << (path) << " (set BLEM_SIM_SHARED_DATA to its folder)"
