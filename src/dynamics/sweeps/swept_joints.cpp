#include "sweeps/swept_joints.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr double LOOP_SOFTNESS = 1e-9;  // of the largest response: rows that depend on each other

// Inverse of the response of a loop's forbidden rows, zero elsewhere. @param along all rows' response
Matrix6 forbiddenInverse(const LoopTerm& loop, const Matrix6& along) {
  const auto isRow = [&](int r) { return r < loop.rows && std::isfinite(loop.rho[r]); };
  Matrix6 forbidden = Matrix6::Identity();
  const double softness = LOOP_SOFTNESS * along.diagonal().maxCoeff();
  for (int r = 0; r < loop.rows; ++r) {
    if (!isRow(r)) continue;
    for (int c = 0; c < loop.rows; ++c)
      if (isRow(c)) forbidden(r, c) = along(r, c);
    forbidden(r, r) += softness;
  }
  Matrix6 inverse = forbidden.inverse();
  for (int r = 0; r < 6; ++r)
    if (!isRow(r)) inverse.row(r).setZero();
  return inverse;
}

}  // namespace

SweptJoints::AxisRow::AxisRow(const JointTerm& joint, double axis_response, SweepStart start) : response(axis_response) {
  if (start == SweepStart::NOTHING) return;
  dry = joint.dry_previous;
  lower = joint.lower_previous;
  upper = joint.upper_previous;
}

double SweptJoints::AxisRow::visit(const JointTerm& joint, bool has_motor, double v) {
  const double gain = 1 / response;
  double sum = 0;
  const auto set = [&](double* impulse, double sign, double now) {
    const double by = sign * (now - *impulse);
    *impulse = now;
    sum += by;
    v += response * by;
  };
  if (has_motor) set(&motor, 1, joint.motorImpulse(v - response * motor, response));
  if (joint.dry_bound > 0) set(&dry, 1, std::clamp(dry - gain * v, -joint.dry_bound, joint.dry_bound));
  if (joint.limit_gain > 0) {
    set(&lower, 1, std::max(0.0, lower + gain * (joint.lower_velocity - v)));
    set(&upper, -1, std::max(0.0, upper + gain * (v - joint.upper_velocity)));
  }
  return sum;
}

void SweptJoints::AxisRow::scale(double factor) {
  for (double* impulse : {&dry, &lower, &upper}) *impulse *= factor;
}

void SweptJoints::AxisRow::addWork(const JointTerm& joint, double free, double after, ImpulseWork* work) const {
  work->add(dry, free, after, 0);
  if (lower > 0) work->add(lower, free, after, lower * std::max(0.0, joint.lower_velocity));
  if (upper > 0) work->add(-upper, free, after, upper * std::max(0.0, -joint.upper_velocity));
}

void SweptJoints::AxisRow::lead(const SweepLead& lead) {
  double* of = before;
  for (double* impulse : {&motor, &dry, &lower, &upper}) lead.move(impulse, impulse + 1, of++);
}

void SweptJoints::AxisRow::read(double v, JointTerm* joint) const {
  // Friction that slips stays at its bound, whatever rounding does: short of it, it would be taken to stick.
  const double dry_by = joint->dry_gain / joint->softness * v;
  const bool sticks = std::abs(dry) < joint->dry_bound;
  joint->dry_previous = dry + (sticks ? dry_by : dry > 0 ? std::max(0.0, dry_by) : std::min(0.0, dry_by));
  const double gain = joint->limit_gain / joint->softness;
  joint->lower_previous = lower > 0 ? lower - gain * (joint->lower_velocity - v) : 0;
  joint->upper_previous = upper > 0 ? upper - gain * (v - joint->upper_velocity) : 0;
}

void SweptJoints::takeMotors(const IslandAtHand& island, const Eigen::VectorXd& velocity) {
  island_ = &island;
  motors_.clear();
  for (const JointTerm& j : island.terms()->joints) {
    const JointResponse line = j.motorLine(velocity[j.dof]);
    motors_.push_back({line, line.stiffness == 0 && line.impulse != 0});
  }
}

