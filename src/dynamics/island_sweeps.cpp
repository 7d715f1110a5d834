#include "island_sweeps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

namespace blem_sim {
namespace {

constexpr int COLOURS = 64;               // beyond, patches of one body take turns one by one
constexpr double LOOP_SOFTNESS = 1e-9;    // of the largest response: rows that depend on each other

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

bool IslandSweeps::load(const SweepProblem& problem, bool from_previous, Eigen::VectorXd* velocity) {
  problem_.emplace(problem);
  if (!loadResponse(problem, *velocity)) return false;
  pairs_.clear();
  for (const ContactPatch& patch : problem.patches)
    pairs_.push_back({patch.pair, response_.side(patch.pair.a), response_.side(patch.pair.b)});
  loadJoints(from_previous);
  loadLoops(from_previous);
  orderPatches(problem.up);
  colourPatches();
  layGroups();
  loadContacts(from_previous);
  findVelocity(velocity);
  search_.assign(dofs_.size(), 0);
  return true;
}

IslandSweeps::Motor IslandSweeps::motorAt(const JointTerm& joint, double velocity) {
  const double wanted = joint.motor_gain * (joint.motor_velocity - velocity);
  return wanted > joint.motor_bound ? Motor::HIGH : wanted < -joint.motor_bound ? Motor::LOW : Motor::FREE;
}

bool IslandSweeps::motorsAgree(const Eigen::VectorXd& velocity) const {
  for (std::size_t i = 0; i < motors_.size(); ++i)
    if (motorAt(problem_->joints[i], velocity[problem_->joints[i].dof]) != motors_[i]) return false;
  return true;
}

bool IslandSweeps::loadResponse(const SweepProblem& problem, const Eigen::VectorXd& velocity) {
  response_.start(problem.forest, problem.motion, problem.trees, problem.mimics);
  gains_.resize(velocity.size());
  momentum_.resize(velocity.size());
  dofs_.clear();
  for (const int tree : problem.trees) {
    const ForestTree& t = problem.forest.trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      dofs_.push_back(k);
      gains_[k] = 0;
      momentum_[k] = problem.free_momentum[k];
    }
  }
  motors_.clear();
  for (const JointTerm& j : problem.joints) {
    const Motor motor = motorAt(j, velocity[j.dof]);
    motors_.push_back(motor);
    gains_[j.dof] = j.viscous + (motor == Motor::FREE ? j.motor_gain : 0);
    const double at_bound = motor == Motor::HIGH ? j.motor_bound : -j.motor_bound;
    momentum_[j.dof] += motor == Motor::FREE ? j.motor_gain * j.motor_velocity : at_bound;
  }
  return response_.factor(gains_);
}

void IslandSweeps::loadJoints(bool from_previous) {
  joint_rows_.clear();
  for (std::size_t i = 0; i < problem_->joints.size(); ++i) {
    const JointTerm& j = problem_->joints[i];
    if (!(j.dry_bound > 0) && !(j.limit_gain > 0)) continue;
    JointRow row;
    row.term = static_cast<int>(i);
    row.dof = j.dof;
    row.unit = response_.unitOf(problem_->forest.nodeOfDof(j.dof));
    row.column = response_.column(j.dof);
    row.response = response_.entry(row.column, response_.units()[row.unit].rowOf(j.dof));
    row.dry = from_previous ? j.dry_previous : 0;
    row.lower = from_previous ? j.lower_previous : 0;
    row.upper = from_previous ? j.upper_previous : 0;
    if (row.response > 0) joint_rows_.push_back(row);
  }
}

void IslandSweeps::loadLoops(bool from_previous) {
  loop_pairs_.clear();
  loop_rows_.clear();
  for (std::size_t l = 0; l < problem_->loops.size(); ++l) {
    const LoopTerm& loop = problem_->loops[l];
    const BodyPair& pair = problem_->loop_pairs[l];
    loop_pairs_.push_back({pair, response_.side(pair.a), response_.side(pair.b)});
    const Matrix6 response = response_.relative(pair, loop_pairs_.back().a, loop_pairs_.back().b);
    const Matrix6 along = loop.basis.transpose() * response * loop.basis;
    LoopRow row;
    Matrix6 forbidden = Matrix6::Identity();
    const double softness = LOOP_SOFTNESS * along.diagonal().maxCoeff();
    for (int r = 0; r < loop.rows; ++r) {
      if (!std::isfinite(loop.rho[r])) continue;
      for (int c = 0; c < loop.rows; ++c)
        if (std::isfinite(loop.rho[c])) forbidden(r, c) = along(r, c);
      forbidden(r, r) += softness;
    }
    row.inverse = forbidden.inverse();
    for (int r = 0; r < 6; ++r)
      if (r >= loop.rows || !std::isfinite(loop.rho[r])) row.inverse.row(r).setZero();
    row.axis_response = along(5, 5);
    row.impulse = from_previous ? loop.previous : Vector6::Zero();
    if (loop.rows < 6) row.impulse[5] = 0;
    row.motor = 0;
    row.dry = from_previous ? loop.drive.dry_previous : 0;
    row.lower = from_previous ? loop.drive.lower_previous : 0;
    row.upper = from_previous ? loop.drive.upper_previous : 0;
    loop_rows_.push_back(row);
  }
}

// From the ground up.
void IslandSweeps::orderPatches(const Vector3& up) {
  heights_.clear();
  for (const ContactPatch& patch : problem_->patches) {
    const Vector3& reference = problem_->motion.reference[problem_->forest.nodes()[patch.pair.a].tree];
    heights_.push_back(up.dot(reference + problem_->contacts[patch.first].point));
  }
  order_.resize(heights_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(),
            [this](int a, int b) { return heights_[a] < heights_[b] || (heights_[a] == heights_[b] && a < b); });
}

// Patches of one colour have no body in common; the last colour's are those that found none, and take turns.
void IslandSweeps::colourPatches() {
  used_colours_.assign(response_.movers(), 0);
  colour_.resize(order_.size());
  for (const int p : order_) {
    std::uint64_t used = used_colours_[response_.moverOf(pairs_[p].a)];
    const bool two = pairs_[p].pair.b >= 0;
    if (two) used |= used_colours_[response_.moverOf(pairs_[p].b)];
    int colour = 0;
    while (colour < COLOURS && (used >> colour & 1)) ++colour;
    colour_[p] = colour;
    if (colour == COLOURS) continue;
    used_colours_[response_.moverOf(pairs_[p].a)] |= std::uint64_t{1} << colour;
    if (two) used_colours_[response_.moverOf(pairs_[p].b)] |= std::uint64_t{1} << colour;
  }
}

void IslandSweeps::layGroups() {
  groups_.clear();
  std::size_t count = 0;
  colour_start_.assign(COLOURS + 2, 0);
  for (const int p : order_) ++colour_start_[colour_[p] + 1];
  for (int c = 0; c <= COLOURS; ++c) colour_start_[c + 1] += colour_start_[c];
  by_colour_.resize(order_.size());
  chosen_.assign(colour_start_.begin(), colour_start_.end() - 1);
  for (const int p : order_) by_colour_[chosen_[colour_[p]]++] = p;
  const auto contactsOf = [this](int p) { return problem_->patches[p].end - problem_->patches[p].first; };
  for (int c = 0; c <= COLOURS; ++c) {
    const auto begin = by_colour_.begin() + colour_start_[c], end = by_colour_.begin() + colour_start_[c + 1];
    if (c < COLOURS)
      std::sort(begin, end, [&](int a, int b) { return contactsOf(a) > contactsOf(b) || (contactsOf(a) == contactsOf(b) && a < b); });
    const int width = c < COLOURS ? LANES : 1;
    for (auto p = begin; p != end;) {
      SweepGroup group;
      group.first = static_cast<int>(count);
      int longest = 0;
      for (int lane = 0; lane < LANES; ++lane) {
        group.patch[lane] = lane < width && p != end ? *p++ : -1;
        if (group.patch[lane] >= 0) longest = std::max(longest, contactsOf(group.patch[lane]));
      }
      count += longest;
      group.end = static_cast<int>(count);
      groups_.push_back(group);
    }
  }
  contacts_.resize(count);
  impulses_.resize(count);
  changes_.resize(groups_.size());
}

void IslandSweeps::loadContacts(bool from_previous) {
  for (SweepGroup& group : groups_) {
    for (int lane = 0; lane < LANES; ++lane) {
      const int p = group.patch[lane];
      Matrix6 response = Matrix6::Identity();
      if (p >= 0) response = response_.relative(pairs_[p].pair, pairs_[p].a, pairs_[p].b);
      for (int r = 0, at = 0; r < 6; ++r)
        for (int c = 0; c <= r; ++c, ++at) group.response[at][lane] = response(r, c);
      for (int i = group.first; i < group.end; ++i) {
        const int contact = p < 0 ? -1 : problem_->patches[p].first + i - group.first;
        const bool exists = contact >= 0 && contact < problem_->patches[p].end;
        setLane(exists ? &problem_->contacts[contact] : nullptr, lane, &contacts_[i], &impulses_[i]);
      }
    }
    setGains(group, contacts_.data() + group.first, contacts_.data() + group.end);
  }
  if (!from_previous) blem_sim::scale(0, impulses_.data(), impulses_.data() + impulses_.size());
}

// Of the impulses at hand.
void IslandSweeps::findVelocity(Eigen::VectorXd* velocity) {
  response_.freeVelocity(momentum_, velocity);
  TwistLanes wrench;
  for (const SweepGroup& group : groups_) {
    wrenchOf(contacts_.data() + group.first, contacts_.data() + group.end, impulses_.data() + group.first, &wrench);
    for (int lane = 0; lane < LANES; ++lane)
      if (group.patch[lane] >= 0) push(pairs_[group.patch[lane]], columnOf(wrench, lane), velocity);
  }
  for (const JointRow& row : joint_rows_) response_.push(row.unit, row.column, row.dry + row.lower - row.upper, velocity);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    const LoopRow& row = loop_rows_[l];
    Vector6 impulse = row.impulse;
    if (problem_->loops[l].rows < 6) impulse[5] = row.motor + row.dry + row.lower - row.upper;
    push(loop_pairs_[l], problem_->loops[l].basis * impulse, velocity);
  }
}

