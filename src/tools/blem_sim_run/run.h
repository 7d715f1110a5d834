// One run from configuration to report.
#pragma once

#include "options.h"

namespace blem_sim {

/** @return false if the state stopped being finite: the report then tells of the time until there @throws InputError */
bool run(const RunOptions& options);

}  // namespace blem_sim
