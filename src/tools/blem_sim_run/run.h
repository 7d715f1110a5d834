// One run from configuration to report.
#pragma once

#include <memory>
#include <ostream>

#include "blem_sim/sim/simulator.h"
#include "end_signal.h"
#include "options.h"

namespace blem_sim {

enum class RunEnd { FINISHED, NOT_FINITE, INTERRUPTED };

/** The batch that a run belongs to. */
struct BatchSide {
  std::ostream* result;                  ///< gets the report on one line, once everything else is written
  const EndSignal* signal;               ///< ends the run after a step
  std::unique_ptr<sim::Simulator> last;  ///< what it has loaded need not be loaded again
};

/**
 * Report and table end where the state stopped being finite or a signal came; a state is saved at a run's own end alone. @param batch null
 * for a single run, whose report goes to standard output unless options name a file @throws InputError
 */
RunEnd run(const RunOptions& options, BatchSide* batch);

}  // namespace blem_sim