void IslandSweeps::sweepJoints(Eigen::VectorXd* velocity) {
  for (JointRow& row : joint_rows_) {
    const JointTerm& j = problem_->joints[row.term];
    const double gain = 1 / row.response;
    double v = (*velocity)[row.dof], change = 0;
    const auto set = [&](double* impulse, double sign, double now) {
      const double by = sign * (now - *impulse);
      *impulse = now;
      change += by;
      v += row.response * by;
    };
    if (j.dry_bound > 0) set(&row.dry, 1, std::clamp(row.dry - gain * v, -j.dry_bound, j.dry_bound));
    if (j.limit_gain > 0) {
      set(&row.lower, 1, std::max(0.0, row.lower + gain * (j.lower_velocity - v)));
      set(&row.upper, -1, std::max(0.0, row.upper + gain * (v - j.upper_velocity)));
    }
    if (change != 0) response_.push(row.unit, row.column, change, velocity);
  }
}

void IslandSweeps::sweepLoops(Eigen::VectorXd* velocity) {
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    const LoopTerm& loop = problem_->loops[l];
    LoopRow& row = loop_rows_[l];
    const Vector6 forbidden = row.inverse * (loop.target - loop.basis.transpose() * relativeTwist(loop_pairs_[l], *velocity));
    row.impulse += forbidden;
    push(loop_pairs_[l], loop.basis * forbidden, velocity);
    if (loop.rows == 6 || !(row.axis_response > 0)) continue;
    const JointTerm& j = loop.drive;
    double v = (loop.basis.transpose() * relativeTwist(loop_pairs_[l], *velocity))[5], change = 0;
    const double gain = 1 / row.axis_response;
    const auto set = [&](double* impulse, double sign, double now) {
      const double by = sign * (now - *impulse);
      *impulse = now;
      change += by;
      v += row.axis_response * by;
    };
    const double stiffness = j.motor_gain;
    if (stiffness > 0) {
      const double wanted = row.motor + (stiffness * (j.motor_velocity - v) - row.motor) / (1 + stiffness * row.axis_response);
      set(&row.motor, 1, std::clamp(wanted, -j.motor_bound, j.motor_bound));
    }
    if (j.dry_bound > 0) set(&row.dry, 1, std::clamp(row.dry - gain * v, -j.dry_bound, j.dry_bound));
    if (j.limit_gain > 0) {
      set(&row.lower, 1, std::max(0.0, row.lower + gain * (j.lower_velocity - v)));
      set(&row.upper, -1, std::max(0.0, row.upper + gain * (v - j.upper_velocity)));
    }
    push(loop_pairs_[l], change * loop.basis.col(5), velocity);
  }
}

