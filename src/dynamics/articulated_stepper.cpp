#include "articulated_stepper.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/roomy.h"
#include "free_way_books.h"
#include "island/flight.h"
#include "island/island_motion.h"
#include "island/island_readings.h"
#include "island/island_wrenches.h"
#include "island/tree_state.h"
#include "kept_trees.h"
#include "problem/contact_work.h"
#include "problem/joint_leads.h"
#include "step_islands.h"

namespace blem_sim::dynamics {
namespace {

constexpr double FASTEST = 1e100;       // [m/s or rad/s]: at higher speeds ODE could not normalise the state it gets
constexpr double SAME_PRODUCTS = 1e-9;  // [sqrt(kg) m/s] change of the free momentum that needs no second pass

constexpr int MOST_LIMITS = 4;       // times that a step's corrections are limited anew
constexpr std::size_t SHARED = 300;  // contacts of an island that threads share
constexpr double LIGHT = 0.01;       // [kg] mass of the lightest tree of an island, below which tolerances shrink
constexpr std::uint64_t NO_MORE_TREES = ~0ull;

// The last of several solves, with the iterations of all.
NewtonReport afterAll(const NewtonReport& before, NewtonReport last) {
  last.iterations += before.iterations;
  return last;
}

class ArticulatedStepper : public Stepper {
 public:
  explicit ArticulatedStepper(const SolverSettings& settings)
      : settings_(settings), arena_(std::min(mostThreads(settings.threads), tbb::this_task_arena::max_concurrency())) {}

  void step(Scene* scene, const StepInput& input, SolveResult* result) override;
  void save(const Scene& scene, geometry::StateWriter* writer) override;
  void restore(const Scene& scene, geometry::StateReader* reader) override;
  bool agreesWith(const Scene& scene) const override;
  void forgetContacts(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on) override { memory_.forgetContacts(ids, go_on); }
  bool pushed(std::uint64_t contact) const override {
    const ContactRecord* const record = memory_.find(contact);
    return record && !record->force.isZero(0);
  }

 private:
  void rebuild(const Scene& scene);
  bool isOurs(const Scene& scene, int tree) const;
  void readEdits(const Scene& scene);
  NewtonSettings settingsFor(const Island& island) const;
  bool leap(const TermSource& source, Island* island);
  TreeAhead ahead(const TermSource& source, const Island& island, int tree) const;
  NewtonReport solveCorrected(const TermSource& source, const NewtonSettings& newton, const NewtonReport& solved, Island* island);
  NewtonReport solveBounded(const TermSource& source, Island* island);
  void reckonWork(bool leaps, Island* island);
  bool solveOnce(const TermSource& source, Island* island);
  void solveIsland(const Scene& scene, const StepInput& input, Island* island);
  void finishIsland(const Scene& scene, const StepInput& input, Island* island, SolveResult* result);
  template <typename Work>
  void forEachIsland(int threads, const Work& work);
  void report(double dt, SolveResult* result) const;
  void remember(const StepInput& input, const SolveResult& result);
  void noteWritten(const Scene& scene, int tree);
  void writeScene(Scene* scene);

