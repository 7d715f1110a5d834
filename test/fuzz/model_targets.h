// Readers of files, given bytes that nobody vouches for: what they cannot use they refuse by InputError, in one line.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/model/loaders.h"

namespace blem_sim {

/** Ends the program, as a finding: an error is of another kind, or has several lines. */
[[noreturn]] inline void tellFinding(const std::string& what) {
  std::fprintf(stderr, "finding: %s\n", what.c_str());
  std::abort();
}

template <typename Read>
void expectReadOrRefused(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const std::string line = error.what();
    if (line.empty() || line.find('\n') != std::string::npos) tellFinding("an error that is not one line: " + line);
  } catch (const std::exception& error) {
    tellFinding(std::string("an error that is no InputError: ") + error.what());
  }
}

/** Writes the bytes into a file of this process with that ending. */
inline std::string fuzzFile(const std::uint8_t* data, std::size_t size, const std::string& ending) {
  static const std::string stem = std::filesystem::temp_directory_path() / ("blem_sim_fuzz_" + std::to_string(::getpid()));
  std::ofstream(stem + ending, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return stem + ending;
}

/** Reads the bytes as a surface's file of that ending. */
inline void fuzzSurface(const std::uint8_t* data, std::size_t size, const std::string& ending) {
  const std::string file = fuzzFile(data, size, ending);
  expectReadOrRefused([&] { model::loadSurface(file); });
  std::filesystem::remove(file);
}

inline void fuzzStl(const std::uint8_t* data, std::size_t size) { fuzzSurface(data, size, ".stl"); }
inline void fuzzPly(const std::uint8_t* data, std::size_t size) { fuzzSurface(data, size, ".ply"); }
inline void fuzzObj(const std::uint8_t* data, std::size_t size) { fuzzSurface(data, size, ".obj"); }
inline void fuzzOff(const std::uint8_t* data, std::size_t size) { fuzzSurface(data, size, ".off"); }
inline void fuzzPcd(const std::uint8_t* data, std::size_t size) { fuzzSurface(data, size, ".pcd"); }

inline void fuzzUrdf(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  expectReadOrRefused([&] { model::loadUrdf(text, "fuzz.urdf", model::UriResolver()); });
}

}  // namespace blem_sim
