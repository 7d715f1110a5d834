#include "island/island_impacts.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr int MAX_ROUNDS = 100;             // a row of as many touching bodies passes an impact on
constexpr int MAX_SWEEPS = 100;             // of the contacts that meet in a round
constexpr int HOLDING_SWEEPS = 1000;        // of those that others hold: what is light between what is heavy takes many,
constexpr int HOLDING_WORK = 400000;        // but, beyond MAX_SWEEPS, no more than visit so many dofs
constexpr int MAX_HOLDING = 20;             // times that a round is made again, since more has to hold
constexpr int MAX_WORK = 100000;            // contacts visited, over all sweeps of a step
constexpr double EXACTNESS = 1e-11;         // of the largest speed: changes of velocity at which a sweep is the last
constexpr double HOLDING_EXACTNESS = 1e-7;  // the same of those that others hold,
constexpr double SEARCH_EXACTNESS = 1e-2;   // while it is looked for what holds

}  // namespace

// Lets a bouncer meet in this round. @return whether it can: something moves there
bool IslandImpacts::meet(const TermSource& s, const TouchedIsland& island, Bouncer* b) {
  const ImpactRows::Source source{s.forest, s.motion, &mass_, space_};
  if (b->row < 0)
    b->row = b->contact < 0 ? rows_.addLimit(source, b->dof, b->sign) : rows_.add(source, *b->pair, island.terms.contacts[b->contact]);
  if (!(rows_.inverseMass(b->row) > 0)) return false;
  Meeting meeting;
  meeting.bouncer = static_cast<int>(b - bouncers_.data());
  meeting.row = b->row;
  meeting.friction = -b->speed > b->friction_speed ? b->friction : b->slow_friction;
  meetings_.push_back(meeting);
  return true;
}

// Finds the contacts that approach so fast that they will meet within the step, and the share of its speed that each will keep: restitution
// is that at the surface, which is a gap's fall away.
bool IslandImpacts::findMeetings(const TermSource& s, const TouchedIsland& island) {
  meetings_.clear();
  const double dt = s.input.dt;
  setSpeeds(s, island, space_->velocity);
  for (Bouncer& b : bouncers_) {
    const double closing = -b.speed;
    if (!b.has_impacts || !(closing > b.slowest) || b.depth - dt * (b.speed + b.kick) <= 0) continue;
    if (!meet(s, island, &b) || !(b.restitution > 0)) continue;
    const double e2 = b.restitution * b.restitution, fall = 4 * b.kick * b.depth / (dt * closing * closing);
    meetings_.back().restitution = std::sqrt(std::clamp(e2 - (1 - e2) * fall, 0.0, 1.0));
  }
  findGroups(s.forest, island.model);
  return !meetings_.empty();
}

// Adds what this round has pushed against and touches, but has not held, and then takes the round back. @return whether there is any
bool IslandImpacts::findHolds(const TermSource& s, const TouchedIsland& island) {
  setSpeeds(s, island, space_->velocity);
  const std::size_t met = meetings_.size();
  for (Bouncer& b : bouncers_) {
    if (!b.holds || !(-b.speed > b.slowest && b.speed_before - b.speed > b.slowest)) continue;
    const auto is_b = [&](const Meeting& m) { return &bouncers_[m.bouncer] == &b; };
    if (std::any_of(meetings_.begin(), meetings_.begin() + met, is_b) || !meet(s, island, &b)) continue;
    meetings_.back().holds = true;
  }
  if (meetings_.size() == met) return false;
  takeBack(s.forest, island.model.trees);
  findGroups(s.forest, island.model);
  return true;
}

void IslandImpacts::beginRound(const Forest& forest, const std::vector<int>& trees) {
  for (const int tree : trees) {
    const ForestTree& t = forest.trees()[tree];
    space_->before.segment(t.first_dof, t.dofCount()) = space_->velocity.segment(t.first_dof, t.dofCount());
  }
  for (Bouncer& b : bouncers_) {
    b.speed_before = b.speed;
    b.impulse_before = b.impulse;
  }
}

void IslandImpacts::takeBack(const Forest& forest, const std::vector<int>& trees) {
  for (const int tree : trees) {
    const ForestTree& t = forest.trees()[tree];
    space_->velocity.segment(t.first_dof, t.dofCount()) = space_->before.segment(t.first_dof, t.dofCount());
  }
  for (Bouncer& b : bouncers_) b.impulse = b.impulse_before;
  for (Meeting& m : meetings_) m.impulse.setZero();
}