  SolverSettings settings_;
  tbb::task_arena arena_;
  std::uint64_t structure_ = 0;  ///< Scene::structure() that the forest was built for
  Forest forest_;
  ForestMotion motion_;
  FreeMotion way_;  ///< of fast trees
  StepMemory memory_;
  KeptTrees kept_;
  std::vector<BodyBits> written_;  ///< per node: bits that the scene was given last
  SolverSpace space_;
  ImpactSpace impact_space_;
  StepIslands islands_;
  std::vector<ContactRecord> next_contacts_;
};

void ArticulatedStepper::rebuild(const Scene& scene) {
  if (structure_ == scene.structure()) return;
  structure_ = scene.structure();
  kept_.clear();
  for (int tree = 0; tree < static_cast<int>(forest_.trees().size()); ++tree)
    if (isOurs(scene, tree)) kept_.keep(forest_, tree, motion_);
  forest_.build(scene);
  motion_.resize(forest_);
  way_.resize(forest_);
  space_.resize(forest_);
  impact_space_.resize(forest_);
  memory_.resize(scene);
  written_.resize(forest_.nodes().size());
  for (BodyBits& bits : written_) bits.numbers[0] = NAN;
  for (int tree = 0; tree < static_cast<int>(forest_.trees().size()); ++tree)
    if (kept_.restore(forest_, tree, &motion_)) noteWritten(scene, tree);
}

bool ArticulatedStepper::isOurs(const Scene& scene, int tree) const {
  const ForestTree& t = forest_.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i)
    if (!scene.exists(forest_.nodes()[i].body) || !scene.hasBits(forest_.nodes()[i].body, written_[i])) return false;
  return true;
}

// Reads back the trees whose bodies were set from outside since the last step; the others' joint coordinates are kept as they are.
void ArticulatedStepper::readEdits(const Scene& scene) {
  for (int tree = 0; tree < static_cast<int>(forest_.trees().size()); ++tree) {
    if (isOurs(scene, tree)) continue;
    readTree(forest_, scene, tree, &motion_);
    placeBodies(forest_, tree, &motion_);
    computeInertias(forest_, tree, &motion_);
    joinVelocities(forest_, scene, tree, &motion_, &space_);
    takeMomentum(forest_, tree, &motion_, &space_);
  }
}

// Tolerances shrink with the lightest tree, below 10 g: those of heavier trees would let it creep.
NewtonSettings ArticulatedStepper::settingsFor(const Island& island) const {
  NewtonSettings settings;
  double lightest = LIGHT;
  for (const int tree : island.model.trees) lightest = std::min(lightest, motion_.composite[forest_.trees()[tree].first_node].mass);
  settings.contact_tolerance *= lightest / LIGHT;
  settings.gradient_tolerance *= std::sqrt(lightest / LIGHT);
  return settings;
}

TreeAhead ArticulatedStepper::ahead(const TermSource& source, const Island& island, int tree) const {
  return {forest_, source.scene, source.input, tree, !island.contacts.empty()};
}

// Takes velocity products at the middle of the step as it was solved, and solves again where those before were not good enough.
NewtonReport ArticulatedStepper::solveCorrected(const TermSource& source, const NewtonSettings& newton, const NewtonReport& solved,
                                                Island* island) {
  double change = 0;
  for (const int tree : island->model.trees) change = std::max(change, correctProducts(ahead(source, *island, tree), &motion_, &space_));
  return change <= SAME_PRODUCTS ? solved : afterAll(solved, island->solver.solveAgain(newton));
}

NewtonReport ArticulatedStepper::solveBounded(const TermSource& source, Island* island) {
  const NewtonSettings newton = settingsFor(*island);
  const NewtonReport first = island->solver.solve(forest_, motion_, island->model, newton, &space_);
  NewtonReport report = solveCorrected(source, newton, first, island);
  // Products of velocities that only corrections gave would push what stands still. Where contacts have given up, others may push as hard.
  for (int k = 0; k < MOST_LIMITS && island->solver.limitCorrections(settings_.max_correction_speed); ++k)
    report = solveCorrected(source, newton, afterAll(report, island->solver.solveAgain(newton)), island);
  return report;
}

// Trees that an impact meets are followed as if they were fast: their speed after it is not known yet. @return whether an impact happened
bool ArticulatedStepper::leap(const TermSource& source, Island* island) {
  const TouchedIsland touched{island->model, *island->solver.terms(), island->contacts};
  if (!island->impacts.expect(source, touched)) return false;
  for (const int tree : island->model.trees) followAlone(ahead(source, *island, tree), &motion_, &space_);
  return island->impacts.happen(source, touched, &impact_space_, &space_);
}

// Precondition: solved, impacts not added yet.
void ArticulatedStepper::reckonWork(bool leaps, Island* island) {
  const IslandModel& model = island->model;
  const std::vector<ContactTerm>& contacts = island->solver.found().terms.contacts;
  if (leaps)
    for (const int tree : model.trees) computeTwists(forest_, tree, motion_, impact_space_.leap, &impact_space_.twist);
  geometry::makeRoomFor(contacts.size(), &island->apparent_work);
  island->apparent_work.assign(contacts.size(), 0);
  forPairs(model, island->solver.team(), [&](std::size_t index) {
    const PairContacts& of_pair = model.pairs[index];
    Vector6 before = relativeTwist(of_pair.pair, motion_.twist);
    if (leaps) before += relativeTwist(of_pair.pair, impact_space_.twist);
    for (int i = of_pair.first; i < of_pair.end; ++i) {
      const ContactTerm& contact = contacts[i];
      if (!contact.impulse.isZero(0)) island->apparent_work[i] = apparentWork(contact, velocityAt(before, contact.point));
    }
  });
}

bool ArticulatedStepper::solveOnce(const TermSource& source, Island* island) {
  IslandModel& model = island->model;
  forTrees(model, island->solver.team(), [&](int tree) { setFreeMomentum(ahead(source, *island, tree), &motion_, &space_); });
  makeTerms(source, island);
  model.up = -source.scene.gravity();
  setLeads(source, model.trees, &island->solver.terms()->joints, &motion_, &space_);
  addEfforts(source.input, *island->solver.terms(), &space_);
  const bool leaps = leap(source, island);
  island->report = solveBounded(source, island);
  return leaps;
}

void ArticulatedStepper::solveIsland(const Scene& scene, const StepInput& input, Island* island) {
  const TermSource source{scene, forest_, motion_, input, settings_, memory_};
  const bool flies = setOutInFlight(source, *island, &motion_);
  bool leaps = solveOnce(source, island);
  if (flies && hasLanded(*island, forest_, motion_)) {
    breakOffFlight(forest_, island->model.trees, &motion_);
    leaps = solveOnce(source, island);
  }
  reckonWork(leaps, island);
  if (leaps) island->impacts.addTo(island->solver.terms());
}

void ArticulatedStepper::finishIsland(const Scene& scene, const StepInput& input, Island* island, SolveResult* result) {
  const IslandModel& model = island->model;
  readContacts(input, *island, result);
  readJoints(input, *island, result, &memory_.joints);
  island->impacts.takeFrom(input.dt, &memory_.joints);
  for (const int tree : model.trees) {
    const ForestTree& t = forest_.trees()[tree];
    motion_.next_velocity.segment(t.first_dof, t.dofCount()) = space_.velocity.segment(t.first_dof, t.dofCount());
  }
  const SolvedIsland solved{forest_, scene, model, island->solver.found().terms, input.dt, island->solver.team()};
  island->followed = followFast(solved, motion_, space_, &way_);
  computeWrenches(solved, way_, &motion_, &space_, &result->joint_wrenches);
  bookBeforeWay(solved, motion_, &space_, result);
  advanceIsland(solved, way_, &motion_, &space_);
  bookAfterWay(solved, motion_, result);
  endFlight(solved, input.of_step, &motion_, result);
  island->impacts.takeFrom(forest_, model.trees, &motion_.change);
}

void ArticulatedStepper::remember(const StepInput& input, const SolveResult& result) {
  next_contacts_.clear();
  for (int n = 0; n < islands_.count(); ++n) {
    const Island& island = islands_[n];
    for (std::size_t i = 0; i < island.contacts.size(); ++i) {
      const ContactConstraint& c = input.contacts[island.contacts[i]];
      // The impulse of an impact does not go on in the next step.
      Vector3 force = result.contact_forces[island.contacts[i]];
      if (island.impacts.any()) force -= termSign(c) / input.dt * island.impacts.impulse(i);
      const bool pushes = c.normal_BA.dot(force) > 0;
      if (pushes) next_contacts_.push_back({c.id, force, island.solver.found().terms.contacts[i].slipVelocity().norm()});
    }
  }
  std::sort(next_contacts_.begin(), next_contacts_.end(), [](const ContactRecord& a, const ContactRecord& b) { return a.id < b.id; });
  memory_.contacts.swap(next_contacts_);
  memory_.index();
}

void ArticulatedStepper::noteWritten(const Scene& scene, int tree) {
  const ForestTree& t = forest_.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) written_[i] = scene.bits(forest_.nodes()[i].body);
}