// The relative twist of a pair; of free bodies number by number, since this is the innermost loop beside the contacts.
void IslandSweeps::gather(const Pair& pair, int lane, const Eigen::VectorXd& velocity, TwistLanes* twist) const {
  if (pair.a.unit >= 0 || pair.b.unit >= 0) {
    const Vector6 relative = relativeTwist(pair, velocity);
    for (int i = 0; i < 6; ++i) (*twist)[i][lane] = relative[i];
    return;
  }
  const double* a = velocity.data() + pair.a.first_dof;
  for (int i = 0; i < 6; ++i) (*twist)[i][lane] = a[i];
  if (pair.pair.b < 0) return;
  const double* b = velocity.data() + pair.b.first_dof;
  const Vector3& shift = pair.pair.shift;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
    (*twist)[i][lane] -= b[i];
    (*twist)[3 + i][lane] -= b[3 + i] - (b[j] * shift[k] - b[k] * shift[j]);
  }
}

void IslandSweeps::scatter(const Pair& pair, int lane, const TwistLanes& wrench, Eigen::VectorXd* velocity) const {
  if (pair.a.unit >= 0 || pair.b.unit >= 0) return push(pair, columnOf(wrench, lane), velocity);
  const Vector3 torque(wrench[0][lane], wrench[1][lane], wrench[2][lane]), force(wrench[3][lane], wrench[4][lane], wrench[5][lane]);
  response_.pushFree(pair.a, torque, force, velocity->data());
  if (pair.pair.b >= 0) response_.pushFree(pair.b, crossProduct(pair.pair.shift, force) - torque, -force, velocity->data());
}