// Groups the meetings: those that no moved tree ties together do not act on each other.
void IslandImpacts::findGroups(const Forest& forest, const IslandModel& model) {
  const auto placeOf = [&](int tree) {
    return static_cast<int>(std::lower_bound(model.trees.begin(), model.trees.end(), tree) - model.trees.begin());
  };
  const auto treeOf = [&](const Bouncer& b) { return forest.nodes()[b.contact < 0 ? forest.nodeOfDof(b.dof) : b.pair->a].tree; };
  groups_.reset(static_cast<int>(model.trees.size()));
  for (const Meeting& m : meetings_) {
    const Bouncer& b = bouncers_[m.bouncer];
    const int tree = treeOf(b);
    for (const int moved : mass_.movedWith(tree)) groups_.join(placeOf(tree), placeOf(moved));
    if (b.contact < 0 || b.pair->b < 0) continue;
    for (const int moved : mass_.movedWith(forest.nodes()[b.pair->b].tree)) groups_.join(placeOf(tree), placeOf(moved));
  }
  groups_.number();
  for (Meeting& m : meetings_) m.group = groups_.islandOf(placeOf(treeOf(bouncers_[m.bouncer])));
  std::sort(meetings_.begin(), meetings_.end(),
            [](const Meeting& a, const Meeting& b) { return a.group != b.group ? a.group < b.group : a.bouncer < b.bouncer; });
}

double IslandImpacts::push(const Vector3& impulse, Meeting* meeting) {
  const Vector3 change = impulse - meeting->impulse;
  rows_.push(meeting->row, change, &space_->velocity);
  meeting->impulse = impulse;
  return std::max(std::abs(change[0]) * rows_.inverseMass(meeting->row), change.tail<2>().norm() * rows_.inverseMassAcross(meeting->row));
}

// The normal impulse that stops the approach, but does not pull. @return [m/s] change of velocities
double IslandImpacts::stop(Meeting* m) {
  const double speed = rows_.velocity(m->row, space_->velocity)[0];
  return push({std::max(0.0, m->impulse[0] - speed / rows_.inverseMass(m->row)), m->impulse[1], m->impulse[2]}, m);
}

// A friction impulse of at most so much that lowers the kinetic energy: a projected gradient's.
double IslandImpacts::rub(double most, Meeting* m) {
  if (m->friction == 0 || !(rows_.inverseMassAcross(m->row) > 0)) return 0;
  const Vector3 slip = rows_.velocity(m->row, space_->velocity);
  Vector3 impulse = m->impulse;
  impulse.tail<2>() -= slip.tail<2>() / rows_.inverseMassAcross(m->row);
  const double size = impulse.tail<2>().norm();
  if (size > most) impulse.tail<2>() *= most / size;
  return push(impulse, m);
}

void IslandImpacts::scale(double factor, Meeting* first, Meeting* end) {
  for (Meeting* m = first; m != end; ++m) push(factor * m->impulse, m);
}

// Sweeps over the meetings of a group, by `visit`, until nothing changes any more.
template <typename Visit>
void IslandImpacts::sweep(double fastest, Meeting* first, Meeting* end, const Visit& visit) {
  const bool holding = std::any_of(first, end, [](const Meeting& m) { return m.holds; });
  const double exact = (holding ? holding_exactness_ : EXACTNESS) * fastest;
  int left = MAX_SWEEPS;
  if (holding) {
    int dofs = 0;
    for (const Meeting* m = first; m != end; ++m) dofs += rows_.dofs(m->row);
    left = std::clamp(HOLDING_WORK / dofs, MAX_SWEEPS, HOLDING_SWEEPS);
  }
  for (; left > 0 && work_left_ > 0; --left) {
    double change = 0;
    for (Meeting* m = first; m != end; ++m) change = std::max(change, visit(m));
    work_left_ -= static_cast<int>(end - first);
    if (change <= exact) break;
  }
}

// The plastic impact of a group, with friction, by sweeps. @return [J] lost, never below 0
double IslandImpacts::compress(Meeting* first, Meeting* end) {
  double fastest = 0;
  for (Meeting* m = first; m != end; ++m) {
    m->before = rows_.velocity(m->row, space_->velocity);
    fastest = std::max(fastest, m->before.norm());
  }
  // All at once, to begin with: a symmetric impact stays symmetric.
  const double share = 1.0 / static_cast<double>(end - first);
  for (Meeting* m = first; m != end; ++m)
    if (!m->holds) push({share * -m->before[0] / rows_.inverseMass(m->row), 0, 0}, m);
  const auto sums = [&](double* along, double* square) {
    *along = *square = 0;
    for (Meeting* m = first; m != end; ++m) {
      *along -= m->impulse.dot(m->before);
      *square += m->impulse.dot(rows_.velocity(m->row, space_->velocity) - m->before);
    }
  };
  double along, square;
  sums(&along, &square);
  if (along > 0 && square > 0) scale(along / square, first, end);
  sweep(fastest, first, end, [this](Meeting* m) {
    const double stopped = stop(m);
    return std::max(stopped, rub(m->friction * m->impulse[0], m));
  });
  sums(&along, &square);
  if (along >= 0.5 * square) return along - 0.5 * square;
  // Friction, whose bounds went on shrinking, has added energy: as much along the same impulses as takes most of it away.
  const double best = along > 0 ? along / square : 0;
  scale(best, first, end);
  return best * along - 0.5 * best * best * square;
}

