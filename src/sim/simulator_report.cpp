// The report of a step: from every substep that was accepted, and once at its end.
#include <algorithm>
#include <cmath>

#include "simulator_impl.h"
#include "stage_timer.h"

namespace blem_sim::sim {
namespace {

constexpr double LIMIT_REACHED = 1e-6;        // [rad or m]
constexpr double CREEP_IS_TROUBLE = 0.01;     // [rad/s or m/s]
constexpr double RESIDUAL_IS_TROUBLE = 0.01;  // of the largest contact force

}  // namespace

void Simulator::Impl::recordSolve(const dynamics::SolveResult& solved) {
  if (solved.lcp_errors > 0 || solved.creep > CREEP_IS_TROUBLE) report_.status |= SOLVER_TROUBLE;
  if (solved.too_fast) report_.status |= MOTION_TOO_FAST;
  report_.solver_residual += substeps_.fraction() * solved.residual;
  report_.solver_creep = std::max(report_.solver_creep, solved.creep);
  report_.solver_iterations += solved.iterations;
}

// Forces of a step are means over its parts: a part in which contacts hardly push is exact enough if the step is.
void Simulator::Impl::recordMisses() {
  double largest = 0;
  for (const ContactReport& contact : part_reports_.contacts()) largest = std::max(largest, contact.force.norm());
  if (report_.solver_residual > RESIDUAL_IS_TROUBLE * largest) report_.status |= SOLVER_TROUBLE;
}

void Simulator::Impl::recordEnergy(const MadeSolve& made) {
  const EnergyGain gain = energy_balance_.addSolve(world_.world, made, found_.manifolds);
  report_.energy_gained += gain.total;
  report_.energy_out_of_nothing += gain.out_of_nothing;
  if (gain.beyond_bound) report_.status |= ENERGY_GAINED;
}

void Simulator::Impl::recordMotors(const MadeSolve& made) {
  if (base_drives_.areSaturated(made.result.root_wrenches)) report_.status |= EFFORT_SATURATED;
  const std::vector<double>& free_speeds = made.result.free_speeds;
  for (std::size_t j = 0; j < made.drives.size(); ++j) {
    const dynamics::JointState state = world_.world.jointState(static_cast<int>(j));
    if (world_.motors[j].accept(made.drives[j], state, substepLength())) report_.status |= EFFORT_SATURATED;
    world_.motors[j].noteFreeWay(state, free_speeds.empty() ? 0 : free_speeds[j]);
    const dynamics::JointSpec& spec = world_.world.jointSpec(static_cast<int>(j));
    if (spec.kind == dynamics::JointKind::FIXED) continue;
    if (state.position < spec.lower + LIMIT_REACHED || state.position > spec.upper - LIMIT_REACHED) report_.status |= JOINT_LIMIT_HIT;
  }
}

// Speculative contacts that did not act are left out.
void Simulator::Impl::recordContacts(const MadeSolve& made) {
  report_.reduced_contacts = made.contacts.reduced;
  for (std::size_t i = 0; i < made.contacts.constraints.size(); ++i) {
    const dynamics::ContactConstraint& constraint = made.contacts.constraints[i];
    const SolvedContact& solved = made.contacts.solved[i];
    const Vector3& force = made.result.contact_forces[i];
    if (constraint.depth < 0 && force.isZero(0)) continue;
    const double depth = constraint.depth + solved.stop, of_layer = solved.layer > 0 ? std::max(0.0, depth) / solved.layer : 0;
    part_reports_.addContact(constraint.id, withMoments({solved.collider_a, solved.collider_b, constraint.body_a, constraint.body_b,
                                                         constraint.point, constraint.normal_BA, depth, of_layer, force, solved.pierced}));
  }
  if (made.contacts.loss.cut_pairs > 0) report_.status |= CONTACTS_REDUCED;
  report_.wrench_error = std::max(report_.wrench_error, made.contacts.loss.wrench);
  recordFound(made.start);
}

void Simulator::Impl::recordFound(const FoundContacts& found) {
  if (!found.crossings.empty()) report_.status |= CONTACT_UNRELIABLE;
  if (!found.watched.left_out.empty()) report_.status |= CONTACT_UNRELIABLE | CONTACTS_REDUCED;
  report_.raw_contacts = 0;
  for (const contact::ContactManifold& manifold : found.manifolds) {
    report_.raw_contacts += static_cast<int>(manifold.contacts.size());
    const double depth = found.depthOf(manifold);
    if (manifold.layer > 0) report_.max_of_layer = std::max(report_.max_of_layer, depth / manifold.layer);
    if (depth <= report_.max_depth) continue;
    report_.max_depth = depth;
    report_.deepest_a = manifold.a;
    report_.deepest_b = manifold.b;
  }
}

ContactReport Simulator::Impl::withMoments(ContactReport contact) const {
  if (substeps_.count() == 0) return contact;
  const auto travel = [&](int collider) -> Vector3 {
    const contact::Collider& on = world_.colliders[collider];
    return world_.linkOrigin(on, bodies_before_substep_) - world_.linkOrigin(on, bodies_before_);
  };
  contact.moment_a = contact.force.cross(travel(contact.collider_a));
  contact.moment_b = travel(contact.collider_b).cross(contact.force);
  return contact;
}

void Simulator::Impl::report() {
  const StageTimer timer(&report_.profile, Stage::REPORT);
  report_.step = step_count_;
  report_.time = time();
  report_.searched_pairs = static_cast<int>(at_hand_.watched.pairs.size());
  report_.substeps = substeps_.count();
  report_.redone_solves = substeps_.redone();
  if (report_.substeps > 1) report_.status |= STEP_SHORTENED;
  report_.energy = world_.world.kineticEnergy() + world_.world.potentialEnergy();
  part_reports_.takeContacts(&report_.contacts);
  report_.bodies = bodies_;
  report_.joints = joints_;
}

void Simulator::Impl::reportWithoutStep() {
  startStep();
  report_.raw_contacts = report_.reduced_contacts = 0;
  jointStates(&joints_);
  if (stopped_) report_.status |= STATE_NOT_FINITE;
  report();
}

}  // namespace blem_sim::sim
