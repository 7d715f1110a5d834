#include "island/island_impacts.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

// An impact bounces if it is faster than the speed that a contact at rest gains in some steps, by gravity and by the forces that press it.
constexpr double REST_STEPS = 2;
constexpr double REST_SPEED = 1e-3;  // [m/s] and than this
constexpr int MAX_ROUNDS = 100;      // a row of as many touching bodies passes an impact on
constexpr int MAX_SWEEPS = 100;      // of the contacts that meet in a round
constexpr int MAX_WORK = 100000;     // contacts visited, over all sweeps of a step
constexpr double EXACTNESS = 1e-11;  // of the largest speed: changes of velocity at which a sweep is the last

double normalSpeed(const BodyPair& pair, const ContactTerm& term, const std::vector<Vector6>& twist) {
  return term.normal.dot(velocityAt(relativeTwist(pair, twist), term.point));
}

// Whether a contact has impacts. A compliant contact has one at touch; its spring answers behind it. Impacts without restitution and a
// friction of their own are left to the solve.
bool hasImpacts(const ContactConstraint& c, const ContactTerm& term) {
  return (c.restitution > 0 || c.impact_friction_factor != 1) && !(term.compliance > 0 && c.depth > 0);
}

double slowestBounce(const TermSource& s, double kick) {
  return std::max(REST_SPEED, REST_STEPS * std::max(s.input.dt * s.scene.gravity().norm(), 2 * std::abs(kick)));
}

}  // namespace

// Velocities with half of the step's forces approach by no more than these times 4/3, then 5/3, if the bounds on rest are to be passed.
bool IslandImpacts::expect(const TermSource& s, const TouchedIsland& island) {
  impulses_.clear();
  const double slowest = slowestBounce(s, 0);
  for (const PairContacts& of_pair : island.model.pairs)
    for (int i = of_pair.first; i < of_pair.end; ++i) {
      const ContactConstraint& c = s.input.contacts[island.contacts[i]];
      if (!hasImpacts(c, island.terms.contacts[i])) continue;
      const double closing = -normalSpeed(of_pair.pair, island.terms.contacts[i], s.motion.twist);
      if (4 * closing > 3 * slowest && 5 * s.input.dt * closing > -3 * c.depth) return true;
    }
  return false;
}

void IslandImpacts::begin(const TermSource& s, const TouchedIsland& island, const SolverSpace& solver) {
  bouncers_.clear();
  rows_.clear();
  work_left_ = MAX_WORK;
  for (const int tree : island.model.trees) {
    const ForestTree& t = s.forest.trees()[tree];
    const int first = t.first_dof, count = t.dofCount();
    factorTree({s.forest, tree, s.motion.mass}, &space_->factor);
    space_->column.segment(first, count) = 0.5 * (solver.free_momentum.segment(first, count) - solver.mass_velocity.segment(first, count));
    // A slow step's momentum is half a step beside its velocities; a fast tree takes that difference at once.
    if (t.free && s.motion.pace[tree] == Pace::FAST)
      space_->column.segment<6>(first) += 0.5 * (s.motion.momentum[tree] - solver.mass_velocity.segment<6>(first));
    solveTree(s.forest, tree, space_->factor, &space_->column, &space_->paths);
    space_->velocity.segment(first, count) = solver.velocity.segment(first, count) + space_->column.segment(first, count);
    space_->leap.segment(first, count).setZero();
    space_->momentum.segment(first, count).setZero();
  }
  for (const PairContacts& of_pair : island.model.pairs)
    for (int i = of_pair.first; i < of_pair.end; ++i) {
      const ContactConstraint& c = s.input.contacts[island.contacts[i]];
      if (!hasImpacts(c, island.terms.contacts[i])) continue;
      Bouncer bouncer;
      bouncer.contact = i;
      bouncer.pair = &of_pair.pair;
      bouncer.restitution = c.restitution;
      bouncer.slow_friction = island.terms.contacts[i].friction;
      bouncer.friction = c.impact_friction_factor * bouncer.slow_friction;
      bouncer.friction_speed = c.impact_friction_speed;
      bouncer.depth = c.depth;
      bouncers_.push_back(bouncer);
    }
  setSpeeds(s, island, space_->column);
  for (Bouncer& b : bouncers_) {
    b.kick = b.speed;
    b.slowest = slowestBounce(s, b.kick);
  }
}

void IslandImpacts::setSpeeds(const TermSource& s, const TouchedIsland& island, const Eigen::VectorXd& velocity) {
  for (const int tree : island.model.trees) computeTwists(s.forest, tree, s.motion, velocity, &space_->twist);
  for (Bouncer& b : bouncers_) b.speed = normalSpeed(*b.pair, island.terms.contacts[b.contact], space_->twist);
}

