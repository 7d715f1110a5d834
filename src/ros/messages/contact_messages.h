// Contacts as messages.
#pragma once

#include <blem_sim/ContactArray.h>
#include <blem_sim/ContactsState.h>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

/** Every contact of the report. */
ContactArray toContactArray(const sim::Simulator& simulator, const sim::StepReport& report);

/** A contact sensor's reading: one state per pair of colliders, in the order of the colliders. */
ContactsState toContactsState(const sim::Simulator& simulator, const sim::StepReport& report, const sim::ContactReading& reading);

}  // namespace blem_sim::node
