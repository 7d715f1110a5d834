// RUNS.jsonl of --batch: a run per line, as a JSON object.
#pragma once

#include <string>
#include <vector>

#include "options.h"

namespace blem_sim {

/** A line: the command line's options with those of the line. */
struct BatchRun {
  RunOptions options;
  std::string refusal;  ///< file:line, field, fault and cure; empty: none
};

/**
 * Reads options.batch. Names, and files that are written, differ from line to line; a line that breaks this is refused like a malformed
 * one. @throws InputError: the file cannot be read, is empty, too long, or has no JSON object at all
 */
std::vector<BatchRun> readBatch(const RunOptions& options);

}  // namespace blem_sim
