#include "island/island_sweeps.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr std::size_t GROUPS_AT_ONCE = 8, IMPULSES_AT_ONCE = 256, DOFS_AT_ONCE = 1024;  // sizes of chunks: some microseconds each

Vector6 columnOf(const TwistLanes& lanes, int lane) {
  Vector6 out;
  for (int i = 0; i < 6; ++i) out[i] = lanes[i][lane];
  return out;
}

}  // namespace

Vector6 IslandSweeps::relativeTwist(const Pair& pair, const Eigen::VectorXd& velocity) const {
  const Vector6 a = response_.twist(pair.a, velocity);
  if (pair.pair.b < 0) return a;
  return a - moveTwist(response_.twist(pair.b, velocity), -pair.pair.shift);
}

void IslandSweeps::push(const Pair& pair, const Vector6& wrench, Eigen::VectorXd* velocity) const {
  response_.push(pair.a, wrench, velocity);
  if (pair.pair.b >= 0) response_.push(pair.b, -moveWrench(wrench, -pair.pair.shift), velocity);
}

bool IslandSweeps::load(const IslandAtHand& island, SweepStart start, Eigen::VectorXd* velocity) {
  island_ = &island;
  if (!loadResponse(*velocity)) return false;
  pairs_.clear();
  for (const ContactPatch& patch : island.model.patches)
    pairs_.push_back({patch.pair, response_.side(patch.pair.a), response_.side(patch.pair.b)});
  loadJoints(start);
  loadLoops(start);
  orderPatches(island.model.up);
  colourPatches();
  layGroups();
  loadContacts(start);
  findVelocity(velocity);
  search_.assign(dofs_.size(), 0);
  return true;
}

// Velocity with the impulses at hand.
void IslandSweeps::findVelocity(Eigen::VectorXd* velocity) {
  response_.freeVelocity(momentum_, velocity);
  TwistLanes wrench;
  for (const SweepGroup& group : groups_) {
    wrenchOf(contacts_.data() + group.first, contacts_.data() + group.end, impulses_.data() + group.first, &wrench);
    for (int lane = 0; lane < SWEEP_LANES; ++lane)
      if (group.patch[lane] >= 0) push(pairs_[group.patch[lane]], columnOf(wrench, lane), velocity);
  }
  for (const JointRow& row : joint_rows_) response_.push(row.unit, row.column, row.axis.sum(), velocity);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    const LoopRow& row = loop_rows_[l];
    Vector6 impulse = row.impulse;
    if (island_->terms()->loops[l].rows < 6) impulse[5] = row.axis.sum();
    push(loop_pairs_[l], island_->terms()->loops[l].basis * impulse, velocity);
  }
}

double IslandSweeps::AxisRow::visit(const JointTerm& joint, double v, double change) {
  const double gain = 1 / response;
  const auto set = [&](double* impulse, double sign, double now) {
    const double by = sign * (now - *impulse);
    *impulse = now;
    change += by;
    v += response * by;
  };
  if (joint.dry_bound > 0) set(&dry, 1, std::clamp(dry - gain * v, -joint.dry_bound, joint.dry_bound));
  if (joint.limit_gain > 0) {
    set(&lower, 1, std::max(0.0, lower + gain * (joint.lower_velocity - v)));
    set(&upper, -1, std::max(0.0, upper + gain * (v - joint.upper_velocity)));
  }
  return change;
}

double IslandSweeps::AxisRow::visitMotor(const JointTerm& joint, double v) {
  const double gain = joint.motor_gain, before = motor;
  if (!(gain > 0)) return 0;
  const double wanted = motor + (gain * (joint.motor_velocity - v) - motor) / (1 + gain * response);
  motor = std::clamp(wanted, -joint.motor_bound, joint.motor_bound);
  return motor - before;
}

void IslandSweeps::AxisRow::scale(double factor) {
  for (double* impulse : {&motor, &dry, &lower, &upper}) *impulse *= factor;
}

void IslandSweeps::sweepJoints(Eigen::VectorXd* velocity) {
  for (JointRow& row : joint_rows_) {
    const double change = row.axis.visit(island_->terms()->joints[row.term], (*velocity)[row.dof]);
    if (change != 0) response_.push(row.unit, row.column, change, velocity);
  }
}

void IslandSweeps::sweepLoops(Eigen::VectorXd* velocity) {
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    const LoopTerm& loop = island_->terms()->loops[l];
    LoopRow& row = loop_rows_[l];
    const Vector6 forbidden = row.inverse * (loop.target - loop.basis.transpose() * relativeTwist(loop_pairs_[l], *velocity));
    row.impulse += forbidden;
    push(loop_pairs_[l], loop.basis * forbidden, velocity);
    if (loop.rows == 6 || !(row.axis.response > 0)) continue;
    const double v = (loop.basis.transpose() * relativeTwist(loop_pairs_[l], *velocity))[5];
    const double by_motor = row.axis.visitMotor(loop.drive, v);
    const double change = row.axis.visit(loop.drive, v + row.axis.response * by_motor, by_motor);
    push(loop_pairs_[l], change * loop.basis.col(5), velocity);
  }
}

