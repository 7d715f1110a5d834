// A record played again, without a node.
#pragma once

#include <cstdint>
#include <string>

namespace blem_sim::node {

/** Outcome of a replay. */
struct ReplayResult {
  std::uint64_t steps = 0, inputs = 0;
  std::uint64_t hash = 0;  ///< of the last step
  std::string difference;  ///< empty: every step had the recorded hash; else the first that had not, in words
};

/**
 * Gives a fresh simulation the inputs of a record, each before its step, and stops at the first step whose hash is another.
 * @throws InputError in one line: the file is no record, was cut short or changed, is another version's, or its models cannot be loaded
 */
ReplayResult replay(const std::string& file);

}  // namespace blem_sim::node
