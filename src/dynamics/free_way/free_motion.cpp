#include "free_way/free_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "free_way/rigid_turn.h"
#include "lanes/lanes.h"

namespace blem_sim::dynamics {
namespace {

constexpr double ENERGY_MISS = 1e-5;   // relative, over a step: raise it for less work; energy that is missed is put right in any case
constexpr double TOO_INEXACT = 1e-3;   // likewise: no longer the same motion
constexpr double SUB_STEP_TURN = 0.5;  // [rad] of the fastest body in the first try's sub-steps
constexpr int MAX_SUB_STEPS = 64;
constexpr double FASTER = 4;  // by no more than this is kinetic energy between bodies put right

/** Inertia about the own centre of mass. */
Matrix3 centralInertia(const SpatialInertia& inertia) {
  const Vector3 com = inertia.first_moment / inertia.mass;
  Matrix3 I = inertia.rotational + inertia.first_moment * com.transpose();
  I.diagonal().array() -= inertia.first_moment.dot(com);
  return I;
}

/** Twist about the reference of a turn about a point. */
Vector6 turnAbout(const Vector3& spin, const Vector3& point) { return spatial(spin, crossProduct(point, spin)); }

/** Coefficients of a quaternion's rate of change. */
Eigen::Vector4d turnRate(const Vector3& spin, const Eigen::Vector4d& turn) {
  const Vector3 v = turn.head<3>();
  Eigen::Vector4d rate;
  rate << 0.5 * (turn[3] * spin + crossProduct(spin, v)), -0.5 * spin.dot(v);
  return rate;
}

/** Next number of sub-steps: by the fourth order of the method, at least a quarter more and at most four times as many, and one. */
int moreSteps(int steps, double miss) {
  const double more = steps * std::clamp(std::pow(miss / ENERGY_MISS, 0.25), 1.25, 4.0) + 1;
  return more < MAX_SUB_STEPS ? static_cast<int>(more) : MAX_SUB_STEPS;
}

void normalise(Eigen::Vector4d* turn) { *turn /= turn->norm(); }

}  // namespace

void FreeMotion::resize(const Forest& forest) {
  const std::size_t dofs = forest.dofCount(), trees = forest.trees().size();
  at_.resize(forest);
  at_.mass = {};
  bodies_.resize(forest);
  start_position_.assign(dofs, 0);
  for (auto* v : {&start_velocity_, &sum_position_, &sum_velocity_, &sum_effort_, &owed_, &supplied_}) v->setZero(dofs);
  for (auto* v : {&least, &most}) v->assign(dofs, 0);
  drift_.assign(trees, Vector3::Zero());
  spin_.assign(trees, Vector3::Zero());
}

void FreeMotion::place(const Forest& forest, int tree, const RootPose& root) {
  const ForestTree& t = forest.trees()[tree];
  if (t.free) {
    at_.rotation[t.first_node] = Quaternion(root.turn).toRotationMatrix();
    at_.origin[t.first_node] = root.origin;
  }
  placeBodies(forest, tree, &at_);
  computeBodies(forest, tree, &at_);
  computeTwists(forest, tree, at_, at_.velocity, &at_.twist);
}

// A sub-step of Runge and Kutta's fourth order, from the poses where the tree is placed; it is placed at the end.
void FreeMotion::subStep(const Forest& forest, int tree, double dt, RootPose* root) {
  constexpr double SHARE[] = {0, 0.5, 0.5, 1}, WEIGHT[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  const ForestTree& t = forest.trees()[tree];
  const RootPose start = *root;
  RootPose sum{Eigen::Vector4d::Zero(), Vector3::Zero()}, rate = sum;
  const auto positionOf = [&](int k) -> double& { return at_.position[forest.nodeOfDof(k)]; };
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    start_position_[k] = positionOf(k);
    start_velocity_[k] = at_.velocity[k];
    sum_position_[k] = sum_velocity_[k] = sum_effort_[k] = 0;
  }
  const auto moveTo = [&](double h, const Eigen::VectorXd& by, const Eigen::VectorXd& gain, const RootPose& root_rate) {
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      positionOf(k) = start_position_[k] + h * by[k];
      at_.velocity[k] = start_velocity_[k] + h * gain[k];
    }
    root->turn = start.turn + h * root_rate.turn;
    if (t.free) normalise(&root->turn);
    root->origin = start.origin + h * root_rate.origin;
    place(forest, tree, *root);
  };
  for (int stage = 0; stage < 4; ++stage) {
    if (stage > 0) moveTo(SHARE[stage] * dt, at_.velocity, bodies_.acceleration(), rate);
    bodies_.accelerate(forest, tree, &at_);
    if (t.free) {
      const Vector6& twist = at_.twist[t.first_node];
      rate = {turnRate(angular(twist), root->turn), velocityAt(twist, root->origin - at_.reference[tree])};
    }
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      sum_position_[k] += WEIGHT[stage] * at_.velocity[k];
      sum_velocity_[k] += WEIGHT[stage] * bodies_.acceleration()[k];
      sum_effort_[k] += WEIGHT[stage] * bodies_.effort(k);
    }
    sum.turn += WEIGHT[stage] * rate.turn;
    sum.origin += WEIGHT[stage] * rate.origin;
  }
  moveTo(dt, sum_position_, sum_velocity_, sum);
  for (int k = t.first_dof; k < t.dof_end; ++k) owed_[k] += dt * sum_effort_[k];
}