// Expansion of an impact: normal impulses in proportion to those of the compression [Poisson], and their friction. It returns at most the
// lost energy times the square of the largest restitution.
void IslandImpacts::expand(Meeting* first, Meeting* end, double lost) {
  double largest = 0;
  for (Meeting* m = first; m != end; ++m) {
    bouncers_[m->bouncer].impulse += m->impulse;
    if (m->impulse[0] > 0) largest = std::max(largest, m->restitution);
    m->before = rows_.velocity(m->row, space_->velocity);
  }
  for (Meeting* m = first; m != end; ++m) {
    const double given_back = m->restitution * m->impulse[0];
    m->impulse.setZero();
    push({given_back, 0, 0}, m);
  }
  double fastest = 0;
  for (Meeting* m = first; m != end; ++m) fastest = std::max(fastest, rows_.velocity(m->row, space_->velocity).norm());
  sweep(fastest, first, end, [this](Meeting* m) {
    const double stopped = m->holds ? stop(m) : 0;
    return std::max(stopped, rub(m->friction * m->impulse[0], m));
  });
  double along = 0, square = 0;
  for (Meeting* m = first; m != end; ++m) {
    along += m->impulse.dot(m->before);
    square += m->impulse.dot(rows_.velocity(m->row, space_->velocity) - m->before);
  }
  const double most = largest * largest * lost;
  if (along + 0.5 * square > most) scale((std::sqrt(along * along + 2 * square * most) - along) / square, first, end);
  for (Meeting* m = first; m != end; ++m) bouncers_[m->bouncer].impulse += m->impulse;
}

void IslandImpacts::react() {
  for (Meeting *first = meetings_.data(), *last = first + meetings_.size(); first != last;) {
    Meeting* end = first;
    while (end != last && end->group == first->group) ++end;
    expand(first, end, compress(first, end));
    first = end;
  }
}

// Makes the round again until all that was pushed against holds: roughly while that is looked for, then exactly.
void IslandImpacts::hold(const TermSource& s, const TouchedIsland& island) {
  if (!findHolds(s, island)) return;
  holding_exactness_ = SEARCH_EXACTNESS;
  react();
  for (int again = 1; again < MAX_HOLDING && work_left_ > 0 && findHolds(s, island); ++again) react();
  takeBack(s.forest, island.model.trees);
  holding_exactness_ = HOLDING_EXACTNESS;
  react();
}

bool IslandImpacts::happen(const TermSource& s, const TouchedIsland& island, ImpactSpace* space, SolverSpace* solver) {
  space_ = space;
  work_left_ = MAX_WORK;
  begin(s, island, *solver);
  const bool any_holds = std::any_of(bouncers_.begin(), bouncers_.end(), [](const Bouncer& b) { return b.holds; });
  for (int round = 0; round < MAX_ROUNDS && work_left_ > 0 && findMeetings(s, island); ++round) {
    beginRound(s.forest, island.model.trees);
    react();
    if (any_holds) hold(s, island);
  }
  if (rows_.empty()) return false;
  finish(s.forest, island, solver);
  return true;
}

// The impulses of limits are left to the solve, which finds them again from the momentum; the velocities that they lead to are told.
void IslandImpacts::finish(const Forest& forest, const TouchedIsland& island, SolverSpace* solver) {
  impulses_.assign(island.terms.contacts.size(), Vector3::Zero());
  for (const Bouncer& b : bouncers_) {
    if (b.row < 0) continue;
    rows_.push(b.row, b.impulse, &space_->leap);
    if (b.contact < 0) {
      solver->mass_velocity[b.dof] += b.sign * b.impulse[0];
      continue;
    }
    rows_.addMomentum(b.row, b.impulse, &space_->momentum);
    impulses_[b.contact] = rows_.inWorld(b.row, b.impulse);
  }
  for (const int tree : island.model.trees) {
    const ForestTree& t = forest.trees()[tree];
    const int first = t.first_dof, count = t.dofCount();
    solver->free_momentum.segment(first, count) += space_->momentum.segment(first, count);
    solver->mass_velocity.segment(first, count) += space_->momentum.segment(first, count);
    solver->velocity.segment(first, count) += space_->leap.segment(first, count);
  }
}

void IslandImpacts::takeFrom(double dt, std::vector<JointRecord>* records) const {
  if (!any()) return;
  for (const Bouncer& b : bouncers_) {
    if (b.contact >= 0) continue;
    double& force = b.sign > 0 ? (*records)[b.joint].lower : (*records)[b.joint].upper;
    force = std::max(0.0, force - b.impulse[0] / dt);
  }
}

void IslandImpacts::addTo(IslandTerms* terms) const {
  for (std::size_t i = 0; i < impulses_.size(); ++i) terms->contacts[i].impulse += impulses_[i];
}

void IslandImpacts::takeFrom(const Forest& forest, const std::vector<int>& trees, Eigen::VectorXd* change) const {
  if (!any()) return;
  for (const int tree : trees) {
    const ForestTree& t = forest.trees()[tree];
    change->segment(t.first_dof, t.dofCount()) -= space_->leap.segment(t.first_dof, t.dofCount());
  }
}

}  // namespace blem_sim::dynamics