void SweptJoints::foldMotors(Eigen::VectorXd* gains, Eigen::VectorXd* momentum) const {
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const JointTerm& j = island_->terms()->joints[i];
    (*gains)[j.dof] = j.viscous + motors_[i].line.stiffness;
    if (!motors_[i].is_swept) (*momentum)[j.dof] += motors_[i].line.impulse;
  }
}

bool SweptJoints::motorsAgree(const Eigen::VectorXd& velocity) {
  const std::vector<JointTerm>& joints = island_->terms()->joints;
  bool agree = true;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const double v = velocity[joints[i].dof];
    if (motors_[i].is_swept || joints[i].motorLine(v) == motors_[i].line) continue;
    motors_[i] = {{joints[i].motorImpulse(v), 0}, true};
    agree = false;
  }
  // The impulse of a swept motor tells its piece. Its velocity does not: at the end of its velocities a millionth of one is all its effort.
  for (const JointRow& row : joint_rows_) {
    const JointTerm& j = joints[row.term];
    const double impulse = row.axis.motor, response = row.axis.response;
    if (!row.has_motor || std::abs(impulse) == j.motor_bound) continue;
    const JointResponse line = j.motorLine(velocity[row.dof] - response * impulse, response);
    motors_[row.term] = {line, line.stiffness == 0};
    agree = false;
  }
  return agree;
}

void SweptJoints::load(SweepStart start, IslandResponse* response) {
  joint_rows_.clear();
  loop_rows_.clear();
  for (std::size_t i = 0; i < island_->terms()->joints.size(); ++i) loadJoint(static_cast<int>(i), start, response);
  for (std::size_t l = 0; l < island_->terms()->loops.size(); ++l) loadLoop(l, start, response);
}

void SweptJoints::loadJoint(int term, SweepStart start, IslandResponse* response) {
  const JointTerm& j = island_->terms()->joints[term];
  const bool has_motor = motors_[term].is_swept;
  if (!has_motor && !(j.dry_bound > 0) && !(j.limit_gain > 0)) return;
  JointRow row;
  row.has_motor = has_motor;
  row.term = term;
  row.dof = j.dof;
  row.unit = response->unitOf(island_->forest.nodeOfDof(j.dof));
  row.column = response->column(j.dof);
  row.axis = AxisRow(j, response->entry(row.column, response->units()[row.unit].rowOf(j.dof)), start);
  if (has_motor) row.axis.motor = motors_[term].line.impulse;
  if (row.axis.response > 0) joint_rows_.push_back(row);
}

void SweptJoints::loadLoop(std::size_t index, SweepStart start, IslandResponse* response) {
  const LoopTerm& loop = island_->terms()->loops[index];
  LoopRow row;
  row.pair = response->pair(island_->model.loop_pairs[index]);
  const Matrix6 moves = response->relative(row.pair);
  const Matrix6 along = loop.basis.transpose() * moves * loop.basis;
  row.inverse = forbiddenInverse(loop, along);
  row.impulse = start == SweepStart::PREVIOUS ? loop.previous : Vector6::Zero();
  if (loop.rows < 6) row.impulse[5] = 0;
  row.axis = AxisRow(loop.drive, along(5, 5), start);
  loop_rows_.push_back(row);
}

void SweptJoints::lead(const SweepLead& lead) {
  for (JointRow& row : joint_rows_) row.axis.lead(lead);
  for (LoopRow& row : loop_rows_) {
    lead.move(row.impulse.data(), row.impulse.data() + row.impulse.size(), row.before);
    row.axis.lead(lead);
  }
}

void SweptJoints::sweep(const IslandResponse& response, Eigen::VectorXd* velocity) {
  for (JointRow& row : joint_rows_) {
    const double change = row.axis.visit(island_->terms()->joints[row.term], row.has_motor, (*velocity)[row.dof]);
    if (row.has_motor) motors_[row.term].line.impulse = row.axis.motor;
    if (change != 0) response.push(row.unit, row.column, change, velocity);
  }
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) sweepLoop(l, response, velocity);
}