void ArticulatedStepper::writeScene(Scene* scene) {
  for (int tree = 0; tree < static_cast<int>(forest_.trees().size()); ++tree) writeTree(forest_, tree, motion_, scene, &written_);
}

// Islands share nothing that they write, so their order does not matter.
template <typename Work>
void ArticulatedStepper::forEachIsland(int threads, const Work& work) {
  const bool alone = islands_.count() == 1 && islands_[0].contacts.size() < SHARED;
  if (threads == 1 || alone) {
    for (int i = 0; i < islands_.count(); ++i) work(&islands_[i]);
  } else {
    const auto share = [&](Island* island) {
      const int helpers = island->contacts.size() >= SHARED ? threads - 1 : 0;
      island->solver.team()->with(helpers, [&] { work(island); });
    };
    arena_.execute([&] { tbb::parallel_for(0, islands_.count(), [&](int i) { share(&islands_[i]); }); });
  }
}

void ArticulatedStepper::report(double dt, SolveResult* result) const {
  result->residual = result->creep = 0;
  result->too_fast = false;
  result->iterations = result->lcp_errors = 0;
  for (int i = 0; i < islands_.count(); ++i) {
    const NewtonReport& report = islands_[i].report;
    result->too_fast |= !islands_[i].followed;
    result->residual = std::max(result->residual, report.contact_residual / dt);
    result->creep = std::max({result->creep, report.joint_creep, report.contact_creep, report.imbalance});
    result->iterations += report.iterations;
  }
}

