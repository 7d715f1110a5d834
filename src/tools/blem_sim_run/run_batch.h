// --batch: many runs in one process.
#pragma once

#include "options.h"

namespace blem_sim {

enum ExitStatus { FINISHED = 0, FAILED = 1, BAD_INPUT = 2, NOT_FINITE = 3 };

/**
 * Makes the runs of options.batch one after the other and writes a line for each: its report, or why it was refused. A signal ends the
 * batch after a step, and then the program. @throws InputError: the batch cannot be read, or the results cannot be written
 */
ExitStatus runBatch(const RunOptions& options);

}  // namespace blem_sim
