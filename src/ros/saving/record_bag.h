// Content of a record: topics and messages of its bag.
#pragma once

#include <blem_sim/RecordStart.h>
#include <blem_sim/RecordedInput.h>

#include <cstdint>
#include <string>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

constexpr const char* START_TOPIC = "record/start";
constexpr const char* INPUT_TOPIC = "record/input";
constexpr const char* STEPS_TOPIC = "record/steps";

/** Beginning of a record, at the state at hand. @param configuration YAML that the simulation was loaded from */
RecordStart startMessage(const sim::Simulator& simulator, const std::string& configuration);
/** Configuration of a simulation that begins so. @param source names the record in errors @throws InputError */
sim::SimulationConfig configOf(const RecordStart& start, const std::string& source);

/** @param step steps made since the record began */
RecordedInput toMessage(const sim::SimulatorInput& input, std::uint64_t step);
sim::SimulatorInput fromMessage(const RecordedInput& message);

}  // namespace blem_sim::node
