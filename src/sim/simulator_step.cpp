// One step: the table of docs/architecture.md.
#include <algorithm>
#include <cmath>
#include <utility>

#include "guard/step_prediction.h"
#include "simulator_impl.h"
#include "stage_timer.h"

namespace blem_sim::sim {
namespace {

constexpr double FARTHEST_FINITE = 1e12;  // [m], [m/s], [rad/s]: larger numbers have no meaning any more
constexpr double STILL_HOLDS = 0.75;      // of a solve's length: links in tension that could take no more begin to swing

bool withinReach(const dynamics::BodyState& state) {
  const auto small = [](const Vector3& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() < FARTHEST_FINITE; };
  return small(state.X_WB.translation()) && state.X_WB.linear().allFinite() && small(state.v_WCom) && small(state.w_WB);
}

}  // namespace

const StepReport& Simulator::Impl::step() {
  if (stopped_) return report_;
  startStep();
  if (!bodiesAreFinite()) return stop();
  if (!at_hand_.known) findFirstContacts();
  // Sinks change after contacts of the state at hand were found, as they are after a restore.
  fading_.advance(config_.time_step, world_.colliders, at_hand_.manifolds);
  while (!substeps_.finished()) {
    planSubstep();
    sampleCommands();
    const std::vector<dynamics::JointDrive>& drives = motorTorque();
    const SolverContacts& constraints = reduction();
    const std::optional<MadeSolve> made = solve(constraints, drives);
    if (!made) return stop();
    // Contacts at the new state: the guard judges by them, and the next solve, of the rest of the step or of the next one, starts from
    // them.
    const double left = substeps_.fractionAfter();
    WatchedPairs& pairs = left > 0 ? broadPhase(foreseen(), left) : broadPhase(nullptr, 1);
    const FoundContacts& found = narrowPhase(&pairs);
    if (hasEarlyPushes(*made, found))
      repeatSubstep(drives);
    else
      stepGuard(*made, found);
  }
  ++step_count_;
  most_ticks_ = substeps_.nextMost();
  loads_.expire(time());
  if (substeps_.count() > 1) world_.world.setJointEfforts(part_reports_.efforts());
  recordMisses();
  sensors();
  report();
  watchAttachments();
  return report_;
}

void Simulator::Impl::startStep() {
  threads_.expect(static_cast<std::size_t>(report_.reduced_contacts));
  fading_.setUp(wayUp());
  substeps_ = Substeps(most_ticks_);
  report_.status = STEP_OK;
  report_.profile = StepProfile();
  sensors_.takeBack(&report_.samples);
  report_.layer_events.clear();
  report_.broken_attachments.clear();
  report_.energy_gained = report_.energy_out_of_nothing = 0;
  report_.solver_residual = report_.solver_creep = report_.wrench_error = 0;
  report_.solver_iterations = 0;
  report_.dt = config_.time_step;
  report_.max_depth = report_.max_of_layer = 0;
  report_.deepest_a = report_.deepest_b = -1;
  part_reports_.startStep(world_.world.jointCount());
  world_.bodyStates(&bodies_before_);
  bodies_ = bodies_before_;
  foreseen_.clear();
  energy_balance_.start(world_.world);
}

void Simulator::Impl::findFirstContacts() {
  narrowPhase(&broadPhase(nullptr, 1));
  startFromFound();
}

void Simulator::Impl::planSubstep() {
  const StageTimer timer(&report_.profile, Stage::STEP_GUARD);
  // Pairs are left out only where many bodies cross each other already: shorter substeps would cost time and keep nothing apart.
  if (substeps_.isRedone() || !at_hand_.watched.left_out.empty()) return;
  const double left = substeps_.fractionLeft() * config_.time_step;
  double safe = safeTime(world_, at_hand_, bodies_, left);
  if (const std::vector<dynamics::BodyState>* faster = foreseen()) safe = safeTime(world_, at_hand_, *faster, safe);
  substeps_.plan(safe / left);
}

void Simulator::Impl::sampleCommands() {
  const StageTimer timer(&report_.profile, Stage::SAMPLE_COMMANDS);
  for (JointMotor& motor : world_.motors) motor.sample(substepTime(), substepLength());
}

const std::vector<dynamics::JointDrive>& Simulator::Impl::motorTorque() {
  const StageTimer timer(&report_.profile, Stage::MOTOR_TORQUE);
  drives_.resize(world_.motors.size());
  for (std::size_t j = 0; j < drives_.size(); ++j) drives_[j] = world_.motors[j].drive(world_.world.jointState(static_cast<int>(j)));
  loads_.addEfforts(time(), &drives_);
  return drives_;
}

const SolverContacts& Simulator::Impl::reduction() {
  const StageTimer timer(&report_.profile, Stage::REDUCTION);
  const SolveAhead ahead{world_, bodies_, at_hand_, fading_, early_pushes_.expectation(), substepLength(), pair_searches_.workspace()};
  return constraint_maker_.make(ahead, &at_hand_.manifolds);
}

// Gravity acts on all bodies; a force against it bears what it is not to act on.
const std::vector<BodyLoad>& Simulator::Impl::loadsNow() {
  loads_now_ = loads_.wrenchesAt(time());
  for (std::size_t model = 0; model < world_.models.size(); ++model) {
    for (const WeightlessPart& part : world_.models[model].weightless) {
      const geometry::MassProperties inertial = linkInertial(part.body, part.link);
      Vector3 p_BCom = inertial.com;
      if (const int robot = world_.robotOf(static_cast<int>(model)); robot >= 0)
        p_BCom = world_.robots[robot].lumped->link_placement[part.link].X_BL * inertial.com;
      loads_now_.push_back({part.body, {-inertial.mass * world_.world.gravity(), Vector3::Zero()}, p_BCom});
    }
  }
  return loads_now_;
}

std::optional<MadeSolve> Simulator::Impl::solve(const SolverContacts& contacts, const std::vector<dynamics::JointDrive>& drives) {
  const StageTimer timer(&report_.profile, Stage::SOLVE);
  world_.world.save(&substep_start_);
  bodies_before_substep_ = bodies_;
  const std::vector<BodyLoad>& loads = loadsNow();
  for (const BodyLoad& load : loads) world_.world.applyWrench(load.body, load.wrench, bodies_[load.body].X_WB * load.p_B);
  energy_balance_.setLoads(loads);
  const std::vector<dynamics::RootDrive>& bases = base_drives_.of(world_.world, bodies_, substepLength());
  const dynamics::SolveResult& result = world_.world.step(substepLength(), contacts.constraints, drives, config_.time_step, bases);
  for (std::size_t i = 0; i < bases.size(); ++i)
    energy_balance_.addLoad({bases[i].body, result.root_wrenches[i], world_.world.bodySpec(bases[i].body).inertial.com});
  if (result.finite) world_.bodyStates(&bodies_);
  if (result.finite && bodiesAreFinite())
    return MadeSolve{at_hand_, contacts, drives, result, bodies_before_substep_, bodies_, substepLength()};
  rewind();
  return std::nullopt;
}

WatchedPairs& Simulator::Impl::broadPhase(const std::vector<dynamics::BodyState>* faster, double part) {
  const StageTimer timer(&report_.profile, Stage::BROAD_PHASE);
  pair_watch_.find({world_, bodies_, faster, part * config_.time_step}, &pairs_);
  return pairs_;
}

const FoundContacts& Simulator::Impl::narrowPhase(WatchedPairs* pairs) {
  const StageTimer timer(&report_.profile, Stage::NARROW_PHASE);
  pair_searches_.find(world_, at_hand_, fading_, pairs, &found_);
  return found_;
}

bool Simulator::Impl::hasEarlyPushes(const MadeSolve& made, const FoundContacts& found) {
  const StageTimer timer(&report_.profile, Stage::STEP_GUARD);
  return substeps_.canRepeat() && early_pushes_.find(world_, made, found);
}

void Simulator::Impl::stepGuard(const MadeSolve& made, const FoundContacts& found) {
  const StageTimer timer(&report_.profile, Stage::STEP_GUARD);
  passed_.clear();
  const double longest = taut_links_.longestSolve(world_.world, made);
  substeps_.bound(longest / config_.time_step);
  if (made.start.watched.left_out.empty()) {
    const std::vector<ClosePass>& close = sweep_guard_.look(world_, made, pair_watch_.arms(), fading_);
    if (substeps_.canRedo() && isTooLong(made, found, close)) {
      redoSubstep(close);
      return;
    }
    for (const ClosePass& pass : close)
      if (pass.passed) passed_.emplace_back(pass.a, pass.b);
  }
  if (longest < STILL_HOLDS * made.dt) report_.status |= MOTION_TOO_FAST;
  acceptSubstep(made);
}

bool Simulator::Impl::isTooLong(const MadeSolve& made, const FoundContacts& found, const std::vector<ClosePass>& close) {
  return substeps_.isBeyondBound() || !close.empty() || usesUpLayer(world_.colliders, made, found, &threads_);
}

void Simulator::Impl::rewind() {
  world_.world.restore(substep_start_);
  bodies_ = bodies_before_substep_;
}

void Simulator::Impl::repeatSubstep(const std::vector<dynamics::JointDrive>& drives) {
  rewind();
  if (solve(reduction(), drives))
    early_pushes_.expect(bodies_);
  else
    early_pushes_.clear();
  rewind();
  substeps_.repeat();
}

/** Bodies go back to where the substep started; contacts are known as far as the solve has shown that bodies may get. */
void Simulator::Impl::redoSubstep(const std::vector<ClosePass>& close) {
  double part = 1;
  for (const ClosePass& pass : close) part = std::min(part, pass.part);
  foreseen_ = bodies_;
  rewind();
  early_pushes_.clear();
  pair_watch_.find({world_, bodies_, foreseen(), substeps_.fractionLeft() * config_.time_step}, &pairs_);
  pair_searches_.find(world_, at_hand_, fading_, &pairs_, &found_);
  startFromFound();
  substeps_.redo(std::min(part, safeTime(world_, at_hand_, foreseen_, substepLength()) / substepLength()));
}

const std::vector<dynamics::BodyState>* Simulator::Impl::foreseen() {
  if (foreseen_.empty()) return nullptr;
  for (std::size_t body = 0; body < bodies_.size(); ++body) foreseen_[body].X_WB = bodies_[body].X_WB;
  return &foreseen_;
}

void Simulator::Impl::acceptSubstep(const MadeSolve& made) {
  recordSolve(made.result);
  part_reports_.startPart(substeps_.fraction());
  part_reports_.addJoints(made.result.joint_wrenches, made.result.motor_efforts);
  recordMotors(made);
  recordContacts(made);
  if (!passed_.empty()) report_.status |= CONTACT_UNRELIABLE;
  layer_watch_.look(made.start, passed_, substepTime(), &report_.layer_events);
  recordEnergy(made);
  startFromFound();
  substeps_.accept();
  early_pushes_.clear();
}

void Simulator::Impl::sensors() {
  const StageTimer timer(&report_.profile, Stage::SENSORS);
  jointStates(&joints_);
  const StepContext step{world_,
                         config_.time_step,
                         bodies_before_,
                         bodies_,
                         joints_,
                         part_reports_.jointWrenches(),
                         part_reports_.contacts(),
                         sensors_.linkContacts()};
  sensors_.read(step, step_count_, &report_.samples);
}

bool Simulator::Impl::bodiesAreFinite() const {
  for (const dynamics::BodyState& state : bodies_)
    if (!withinReach(state)) return false;
  return true;
}

const StepReport& Simulator::Impl::stop() {
  stopped_ = true;
  report_.status |= STATE_NOT_FINITE;
  part_reports_.clearContacts();
  jointStates(&joints_);
  report();
  return report_;
}

void Simulator::Impl::jointStates(std::vector<dynamics::JointState>* out) const {
  out->resize(world_.world.jointCount());
  for (int joint = 0; joint < world_.world.jointCount(); ++joint) (*out)[joint] = world_.world.jointState(joint);
}

}  // namespace blem_sim::sim
