// Where the sanitizers make everything some thirty times slower, long searches take fewer samples.
#pragma once

#include <algorithm>

namespace blem_sim {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool SANITIZED = true;
#else
constexpr bool SANITIZED = false;
#endif

/** How many samples a search takes of those it takes without sanitizers. */
constexpr int samples(int full) { return SANITIZED ? std::max(1, full / 8) : full; }

}  // namespace blem_sim