// Finds the contacts that approach so fast that they will meet within the step, and the share of its speed that each will keep: restitution
// is that at the surface, which is a gap's fall away.
bool IslandImpacts::findMeetings(const TermSource& s, const TouchedIsland& island) {
  meetings_.clear();
  const double dt = s.input.dt;
  setSpeeds(s, island, space_->velocity);
  for (Bouncer& b : bouncers_) {
    const double closing = -b.speed;
    if (!(closing > b.slowest) || b.depth - dt * (b.speed + b.kick) <= 0) continue;
    if (b.row < 0) b.row = rows_.add(s.forest, s.motion, *b.pair, island.terms.contacts[b.contact], space_);
    if (!(rows_.inverseMass(b.row) > 0)) continue;
    const double e2 = b.restitution * b.restitution, fall = 4 * b.kick * b.depth / (dt * closing * closing);
    Meeting meeting;
    meeting.bouncer = static_cast<int>(&b - bouncers_.data());
    meeting.row = b.row;
    meeting.friction = closing > b.friction_speed ? b.friction : b.slow_friction;
    if (b.restitution > 0) meeting.restitution = std::sqrt(std::clamp(e2 - (1 - e2) * fall, 0.0, 1.0));
    meetings_.push_back(meeting);
  }
  findGroups(s.forest, island.model);
  return !meetings_.empty();
}

// Groups the meetings: those that no moved tree ties together do not act on each other.
void IslandImpacts::findGroups(const Forest& forest, const IslandModel& model) {
  const auto treeOf = [&](int node) {
    const auto at = std::lower_bound(model.trees.begin(), model.trees.end(), forest.nodes()[node].tree);
    return static_cast<int>(at - model.trees.begin());
  };
  groups_.reset(static_cast<int>(model.trees.size()));
  for (const Meeting& m : meetings_) {
    const BodyPair& pair = *bouncers_[m.bouncer].pair;
    if (pair.b >= 0) groups_.join(treeOf(pair.a), treeOf(pair.b));
  }
  groups_.number();
  for (Meeting& m : meetings_) m.group = groups_.islandOf(treeOf(bouncers_[m.bouncer].pair->a));
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

// The plastic impact of a group, with friction, by sweeps. @return [J] lost, never below 0
double IslandImpacts::compress(Meeting* first, Meeting* end) {
  double fastest = 0;
  for (Meeting* m = first; m != end; ++m) {
    m->before = rows_.velocity(m->row, space_->velocity);
    fastest = std::max(fastest, m->before.norm());
  }
  // All at once, to begin with: a symmetric impact stays symmetric.
  const double share = 1.0 / static_cast<double>(end - first);
  for (Meeting* m = first; m != end; ++m) push({share * -m->before[0] / rows_.inverseMass(m->row), 0, 0}, m);
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
  for (int sweep = 0; sweep < MAX_SWEEPS && work_left_ > 0; ++sweep) {
    double change = 0;
    for (Meeting* m = first; m != end; ++m) {
      change = std::max(change, stop(m));
      change = std::max(change, rub(m->friction * m->impulse[0], m));
    }
    work_left_ -= static_cast<int>(end - first);
    if (change <= EXACTNESS * fastest) break;
  }
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
  for (int sweep = 0; sweep < MAX_SWEEPS && work_left_ > 0; ++sweep) {
    double change = 0;
    for (Meeting* m = first; m != end; ++m) change = std::max(change, rub(m->friction * m->impulse[0], m));
    work_left_ -= static_cast<int>(end - first);
    if (change <= EXACTNESS * fastest) break;
  }
  double along = 0, square = 0;
  for (Meeting* m = first; m != end; ++m) {
    along += m->impulse.dot(m->before);
    square += m->impulse.dot(rows_.velocity(m->row, space_->velocity) - m->before);
  }
  const double most = largest * largest * lost;
  if (along + 0.5 * square > most) scale((std::sqrt(along * along + 2 * square * most) - along) / square, first, end);
  for (Meeting* m = first; m != end; ++m) bouncers_[m->bouncer].impulse += m->impulse;
}

bool IslandImpacts::happen(const TermSource& s, const TouchedIsland& island, ImpactSpace* space, SolverSpace* solver) {
  space_ = space;
  begin(s, island, *solver);
  for (int round = 0; round < MAX_ROUNDS && work_left_ > 0 && findMeetings(s, island); ++round) {
    for (Meeting *first = meetings_.data(), *last = first + meetings_.size(); first != last;) {
      Meeting* end = first;
      while (end != last && end->group == first->group) ++end;
      expand(first, end, compress(first, end));
      first = end;
    }
  }
  if (rows_.empty()) return false;
  finish(s.forest, island, solver);
  return true;
}

void IslandImpacts::finish(const Forest& forest, const TouchedIsland& island, SolverSpace* solver) {
  impulses_.assign(island.terms.contacts.size(), Vector3::Zero());
  for (const Bouncer& b : bouncers_) {
    if (b.row < 0) continue;
    rows_.addMomentum(b.row, b.impulse, &space_->momentum);
    rows_.push(b.row, b.impulse, &space_->leap);
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