// Places the tree at the start of the step; a free tree seen from its centre of mass.
void FreeMotion::setOut(const FreeStart& start) {
  const auto& [forest, tree, dt, motion, velocity] = start;
  const ForestTree& t = forest.trees()[tree];
  std::copy(motion.position.begin() + t.first_node, motion.position.begin() + t.node_end, at_.position.begin() + t.first_node);
  at_.velocity.segment(t.first_dof, t.dofCount()) = velocity.segment(t.first_dof, t.dofCount());
  at_.reference[tree] = motion.reference[tree];
  bodies_.start(forest, tree);
  owed_.segment(t.first_dof, t.dofCount()).setZero();
  RootPose root{Eigen::Vector4d::UnitW(), Vector3::Zero()};
  if (t.free) {
    at_.velocity.segment<3>(t.first_dof + 3) -= drift_[tree];
    root = {Quaternion(motion.rotation[t.first_node]).coeffs(), motion.origin[t.first_node]};
  }
  place(forest, tree, root);
}

void FreeMotion::run(const FreeStart& start, int steps) {
  const ForestTree& t = start.forest.trees()[start.tree];
  setOut(start);
  RootPose root{Eigen::Vector4d::UnitW(), Vector3::Zero()};
  if (t.free) root = {Quaternion(start.motion.rotation[t.first_node]).coeffs(), start.motion.origin[t.first_node]};
  for (int i = 0; i < steps; ++i) subStep(start.forest, start.tree, start.dt / steps, &root);
}

double FreeMotion::energy(const Forest& forest, int tree) const {
  const ForestTree& t = forest.trees()[tree];
  double twice = 0;
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& n = forest.nodes()[i];
    twice += at_.twist[i].dot(at_.inertia[i].times(at_.twist[i]));
    if (n.dofs == 1) twice += n.armature * at_.velocity[n.first_dof] * at_.velocity[n.first_dof];
  }
  return 0.5 * twice;
}

double FreeMotion::work(const Forest& forest, int tree) const {
  const ForestTree& t = forest.trees()[tree];
  double sum = 0;
  for (int k = t.first_dof; k < t.dof_end; ++k)
    if (held()[k]) sum += owed_[k] * at_.velocity[k];
  return sum;
}

// Joints that would have to supply more than they can are held no longer, and those that follow them; those near their bounds may follow at
// the next try. What joints that follow another one supply counts as that one's.
bool FreeMotion::letGo(const Forest& forest, int tree) {
  const ForestTree& t = forest.trees()[tree];
  supplied_.segment(t.first_dof, t.dofCount()) = owed_.segment(t.first_dof, t.dofCount());
  forFollowers(forest, tree, [&](int dof, int master, double multiplier) { supplied_[master] += multiplier * owed_[dof]; });
  bool some = false;
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    if (!held()[k] || (supplied_[k] >= least[k] && supplied_[k] <= most[k])) continue;
    held()[k] = 0;
    some = true;
  }
  forFollowers(forest, tree, [&](int dof, int master, double) { held()[dof] &= held()[master]; });
  return some;
}