void ArticulatedStepper::step(Scene* scene, const StepInput& input, SolveResult* result) {
  rebuild(*scene);
  readEdits(*scene);
  islands_.find(*scene, forest_, input.contacts);
  geometry::makeRoomFor(input.contacts.size(), &result->contact_forces);
  geometry::makeRoomFor(input.contacts.size(), &result->apparent_work);
  result->contact_forces.assign(input.contacts.size(), Vector3::Zero());
  result->apparent_work.assign(input.contacts.size(), 0);
  result->motor_efforts.assign(scene->joints().size(), 0);
  result->axis_efforts.assign(scene->joints().size(), 0);
  result->joint_wrenches.assign(scene->joints().size(), Wrench());
  result->root_wrenches.assign(input.root_drives ? input.root_drives->size() : 0, Wrench());
  result->free_work.assign(scene->joints().size(), 0);
  result->free_efforts.assign(scene->joints().size(), 0);
  result->free_speeds.assign(scene->joints().size(), 0);
  const int threads = threadsFor(settings_.threads, input.contacts.size());
  forEachIsland(threads, [&](Island* island) { solveIsland(*scene, input, island); });
  // Nothing was changed yet: a step that broke down leaves everything as it was.
  result->finite = (space_.velocity.array().abs() < FASTEST).all();
  if (!result->finite) {
    for (int i = 0; i < islands_.count(); ++i) breakOffFlight(forest_, islands_[i].model.trees, &motion_);
    return;
  }
  result->free_ways.assign(hasFreeWays(motion_) ? scene->bodies().size() : 0, Vector3::Zero());
  forEachIsland(threads, [&](Island* island) { finishIsland(*scene, input, island, result); });
  report(input.dt, result);
  remember(input, *result);
  writeScene(scene);
}

// The same words for a world that was just made and for one that was brought back to its beginning: trees changed from outside are left
// out.
void ArticulatedStepper::save(const Scene& scene, geometry::StateWriter* writer) {
  rebuild(scene);
  memory_.save(scene, writer);
  for (int tree = 0; tree < static_cast<int>(forest_.trees().size()); ++tree) {
    if (!isOurs(scene, tree)) continue;
    writer->word(tree);
    saveTree(forest_, tree, motion_, writer);
  }
  writer->word(NO_MORE_TREES);
}

void ArticulatedStepper::restore(const Scene& scene, geometry::StateReader* reader) {
  rebuild(scene);
  memory_.restore(scene, reader);
  for (BodyBits& bits : written_) bits.numbers[0] = NAN;
  std::uint64_t least = 0;
  for (std::uint64_t tree = reader->word(); tree != NO_MORE_TREES; tree = reader->word(), ++least) {
    if (tree < least || tree >= forest_.trees().size()) reader->refuse();
    least = tree;
    restoreTree(forest_, static_cast<int>(tree), &motion_, reader);
    noteWritten(scene, static_cast<int>(tree));
  }
}

bool ArticulatedStepper::agreesWith(const Scene& scene) const {
  for (int tree = 0; tree < static_cast<int>(forest_.trees().size()); ++tree)
    if (isOurs(scene, tree) && !standsAt(forest_, tree, motion_, scene)) return false;
  return true;
}

}  // namespace

std::unique_ptr<Stepper> makeArticulated(const SolverSettings& settings) { return std::make_unique<ArticulatedStepper>(settings); }

}  // namespace blem_sim::dynamics
