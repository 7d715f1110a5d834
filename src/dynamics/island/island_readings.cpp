#include "island/island_readings.h"

#include <cmath>

#include "problem/make_terms.h"

namespace blem_sim::dynamics {
namespace {

/** @param v [rad/s or m/s] velocity of the joint at the end of the step */
void readJoint(const JointTerm& j, double v, const StepInput& input, SolveResult* result, JointRecord* record) {
  const double dt = input.dt, last = record->dry, bound = j.dry_bound / dt;
  record->dry = j.dryImpulse(v) / dt;
  record->lower = j.lowerImpulse(v) / dt;
  record->upper = j.upperImpulse(v) / dt;
  record->dry_change = std::abs(record->dry) < bound && std::abs(last) < bound ? record->dry - last : 0;
  const JointDrive& drive = input.drives[j.joint];
  result->motor_efforts[j.joint] = drive.effort + j.motorImpulse(v) / dt;
  result->axis_efforts[j.joint] = drive.givenEffort() + (j.motorImpulse(v) + j.dryImpulse(v) - j.viscous * v + j.viscousLead()) / dt;
}

void addRootWrench(const JointTerm& j, double v, const Forest& forest, double dt, SolveResult* result) {
  Wrench& wrench = result->root_wrenches[j.root_drive];
  const int axis = j.dof - forest.nodes()[forest.nodeOfDof(j.dof)].first_dof;
  (axis < 3 ? wrench.torque[axis] : wrench.force[axis - 3]) = j.motorImpulse(v) / dt;
}

// A mimic joint feels its master's pull, the master its reaction.
void addMimicPulls(const Forest& forest, const Island& island, double dt, std::vector<double>* axis_efforts) {
  const std::vector<double>& impulses = island.solver.found().mimic_impulses;
  for (std::size_t i = 0; i < island.mimics.size(); ++i) {
    const MimicRelation& m = forest.mimics()[island.mimics[i]];
    const double effort = impulses[i] / dt;
    (*axis_efforts)[forest.nodes()[m.node].joint] += effort;
    (*axis_efforts)[forest.nodes()[m.master].joint] -= m.multiplier * effort;
  }
}

}  // namespace

void readContacts(const StepInput& input, const Island& island, SolveResult* result) {
  const std::vector<ContactTerm>& terms = island.solver.found().terms.contacts;
  forPairs(island.solver.atHand(), [&](std::size_t index) {
    const PairContacts& of_pair = island.model.pairs[index];
    for (int i = of_pair.first; i < of_pair.end; ++i) {
      const int contact = island.contacts[i];
      result->contact_forces[contact] = termSign(input.contacts[contact]) / input.dt * terms[i].impulse;
      result->apparent_work[contact] = island.apparent_work[i];
    }
  });
}

void readJoints(const StepInput& input, const Island& island, SolveResult* result, std::vector<JointRecord>* records) {
  const Forest& forest = island.solver.atHand().forest;
  const IslandTerms& terms = island.solver.found().terms;
  const Eigen::VectorXd& velocity = island.solver.atHand().space->velocity;
  const auto read = [&](const JointTerm& j, double v) { readJoint(j, v, input, result, &(*records)[j.joint]); };
  for (const JointTerm& j : terms.joints) {
    if (j.joint >= 0)
      read(j, velocity[j.dof]);
    else
      addRootWrench(j, velocity[j.dof], forest, input.dt, result);
  }
  for (std::size_t l = 0; l < island.loops.size(); ++l) {
    const LoopTerm& loop = terms.loops[l];
    (*records)[forest.loops()[island.loops[l]].joint].loop = loop.impulses() / input.dt;
    if (loop.rows < 6) read(loop.drive, loop.velocity[5]);
  }
  addMimicPulls(forest, island, input.dt, &result->axis_efforts);
}

}  // namespace blem_sim::dynamics
