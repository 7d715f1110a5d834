// A simulation's state in a file, every bit of it.
#pragma once

#include <string>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/** Content of a state's file: little-endian, the same on every machine. */
std::string stateBytes(const SimulationState& state);
/** @param source names the bytes in errors. @throws InputError if they are no whole state of blem_sim's */
SimulationState stateOf(const std::string& bytes, const std::string& source);

/** Writes beside the file, to the disk, and renames: what was there stays whole. @throws InputError if the file cannot be written */
void saveState(const SimulationState& state, const std::string& file);
/** @throws InputError if the file cannot be read, or is not one of blem_sim's, or is cut short */
SimulationState loadState(const std::string& file);

}  // namespace blem_sim::sim