int FreeMotion::firstSteps(const Forest& forest, int tree, double dt) const {
  const ForestTree& t = forest.trees()[tree];
  double fastest = 0;
  for (int i = t.first_node; i < t.node_end; ++i) fastest = std::max(fastest, angular(at_.twist[i]).squaredNorm());
  const double steps = std::ceil(dt * std::sqrt(fastest) / SUB_STEP_TURN);
  return steps < MAX_SUB_STEPS ? std::max(1, static_cast<int>(steps)) : MAX_SUB_STEPS;
}

FreeMotionReport FreeMotion::follow(const FreeStart& start, const Eigen::VectorXd& mass_velocity) {
  const auto& [forest, tree, dt, motion, velocity] = start;
  const ForestTree& t = forest.trees()[tree];
  if (t.free) {
    const Vector6 momentum = mass_velocity.segment<6>(t.first_dof);
    drift_[tree] = linear(momentum) / motion.composite[t.first_node].mass;
    spin_[tree] = angular(momentum) - motion.tree_com[tree].cross(linear(momentum));
  }
  FreeMotionReport report;
  setOut(start);
  if (t.free && t.dofCount() == 6) {
    turnRigid(start);
    leaveFrame(start);
    return report;
  }
  const double first = energy(forest, tree);
  double wanted = first;
  for (int steps = firstSteps(forest, tree, dt);; steps = moreSteps(steps, report.miss)) {
    run(start, steps);
    report.evaluations += 4 * steps;
    if (letGo(forest, tree)) {
      run(start, steps);
      report.evaluations += 4 * steps;
    }
    wanted = first + work(forest, tree);
    report.miss = first > 0 ? std::abs(energy(forest, tree) - wanted) / first : 0;
    if (report.miss <= ENERGY_MISS || steps == MAX_SUB_STEPS) break;
  }
  report.followed = report.miss <= TOO_INEXACT;
  if (report.followed)
    correct(forest, tree, wanted);
  else
    wait(start);
  leaveFrame(start);
  return report;
}

// Way of a tree that sub-steps cannot follow: it keeps its shape for this step, turns as one body, and its joints lose half their speed.
// Momenta are kept, energy is lost.
void FreeMotion::wait(const FreeStart& start) {
  const auto& [forest, tree, dt, motion, velocity] = start;
  const ForestTree& t = forest.trees()[tree];
  setOut(start);
  if (t.free) {
    const Vector3& com = motion.tree_com[tree];
    const Vector6 first = at_.velocity.segment<6>(t.first_dof);
    const Vector6 inner = first - turnAbout(centralInertia(motion.composite[t.first_node]).llt().solve(spin_[tree]), com);
    const Matrix3 turn = turnRigid(start);
    const Vector3 spin = turn * angular(inner), at_com = turn * velocityAt(inner, com);
    at_.velocity.segment<6>(t.first_dof) += 0.5 * (turnAbout(spin, com) + spatial(Vector3::Zero(), at_com));
  }
  for (int k = t.free ? t.first_dof + 6 : t.first_dof; k < t.dof_end; ++k) at_.velocity[k] *= 0.5;
  computeTwists(forest, tree, at_, at_.velocity, &at_.twist);
}

// Puts right a free tree's momenta by moving all of it, and the energy by faster or slower joints: the same way at another speed.
void FreeMotion::correct(const Forest& forest, int tree, double energy_wanted) {
  const ForestTree& t = forest.trees()[tree];
  Vector6 locked = Vector6::Zero();
  double locked_energy = 0;
  if (t.free) {
    SpatialInertia whole;
    Vector6 missing = spatial(spin_[tree], Vector3::Zero());
    for (int i = t.first_node; i < t.node_end; ++i) {
      whole.add(at_.inertia[i]);
      missing -= at_.inertia[i].times(at_.twist[i]);
    }
    const Vector3 com = whole.first_moment / whole.mass;
    const Eigen::LLT<Matrix3> central(centralInertia(whole));
    const Vector3 locked_spin = central.solve(spin_[tree]), spin = central.solve(angular(missing) - com.cross(linear(missing)));
    locked = turnAbout(locked_spin, com);
    locked_energy = 0.5 * spin_[tree].dot(locked_spin);
    at_.velocity.segment<6>(t.first_dof) += turnAbout(spin, com) + spatial(Vector3::Zero(), linear(missing) / whole.mass);
    computeTwists(forest, tree, at_, at_.velocity, &at_.twist);
  }
  if (std::any_of(held().begin() + t.first_dof, held().begin() + t.dof_end, [](char h) { return h != 0; })) return;
  const double inner = energy(forest, tree) - locked_energy, ratio = (energy_wanted - locked_energy) / inner;
  if (!(inner > 0)) return;
  const double speed = std::sqrt(std::clamp(ratio, 0.0, FASTER));
  at_.velocity.segment(t.first_dof, t.dofCount()) *= speed;
  if (t.free) at_.velocity.segment<6>(t.first_dof) += (1 - speed) * locked;
  computeTwists(forest, tree, at_, at_.velocity, &at_.twist);
}

