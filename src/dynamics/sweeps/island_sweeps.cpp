#include "sweeps/island_sweeps.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr std::size_t GROUPS_AT_ONCE = 8, NUMBERS_AT_ONCE = 1024;  // sizes of chunks: some microseconds each

Vector6 columnOf(const TwistLanes& lanes, int lane) {
  Vector6 out;
  for (int i = 0; i < 6; ++i) out[i] = lanes[i][lane];
  return out;
}

}  // namespace

// Groups that threads share.
template <typename Visit>
void IslandSweeps::forGroups(const GroupRange& groups, const Visit& visit) const {
  island_->team->forRanges(groups.first, groups.end, GROUPS_AT_ONCE, [&](std::size_t first, std::size_t end) {
    for (std::size_t g = first; g < end; ++g) visit(g);
  });
}

bool IslandSweeps::load(const IslandAtHand& island, SweepStart start, Eigen::VectorXd* velocity) {
  island_ = &island;
  joints_.takeMotors(island, *velocity);
  return arrange(start, velocity);
}

bool IslandSweeps::arrange(SweepStart start, Eigen::VectorXd* velocity) {
  const IslandAtHand& island = *island_;
  if (!loadResponse()) return false;
  pairs_.clear();
  for (const PairContacts& of_pair : island.model.pairs) pairs_.push_back(response_.pair(of_pair.pair));
  joints_.load(start, &response_);
  order_.find(island, response_, pairs_, &groups_);
  velocities_.arrange(island, response_, order_.regions());
  loadContacts(start);
  findVelocity(velocity);
  lead_.start(velocities_.size());
  return true;
}

bool IslandSweeps::loadResponse() {
  response_.start(island_->forest, island_->motion, island_->model.trees, island_->model.mimics);
  gains_.resize(island_->forest.dofCount());
  momentum_.resize(island_->forest.dofCount());
  forDofs(*island_, [this](int k) {
    gains_[k] = 0;
    momentum_[k] = island_->space->free_momentum[k];
  });
  joints_.foldMotors(&gains_, &momentum_);
  return response_.factor(gains_);
}

void IslandSweeps::loadContacts(SweepStart start) {
  const std::size_t count = groups_.empty() ? 0 : groups_.back().end;
  contacts_.resize(count);
  impulses_.resize(count);
  changes_.resize(groups_.size());
  bodies_.resize(groups_.size());
  forGroups({0, groups_.size()}, [this](std::size_t g) {
    SweepGroup& group = groups_[g];
    loadBodies(&group, &bodies_[g]);
    for (int lane = 0; lane < SWEEP_LANES; ++lane) loadLane(lane, &group);
    setGains(group, contacts_.data() + group.first, contacts_.data() + group.end);
  });
  if (start == SweepStart::NOTHING) dynamics::scale(0, impulses_.data(), impulses_.data() + impulses_.size());
}

// Response and contacts of a lane's pair.
void IslandSweeps::loadLane(int lane, SweepGroup* group) {
  const int p = group->pair[lane];
  Matrix6 response = Matrix6::Identity();
  if (p >= 0) response = response_.relative(pairs_[p]);
  for (int r = 0, at = 0; r < 6; ++r)
    for (int c = 0; c <= r; ++c, ++at) group->response[at][lane] = response(r, c);
  for (int i = group->first; i < group->end; ++i) {
    const int contact = p < 0 ? -1 : island_->model.pairs[p].first + i - group->first;
    const bool exists = contact >= 0 && contact < island_->model.pairs[p].end;
    setLane(exists ? &island_->terms()->contacts[contact] : nullptr, lane, &contacts_[i], &impulses_[i]);
  }
}

void IslandSweeps::loadBodies(SweepGroup* group, SweepBodies* bodies) const {
  group->free = true;
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    const int p = group->pair[lane];
    const ResponseSide none, &a = p < 0 ? none : pairs_[p].a, &b = p < 0 ? none : pairs_[p].b;
    group->free = group->free && a.unit < 0 && b.unit < 0;
    if (!group->free) return;
    response_.setLane(a, lane, velocities_.placeOf(a), &bodies->a);
    response_.setLane(b, lane, velocities_.placeOf(b), &bodies->b);
    for (int i = 0; i < 3; ++i) bodies->shift[i][lane] = p < 0 ? 0 : pairs_[p].pair.shift[i];
  }
}

// Velocity with the impulses at hand.
void IslandSweeps::findVelocity(Eigen::VectorXd* velocity) {
  response_.freeVelocity(momentum_, velocity);
  island_->team->forChunks(order_.regions().count(), [&](int region) { pushGroups(order_.groupsOf(region), velocity); });
  pushGroups(order_.groupsOf(order_.regions().count()), velocity);
  joints_.push(response_, velocity);
}

void IslandSweeps::pushGroups(const GroupRange& groups, Eigen::VectorXd* velocity) {
  TwistLanes wrench;
  for (std::size_t g = groups.first; g < groups.end; ++g) {
    wrenchOf(contactsOf(groups_[g]), &wrench);
    push(groups_[g], wrench, velocity);
  }
}