// Sweeps a group in which a tree takes part.
void IslandSweeps::sweepTrees(std::size_t index, Eigen::VectorXd* velocity) {
  const SweepGroup& group = groups_[index];
  TwistLanes twist = {}, wrench;
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    if (group.patch[lane] < 0) continue;
    const Vector6 relative = relativeTwist(pairs_[group.patch[lane]], *velocity);
    for (int i = 0; i < 6; ++i) twist[i][lane] = relative[i];
  }
  blem_sim::dynamics::sweep(group, contacts_.data() + group.first, contacts_.data() + group.end, impulses_.data() + group.first, twist,
                            &wrench, &changes_[index]);
  for (int lane = 0; lane < SWEEP_LANES; ++lane)
    if (group.patch[lane] >= 0) push(pairs_[group.patch[lane]], columnOf(wrench, lane), velocity);
}

void IslandSweeps::sweepGroup(std::size_t index, Eigen::VectorXd* velocity) {
  const SweepGroup& group = groups_[index];
  if (!group.free) return sweepTrees(index, velocity);
  sweepFree(bodies_[index], contacts_.data() + group.first, contacts_.data() + group.end, impulses_.data() + group.first, velocity->data(),
            &changes_[index]);
}

// Groups of one colour have no body in common, so threads share them. Groups of the last colour may have: one thread sweeps them.
void IslandSweeps::sweepColour(std::size_t colour, Eigen::VectorXd* velocity) {
  const std::size_t begin = group_start_[colour], end = group_start_[colour + 1];
  const bool shared = colour + 2 < group_start_.size();
  island_->team->forRanges(begin, end, shared ? GROUPS_AT_ONCE : end - begin, [&](std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) sweepGroup(g, velocity);
  });
}

void IslandSweeps::plainSweep(Eigen::VectorXd* velocity) {
  sweepJoints(velocity);
  sweepLoops(velocity);
  for (std::size_t c = 0; c + 1 < group_start_.size(); ++c) sweepColour(c, velocity);
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
    blem_sim::dynamics::moveOn(share, impulses_.data() + first, impulses_.data() + last);
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
  double last = 0;
  before_.resize(dofs_.size());
  const bool conjugate = joint_rows_.empty() && loop_rows_.empty();
  while (report.sweeps < most) {
    noteVelocity(*velocity);
    plainSweep(velocity);
    const double relative = change_.impulse > 0 ? std::sqrt(change_.largest / change_.impulse) : 0;
    if (report.sweeps++ == 0) report.first_change = relative;
    report.last_change = relative;
    // The last sweep is a plain one: conjugate steps lead out of the cones.
    if (relative <= enough || report.sweeps == most) break;
    if (!conjugate) continue;
    const double share = last > 0 ? squared_change_ / last : 0;
    moveOn(share <= 1 ? share : 0, velocity);
    last = squared_change_;
  }
  findVelocity(velocity);
  return report;
}

void IslandSweeps::scale(double factor, Eigen::VectorXd* velocity) {
  blem_sim::dynamics::scale(factor, impulses_.data(), impulses_.data() + impulses_.size());
  for (JointRow& row : joint_rows_) row.axis.scale(factor);
  for (LoopRow& row : loop_rows_) {
    row.impulse *= factor;
    row.axis.scale(factor);
  }
  findVelocity(velocity);
}

void IslandSweeps::read(const Eigen::VectorXd& velocity, IslandTerms* terms) const {
  for (const SweepGroup& group : groups_) {
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      if (group.patch[lane] < 0) continue;
      const ContactPatch& patch = island_->model.patches[group.patch[lane]];
      for (int i = patch.first; i < patch.end; ++i) {
        const int at = group.first + i - patch.first;
        terms->contacts[i].impulse = readLane(contacts_[at], impulses_[at], lane);
      }
    }
  }
  const auto adopt = [](const AxisRow& row, double v, JointTerm* j) {
    j->dry_previous = row.dry + j->dry_gain / j->softness * v;
    const double gain = j->limit_gain / j->softness;
    j->lower_previous = row.lower > 0 ? row.lower - gain * (j->lower_velocity - v) : 0;
    j->upper_previous = row.upper > 0 ? row.upper - gain * (v - j->upper_velocity) : 0;
  };
  for (const JointRow& row : joint_rows_) adopt(row.axis, velocity[row.dof], &terms->joints[row.term]);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    LoopTerm& loop = terms->loops[l];
    const LoopRow& row = loop_rows_[l];
    const Vector6 v = loop.basis.transpose() * relativeTwist(loop_pairs_[l], velocity);
    for (int r = 0; r < loop.rows; ++r)
      if (std::isfinite(loop.rho[r])) loop.previous[r] = row.impulse[r] - (loop.target[r] - v[r]) / loop.rho[r];
    if (loop.rows < 6) adopt(row.axis, v[5], &loop.drive);
  }
}

}  // namespace blem_sim::dynamics