void SweptJoints::sweepLoop(std::size_t index, const IslandResponse& response, Eigen::VectorXd* velocity) {
  const LoopTerm& loop = island_->terms()->loops[index];
  LoopRow& row = loop_rows_[index];
  const Vector6 forbidden = row.inverse * (loop.target - loop.basis.transpose() * response.relativeTwist(row.pair, *velocity));
  row.impulse += forbidden;
  response.push(row.pair, loop.basis * forbidden, velocity);
  if (loop.rows == 6 || !(row.axis.response > 0)) return;
  const double v = (loop.basis.transpose() * response.relativeTwist(row.pair, *velocity))[5];
  const double change = row.axis.visit(loop.drive, loop.drive.motor_gain > 0, v);
  response.push(row.pair, change * loop.basis.col(5), velocity);
}

void SweptJoints::push(const IslandResponse& response, Eigen::VectorXd* velocity) const {
  for (const JointRow& row : joint_rows_) response.push(row.unit, row.column, row.axis.sum(), velocity);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    const LoopRow& row = loop_rows_[l];
    const LoopTerm& loop = island_->terms()->loops[l];
    Vector6 impulse = row.impulse;
    if (loop.rows < 6) impulse[5] = row.axis.sum();
    response.push(row.pair, loop.basis * impulse, velocity);
  }
}

void SweptJoints::pushMotors(const IslandResponse& response, Eigen::VectorXd* velocity) const {
  for (const JointRow& row : joint_rows_) response.push(row.unit, row.column, row.axis.motor, velocity);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l)
    response.push(loop_rows_[l].pair, loop_rows_[l].axis.motor * island_->terms()->loops[l].basis.col(5), velocity);
}

void SweptJoints::scale(double factor) {
  for (JointRow& row : joint_rows_) row.axis.scale(factor);
  for (LoopRow& row : loop_rows_) {
    row.impulse *= factor;
    row.axis.scale(factor);
  }
}

void SweptJoints::addWork(const IslandResponse& response, const Eigen::VectorXd& free_velocity, const Eigen::VectorXd& velocity,
                          ImpulseWork* work) const {
  for (const JointRow& row : joint_rows_)
    row.axis.addWork(island_->terms()->joints[row.term], free_velocity[row.dof], velocity[row.dof], work);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    const LoopRow& row = loop_rows_[l];
    const LoopTerm& loop = island_->terms()->loops[l];
    const Vector6 free = loop.basis.transpose() * response.relativeTwist(row.pair, free_velocity);
    const Vector6 after = loop.basis.transpose() * response.relativeTwist(row.pair, velocity);
    for (int r = 0; r < loop.rows; ++r) work->add(row.impulse[r], free[r], after[r], std::max(0.0, row.impulse[r] * loop.target[r]));
    if (loop.rows < 6) row.axis.addWork(loop.drive, free[5], after[5], work);
  }
}

void SweptJoints::read(const IslandResponse& response, const Eigen::VectorXd& velocity, IslandTerms* terms) const {
  for (const JointRow& row : joint_rows_) row.axis.read(velocity[row.dof], &terms->joints[row.term]);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) readLoop(l, response, velocity, &terms->loops[l]);
}

void SweptJoints::readLoop(std::size_t index, const IslandResponse& response, const Eigen::VectorXd& velocity, LoopTerm* loop) const {
  const LoopRow& row = loop_rows_[index];
  const Vector6 v = loop->basis.transpose() * response.relativeTwist(row.pair, velocity);
  for (int r = 0; r < loop->rows; ++r)
    if (std::isfinite(loop->rho[r])) loop->previous[r] = row.impulse[r] - (loop->target[r] - v[r]) / loop->rho[r];
  if (loop->rows < 6) row.axis.read(v[5], &loop->drive);
}

}  // namespace blem_sim::dynamics