void IslandSweeps::push(const SweepGroup& group, const TwistLanes& wrench, Eigen::VectorXd* velocity) const {
  for (int lane = 0; lane < SWEEP_LANES; ++lane)
    if (group.pair[lane] >= 0) response_.push(pairs_[group.pair[lane]], columnOf(wrench, lane), velocity);
}

// Sweeps a group in which a tree takes part.
void IslandSweeps::sweepTrees(std::size_t index, Eigen::VectorXd* velocity) {
  const SweepGroup& group = groups_[index];
  TwistLanes twist = {}, wrench;
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    if (group.pair[lane] < 0) continue;
    const Vector6 relative = response_.relativeTwist(pairs_[group.pair[lane]], *velocity);
    for (int i = 0; i < 6; ++i) twist[i][lane] = relative[i];
  }
  dynamics::sweep(group, contactsOf(group), twist, &wrench, &changes_[index]);
  push(group, wrench, velocity);
}

void IslandSweeps::sweepGroup(std::size_t index, Eigen::VectorXd* velocity) {
  const SweepGroup& group = groups_[index];
  if (!group.free) return sweepTrees(index, velocity);
  sweepFree(bodies_[index], contactsOf(group), velocities_.numbers(), &changes_[index]);
}

// Regions have no body in common, so threads share them, and each stays with its own.
void IslandSweeps::sweepRegion(int region, Eigen::VectorXd* velocity) {
  const GroupRange groups = order_.groupsOf(region);
  if (joints_.empty())
    for (const NumberRange* v = velocities_.begin(region); v != velocities_.end(region); ++v)
      lead_.moveVelocities(v->first, v->end, velocities_.numbers());
  for (std::size_t g = groups.first; g < groups.end; ++g) sweepGroup(g, velocity);
}

// The border is all there is of an island without regions.
void IslandSweeps::sweepBorder(Eigen::VectorXd* velocity) {
  if (joints_.empty()) leadTogether(order_.regions().count());
  for (int c = 0; c < order_.colours(); ++c) sweepColour(c, velocity);
}

// All threads lead one region on.
void IslandSweeps::leadTogether(int region) {
  for (const NumberRange* v = velocities_.begin(region); v != velocities_.end(region); ++v)
    island_->team->forRanges(v->first, v->end, NUMBERS_AT_ONCE,
                             [&](std::size_t first, std::size_t end) { lead_.moveVelocities(first, end, velocities_.numbers()); });
}

// Joints of any region are visited first, so all regions are led on before.
void IslandSweeps::sweepJoints(Eigen::VectorXd* velocity) {
  if (joints_.empty()) return;
  for (int r = 0; r <= order_.regions().count(); ++r) leadTogether(r);
  joints_.lead(lead_);
  joints_.sweep(response_, velocity);
}

// Groups of one colour have no body in common, so threads share them. Groups of the last colour may have: one thread sweeps them.
void IslandSweeps::sweepColour(int colour, Eigen::VectorXd* velocity) {
  const GroupRange groups = order_.groupsOfColour(colour);
  if (order_.isLast(colour))
    for (std::size_t g = groups.first; g < groups.end; ++g) sweepGroup(g, velocity);
  else
    forGroups(groups, [&](std::size_t g) { sweepGroup(g, velocity); });
}

void IslandSweeps::sweepOnce(Eigen::VectorXd* velocity) {
  sweepJoints(velocity);
  island_->team->forChunks(order_.regions().count(), [&](int region) { sweepRegion(region, velocity); });
  sweepBorder(velocity);
  change_ = SweepChange();
  squared_change_ = 0;
  for (const SweepChange& group : changes_) {
    for (const double squared : group.squared) squared_change_ += squared;
    change_.largest = std::max(change_.largest, group.largest);
    change_.impulse = std::max(change_.impulse, group.impulse);
  }
}

SweepReport IslandSweeps::sweep(int most, double enough, Eigen::VectorXd* velocity) {
  SweepReport report;
  lead_.beginRun();
  velocities_.take(velocity);
  while (report.sweeps < most) {
    sweepOnce(velocity);
    const double relative = change_.impulse > 0 ? std::sqrt(change_.largest / change_.impulse) : 0;
    if (report.sweeps++ == 0) report.first_change = relative;
    report.last_change = relative;
    // The last sweep is a plain one: steps ahead lead out of the cones.
    if (relative <= enough) break;
    lead_.take(squared_change_);
  }
  findVelocity(velocity);
  return report;
}

void IslandSweeps::scale(double factor, Eigen::VectorXd* velocity) {
  dynamics::scale(factor, impulses_.data(), impulses_.data() + impulses_.size());
  joints_.scale(factor);
  findVelocity(velocity);
}

void IslandSweeps::read(const Eigen::VectorXd& velocity, IslandTerms* terms) const {
  forGroups({0, groups_.size()}, [&](std::size_t g) {
    const SweepGroup& group = groups_[g];
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      if (group.pair[lane] < 0) continue;
      const PairContacts& of_pair = island_->model.pairs[group.pair[lane]];
      for (int i = of_pair.first; i < of_pair.end; ++i) {
        const int at = group.first + i - of_pair.first;
        terms->contacts[i].impulse = readLane(contacts_[at], impulses_[at], lane);
      }
    }
  });
  joints_.read(response_, velocity, terms);
}

}  // namespace blem_sim::dynamics
