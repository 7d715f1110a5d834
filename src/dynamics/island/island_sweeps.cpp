#include "island/island_sweeps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blem_sim::dynamics {
namespace {

constexpr std::size_t GROUPS_AT_ONCE = 8, IMPULSES_AT_ONCE = 256, DOFS_AT_ONCE = 1024;  // sizes of chunks: some microseconds each
constexpr double MOST_GROWTH = 1.5;  // of squared changes since their least, while sweeps are led on

/** Lead of sweeps: the further the longer they go well, and nothing once they do not. */
class Lead {
 public:
  /** @param change [N^2 s^2] sum of the squares of a sweep's changes. @return share of the last search direction */
  double share(double change) {
    ++sweeps_;
    const bool well = change <= MOST_GROWTH * least_;
    if (!well) sweeps_ = 0;
    least_ = well ? std::min(least_, change) : change;
    return sweeps_ / (sweeps_ + 3.0);
  }

 private:
  int sweeps_ = 0;
  double least_ = std::numeric_limits<double>::infinity();  // change since the beginning
};

Vector6 columnOf(const TwistLanes& lanes, int lane) {
  Vector6 out;
  for (int i = 0; i < 6; ++i) out[i] = lanes[i][lane];
  return out;
}

}  // namespace

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
  loadContacts(start);
  findVelocity(velocity);
  search_.assign(dofs_.size(), 0);
  return true;
}

bool IslandSweeps::loadResponse() {
  response_.start(island_->forest, island_->motion, island_->model.trees, island_->model.mimics);
  gains_.resize(island_->forest.dofCount());
  momentum_.resize(island_->forest.dofCount());
  dofs_.clear();
  forDofs(*island_, [this](int k) {
    dofs_.push_back(k);
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
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    SweepGroup& group = groups_[g];
    loadBodies(&group, &bodies_[g]);
    for (int lane = 0; lane < SWEEP_LANES; ++lane) loadLane(lane, &group);
    setGains(group, contacts_.data() + group.first, contacts_.data() + group.end);
  }
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
    response_.setLane(a, lane, &bodies->a);
    response_.setLane(b, lane, &bodies->b);
    for (int i = 0; i < 3; ++i) bodies->shift[i][lane] = p < 0 ? 0 : pairs_[p].pair.shift[i];
  }
}

// Velocity with the impulses at hand.
void IslandSweeps::findVelocity(Eigen::VectorXd* velocity) {
  response_.freeVelocity(momentum_, velocity);
  TwistLanes wrench;
  for (const SweepGroup& group : groups_) {
    wrenchOf(contactsOf(group), &wrench);
    push(group, wrench, velocity);
  }
  joints_.push(response_, velocity);
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
  sweepFree(bodies_[index], contactsOf(group), velocity->data(), &changes_[index]);
}

// Groups of one colour have no body in common, so threads share them. Groups of the last colour may have: one thread sweeps them.
void IslandSweeps::sweepColour(int colour, Eigen::VectorXd* velocity) {
  const std::size_t begin = order_.firstGroup(colour), end = order_.groupEnd(colour);
  island_->team->forRanges(begin, end, order_.isLast(colour) ? end - begin : GROUPS_AT_ONCE, [&](std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) sweepGroup(g, velocity);
  });
}

void IslandSweeps::plainSweep(Eigen::VectorXd* velocity) {
  joints_.sweep(response_, velocity);
  for (int c = 0; c < order_.colours(); ++c) sweepColour(c, velocity);
  change_ = SweepChange();
  squared_change_ = 0;
  for (const SweepChange& group : changes_) {
    for (const double squared : group.squared) squared_change_ += squared;
    change_.largest = std::max(change_.largest, group.largest);
    change_.impulse = std::max(change_.impulse, group.impulse);
  }
}

void IslandSweeps::noteVelocity(const Eigen::VectorXd& velocity) {
  island_->team->forRanges(0, dofs_.size(), DOFS_AT_ONCE, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) before_[i] = velocity[dofs_[i]];
  });
}

// Moves impulses and velocities by `share` of the last search direction. The next direction is that move and the last sweep's change.
void IslandSweeps::moveOn(double share, Eigen::VectorXd* velocity) {
  island_->team->forRanges(0, impulses_.size(), IMPULSES_AT_ONCE, [&](std::size_t first, std::size_t last) {
    dynamics::moveOn(share, impulses_.data() + first, impulses_.data() + last);
  });
  island_->team->forRanges(0, dofs_.size(), DOFS_AT_ONCE, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      double& v = (*velocity)[dofs_[i]];
      const double along = share * search_[i], change = v - before_[i];
      v += along;
      search_[i] = along + change;
    }
  });
}

SweepReport IslandSweeps::sweep(int most, double enough, Eigen::VectorXd* velocity) {
  SweepReport report;
  Lead lead;
  before_.resize(dofs_.size());
  const bool leads = joints_.empty();
  while (report.sweeps < most) {
    noteVelocity(*velocity);
    plainSweep(velocity);
    const double relative = change_.impulse > 0 ? std::sqrt(change_.largest / change_.impulse) : 0;
    if (report.sweeps++ == 0) report.first_change = relative;
    report.last_change = relative;
    // The last sweep is a plain one: steps ahead lead out of the cones.
    if (relative <= enough || report.sweeps == most) break;
    if (leads) moveOn(lead.share(squared_change_), velocity);
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
  for (const SweepGroup& group : groups_) {
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      if (group.pair[lane] < 0) continue;
      const PairContacts& of_pair = island_->model.pairs[group.pair[lane]];
      for (int i = of_pair.first; i < of_pair.end; ++i) {
        const int at = group.first + i - of_pair.first;
        terms->contacts[i].impulse = readLane(contacts_[at], impulses_[at], lane);
      }
    }
  }
  joints_.read(response_, velocity, terms);
}

}  // namespace blem_sim::dynamics