void IslandSweeps::sweepGroup(std::size_t index, Eigen::VectorXd* velocity) {
  const SweepGroup& group = groups_[index];
  TwistLanes twist, wrench;
  for (int lane = 0; lane < LANES; ++lane) {
    const int p = group.patch[lane];
    if (p < 0)
      for (int i = 0; i < 6; ++i) twist[i][lane] = 0;
    else
      gather(pairs_[p], lane, *velocity, &twist);
  }
  blem_sim::sweep(group, contacts_.data() + group.first, contacts_.data() + group.end, impulses_.data() + group.first, twist, &wrench,
                  &changes_[index]);
  for (int lane = 0; lane < LANES; ++lane)
    if (group.patch[lane] >= 0) scatter(pairs_[group.patch[lane]], lane, wrench, velocity);
}

void IslandSweeps::plainSweep(Eigen::VectorXd* velocity) {
  sweepJoints(velocity);
  sweepLoops(velocity);
  for (std::size_t g = 0; g < groups_.size(); ++g) sweepGroup(g, velocity);
  change_ = SweepChange();
  for (const SweepChange& group : changes_) {
    change_.squared += group.squared;
    change_.largest = std::max(change_.largest, group.largest);
    change_.impulse = std::max(change_.impulse, group.impulse);
  }
}

