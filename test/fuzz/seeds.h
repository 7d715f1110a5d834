// Seeds of fuzz targets, and bytes near them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace blem_sim {

using FuzzTarget = void (*)(const std::uint8_t*, std::size_t);

constexpr std::uintmax_t LARGEST_SEED = 1 << 16;  // [bytes]

/** Files of a target, in order: found ones, the repository's, and the shared spoiled ones where they are. */
inline std::vector<std::filesystem::path> seedsOf(const std::string& target) {
  const std::filesystem::path root = BLEM_SIM_SOURCE_DIR;
  std::vector<std::filesystem::path> seeds;
  for (const auto& folder : {root / "test/fuzz/seeds" / target, root / "test/data", root / "urdf", root / "meshes", root / "config",
                             root / "../shared/data/pathological"}) {
    if (!std::filesystem::is_directory(folder)) continue;
    const bool found = folder.filename() == target;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.is_regular_file() && entry.file_size() <= LARGEST_SEED && (found || entry.path().extension() == "." + target))
        seeds.push_back(entry.path());
  }
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

inline std::string bytesOf(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

inline void runTarget(FuzzTarget target, const std::string& bytes) {
  target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

/** The bytes with a few of them changed, or cut short. */
inline std::string spoiled(std::string bytes, std::mt19937* random) {
  if (bytes.empty()) return bytes;
  if ((*random)() % 4 == 0) bytes.resize((*random)() % bytes.size());
  for (std::size_t i = 0, flips = 1 + (*random)() % 4; i < flips && !bytes.empty(); ++i)
    bytes[(*random)() % bytes.size()] = static_cast<char>((*random)());
  return bytes;
}

/** Gives a target its seeds and their neighbours. A finding ends the program. */
inline void runSeeds(const std::string& name, FuzzTarget target) {
  constexpr int NEIGHBOURS = 50;
  std::mt19937 random(1);
  const auto seeds = seedsOf(name);
  for (const auto& seed : seeds) {
    const std::string bytes = bytesOf(seed);
    runTarget(target, bytes);
    for (int i = 0; i < NEIGHBOURS; ++i) runTarget(target, spoiled(bytes, &random));
  }
  EXPECT_FALSE(seeds.empty());
}

}  // namespace blem_sim
