// Fewer samples and shorter runs under the sanitizers, which make everything some thirty times slower and look at code that the release
// tests run in full.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace blem_sim {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool SANITIZED = true;
#else
constexpr bool SANITIZED = false;
#endif

/** Number of samples of a search that takes `full` without sanitizers: an eighth with them; else the environment variable BLEM_SIM_SAMPLES
 *  multiplies them. */
inline int samples(int full) {
  const char* set = std::getenv("BLEM_SIM_SAMPLES");
  const int times = set && std::atoi(set) > 0 ? std::atoi(set) : 1;
  return SANITIZED ? std::max(1, full / 8) : times * full;
}

}  // namespace blem_sim