// Impulses and velocities move on by `share` of the last search direction, which what the last sweep changed joins.
void IslandSweeps::moveOn(double share, Eigen::VectorXd* velocity) {
  blem_sim::moveOn(share, impulses_.data(), impulses_.data() + impulses_.size());
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    double& v = (*velocity)[dofs_[i]];
    const double along = share * search_[i], change = v - before_[i];
    v += along;
    search_[i] = along + change;
  }
}

SweepReport IslandSweeps::sweep(int most, double enough, Eigen::VectorXd* velocity) {
  SweepReport report;
  double last = 0;
  before_.resize(dofs_.size());
  const bool conjugate = joint_rows_.empty() && loop_rows_.empty();
  while (report.sweeps < most) {
    for (std::size_t i = 0; i < dofs_.size(); ++i) before_[i] = (*velocity)[dofs_[i]];
    plainSweep(velocity);
    const double relative = change_.impulse > 0 ? std::sqrt(change_.largest / change_.impulse) : 0;
    if (report.sweeps++ == 0) report.first_change = relative;
    report.last_change = relative;
    // The last sweep is a plain one: conjugate steps lead out of the cones.
    if (relative <= enough || report.sweeps == most) break;
    if (!conjugate) continue;
    const double share = last > 0 ? change_.squared / last : 0;
    moveOn(share <= 1 ? share : 0, velocity);
    last = change_.squared;
  }
  findVelocity(velocity);
  return report;
}

void IslandSweeps::scale(double factor, Eigen::VectorXd* velocity) {
  blem_sim::scale(factor, impulses_.data(), impulses_.data() + impulses_.size());
  for (JointRow& row : joint_rows_)
    for (double* impulse : {&row.dry, &row.lower, &row.upper}) *impulse *= factor;
  for (LoopRow& row : loop_rows_) {
    row.impulse *= factor;
    for (double* impulse : {&row.motor, &row.dry, &row.lower, &row.upper}) *impulse *= factor;
  }
  findVelocity(velocity);
}

void IslandSweeps::read(const Eigen::VectorXd& velocity, std::vector<ContactTerm>* contacts, std::vector<JointTerm>* joints,
                        std::vector<LoopTerm>* loops) const {
  for (const SweepGroup& group : groups_) {
    for (int lane = 0; lane < LANES; ++lane) {
      if (group.patch[lane] < 0) continue;
      const ContactPatch& patch = problem_->patches[group.patch[lane]];
      for (int i = patch.first; i < patch.end; ++i) {
        const int at = group.first + i - patch.first;
        (*contacts)[i].impulse = readLane(contacts_[at], impulses_[at], lane);
      }
    }
  }
  const auto adopt = [](double dry, double lower, double upper, double v, JointTerm* j) {
    j->dry_previous = dry + j->dry_gain / j->softness * v;
    const double gain = j->limit_gain / j->softness;
    j->lower_previous = lower > 0 ? lower - gain * (j->lower_velocity - v) : 0;
    j->upper_previous = upper > 0 ? upper - gain * (v - j->upper_velocity) : 0;
  };
  for (const JointRow& row : joint_rows_) adopt(row.dry, row.lower, row.upper, velocity[row.dof], &(*joints)[row.term]);
  for (std::size_t l = 0; l < loop_rows_.size(); ++l) {
    LoopTerm& loop = (*loops)[l];
    const LoopRow& row = loop_rows_[l];
    const Vector6 v = loop.basis.transpose() * relativeTwist(loop_pairs_[l], velocity);
    for (int r = 0; r < loop.rows; ++r)
      if (std::isfinite(loop.rho[r])) loop.previous[r] = row.impulse[r] - (loop.target[r] - v[r]) / loop.rho[r];
    if (loop.rows < 6) adopt(row.dry, row.lower, row.upper, v[5], &loop.drive);
  }
}

}  // namespace blem_sim