// Back to world axes at rest: a free tree's centre of mass has moved straight on.
void FreeMotion::leaveFrame(const FreeStart& start) {
  const int tree = start.tree;
  const ForestTree& t = start.forest.trees()[tree];
  if (!t.free) return;
  Vector3 moment = Vector3::Zero();
  double mass = 0;
  for (int i = t.first_node; i < t.node_end; ++i) {
    moment += at_.inertia[i].first_moment;
    mass += at_.inertia[i].mass;
  }
  const Vector3 shift = start.motion.tree_com[tree] + start.dt * drift_[tree] - moment / mass;
  for (int i = t.first_node; i < t.node_end; ++i) {
    at_.origin[i] += shift;
    at_.joint_origin[i] += shift;
    at_.com[i] += shift;
    const Vector3 spin = angular(at_.twist[i]);
    at_.twist[i] = spatial(spin, linear(at_.twist[i]) + drift_[tree] - spin.cross(shift));
  }
}

// Turns a free tree as one body through the step. @return its turn
Matrix3 FreeMotion::turnRigid(const FreeStart& start) {
  const auto& [forest, tree, dt, motion, velocity] = start;
  const ForestTree& t = forest.trees()[tree];
  const RigidTurn way = turnFreely(centralInertia(motion.composite[t.first_node]), spin_[tree], dt);
  const Vector3 com = motion.reference[tree] + motion.tree_com[tree];
  at_.velocity.segment<6>(t.first_dof) = turnAbout(way.spin, motion.tree_com[tree]);
  RootPose root;
  root.turn = Quaternion(Matrix3(way.turn * motion.rotation[t.first_node])).normalized().coeffs();
  root.origin = com + way.turn * (motion.origin[t.first_node] - com);
  place(forest, tree, root);
  return way.turn;
}

void FreeMotion::takeEnd(const Forest& forest, int tree, ForestMotion* motion) const {
  const ForestTree& t = forest.trees()[tree];
  std::copy(at_.position.begin() + t.first_node, at_.position.begin() + t.node_end, motion->position.begin() + t.first_node);
  motion->velocity.segment(t.first_dof, t.dofCount()) = at_.velocity.segment(t.first_dof, t.dofCount());
  motion->owed.segment(t.first_dof, t.dofCount()) = owed_.segment(t.first_dof, t.dofCount());
  if (!t.free) return;
  const Vector6& twist = at_.twist[t.first_node];
  motion->velocity.segment<6>(t.first_dof) = spatial(angular(twist), velocityAt(twist, at_.com[t.first_node]));
  motion->rotation[t.first_node] = at_.rotation[t.first_node];
  motion->origin[t.first_node] = at_.origin[t.first_node];
}

Vector6 FreeMotion::momentumRate(const Forest& forest, int node, double dt, const ForestMotion& motion, const Vector6& set_out) const {
  const geometry::MassProperties& body = forest.nodes()[node].inertial;
  const auto spin = [&](const ForestMotion& m, const Vector6& twist) {
    return Vector3(m.rotation[node] * (body.inertia * (m.rotation[node].transpose() * angular(twist))));
  };
  const Vector3 velocity = velocityAt(at_.twist[node], at_.com[node]) - velocityAt(set_out, motion.com[node]);
  const Vector3 force = body.mass / dt * velocity, middle = 0.5 * (motion.com[node] + at_.com[node]);
  return spatial(middle.cross(force) + (spin(at_, at_.twist[node]) - spin(motion, set_out)) / dt, force);
}

Vector3 FreeMotion::middleJoint(int node, const ForestMotion& motion) const {
  return 0.5 * (motion.joint_origin[node] + at_.joint_origin[node]);
}

}  // namespace blem_sim::dynamics
