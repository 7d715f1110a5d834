// Impacts of an island: what may meet or hold, and the velocities at which it does.
#include <algorithm>
#include <cmath>

#include "island/island_impacts.h"

namespace blem_sim::dynamics {
namespace {

// An impact bounces if it is faster than the speed that a contact at rest gains in some steps, by gravity and by the forces that press it.
constexpr double REST_STEPS = 2;
constexpr double REST_SPEED = 1e-3;  // [m/s] and than this
constexpr double TOUCH = 1e-6;       // [m or rad] gap up to which something holds

double normalSpeed(const BodyPair& pair, const ContactTerm& term, const std::vector<Vector6>& twist) {
  return term.normal.dot(velocityAt(relativeTwist(pair, twist), term.point));
}

// Whether a contact has impacts. A compliant contact has one at touch; its spring answers behind it. Impacts without restitution and a
// friction of their own are left to the solve.
bool hasImpacts(const ContactConstraint& c, const ContactTerm& term) {
  return (c.restitution > 0 || c.impact_friction_factor != 1) && !(term.compliance > 0 && c.depth > 0);
}

// Whether a contact touches and answers an impact at once, without bouncing.
bool holdsImpacts(const ContactConstraint& c, const ContactTerm& term) {
  return c.restitution == 0 && !(term.compliance > 0) && c.depth >= -TOUCH;
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
  rows_.clear();
  mass_.factor(s.forest, s.motion, island.model, space_);
  for (const int tree : island.model.trees) {
    const ForestTree& t = s.forest.trees()[tree];
    const int first = t.first_dof, count = t.dofCount();
    space_->column.segment(first, count) = 0.5 * (solver.free_momentum.segment(first, count) - solver.mass_velocity.segment(first, count));
    // A slow step's momentum is half a step beside its velocities; a fast tree takes that difference at once.
    if (t.free && s.motion.pace[tree] == Pace::FAST)
      space_->column.segment<6>(first) += 0.5 * (s.motion.momentum[tree] - solver.mass_velocity.segment<6>(first));
  }
  findBouncers(s, island);
  findLimits(s, island);
  addHolding(s, island);
  for (const int tree : island.model.trees) {
    if (mass_.movedWith(tree).front() == tree) mass_.solve(s.forest, tree, &space_->column, space_);
    const ForestTree& t = s.forest.trees()[tree];
    const int first = t.first_dof, count = t.dofCount();
    space_->leap.segment(first, count).setZero();
    space_->momentum.segment(first, count).setZero();
    space_->velocity.segment(first, count) = solver.velocity.segment(first, count) + space_->column.segment(first, count);
  }
  setSpeeds(s, island, space_->column);
  for (Bouncer& b : bouncers_) {
    b.kick = b.speed;
    b.slowest = slowestBounce(s, b.kick);
  }
}

// Adds to half of the step's forces what holds, as it did in the last step: what lies still is not pressed on by its weight.
void IslandImpacts::addHolding(const TermSource& s, const TouchedIsland& island) {
  std::vector<Vector6>& wrench = space_->twist;
  for (const int tree : island.model.trees)
    for (int i = s.forest.trees()[tree].first_node; i < s.forest.trees()[tree].node_end; ++i) wrench[i].setZero();
  for (const Bouncer& b : bouncers_) {
    if (!b.holds || b.contact < 0) continue;
    const ContactTerm& term = island.terms.contacts[b.contact];
    addWrench(*b.pair, 0.5 * wrenchOf(term.previous, term.point), &wrench);
  }
  const WrenchProjection project{s.forest, s.motion, 1, &wrench, &space_->column};
  for (const int tree : island.model.trees) project.addTree(tree);
  for (const Bouncer& b : bouncers_)
    if (b.contact < 0) space_->column[b.dof] += 0.5 * b.sign * b.pushed;
}

void IslandImpacts::findBouncers(const TermSource& s, const TouchedIsland& island) {
  bouncers_.clear();
  for (const PairContacts& of_pair : island.model.pairs)
    for (int i = of_pair.first; i < of_pair.end; ++i) {
      const ContactConstraint& c = s.input.contacts[island.contacts[i]];
      Bouncer bouncer;
      bouncer.has_impacts = hasImpacts(c, island.terms.contacts[i]);
      bouncer.holds = holdsImpacts(c, island.terms.contacts[i]);
      if (!bouncer.has_impacts && !bouncer.holds) continue;
      bouncer.contact = i;
      bouncer.pair = &of_pair.pair;
      bouncer.restitution = c.restitution;
      bouncer.slow_friction = island.terms.contacts[i].friction;
      bouncer.friction = c.impact_friction_factor * bouncer.slow_friction;
      bouncer.friction_speed = c.impact_friction_speed;
      bouncer.depth = c.depth;
      bouncers_.push_back(bouncer);
    }
}

void IslandImpacts::findLimits(const TermSource& s, const TouchedIsland& island) {
  const auto add = [&](const JointTerm& joint, double sign, double speed, double pushed) {
    if (!(sign * speed * s.input.dt >= -TOUCH)) return;
    Bouncer bouncer;
    bouncer.dof = joint.dof;
    bouncer.joint = joint.joint;
    bouncer.sign = sign;
    bouncer.pushed = pushed;
    bouncer.holds = true;
    bouncers_.push_back(bouncer);
  };
  for (const JointTerm& joint : island.terms.joints) {
    if (!(joint.limit_gain > 0)) continue;
    add(joint, 1, joint.lower_velocity, joint.lower_previous);
    add(joint, -1, joint.upper_velocity, joint.upper_previous);
  }
}

void IslandImpacts::setSpeeds(const TermSource& s, const TouchedIsland& island, const Eigen::VectorXd& velocity) {
  for (const int tree : island.model.trees) computeTwists(s.forest, tree, s.motion, velocity, &space_->twist);
  for (Bouncer& b : bouncers_)
    b.speed = b.contact < 0 ? b.sign * velocity[b.dof] : normalSpeed(*b.pair, island.terms.contacts[b.contact], space_->twist);
}

}  // namespace blem_sim::dynamics
