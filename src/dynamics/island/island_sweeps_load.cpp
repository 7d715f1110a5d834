// Loads an island's terms for sweeps: responses, rows of joints and loops, contacts in groups of bodies of their own.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "island/island_sweeps.h"

namespace blem_sim::dynamics {
namespace {

constexpr int COLOURS = 64;             // beyond, patches of one body take turns one by one
constexpr double LOOP_SOFTNESS = 1e-9;  // of the largest response: rows that depend on each other

}  // namespace

bool IslandSweeps::motorsAgree(const Eigen::VectorXd& velocity) const {
  for (std::size_t i = 0; i < motors_.size(); ++i)
    if (!(island_->terms()->joints[i].motorLine(velocity[island_->terms()->joints[i].dof]) == motors_[i])) return false;
  return true;
}

bool IslandSweeps::loadResponse(const Eigen::VectorXd& velocity) {
  response_.start(island_->forest, island_->motion, island_->model.trees, island_->model.mimics);
  gains_.resize(velocity.size());
  momentum_.resize(velocity.size());
  dofs_.clear();
  for (const int tree : island_->model.trees) {
    const ForestTree& t = island_->forest.trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      dofs_.push_back(k);
      gains_[k] = 0;
      momentum_[k] = island_->space->free_momentum[k];
    }
  }
  motors_.clear();
  for (const JointTerm& j : island_->terms()->joints) {
    const JointResponse motor = j.motorLine(velocity[j.dof]);
    motors_.push_back(motor);
    gains_[j.dof] = j.viscous + motor.stiffness;
    momentum_[j.dof] += motor.impulse;
  }
  return response_.factor(gains_);
}

IslandSweeps::AxisRow::AxisRow(const JointTerm& joint, double axis_response, SweepStart start) : response(axis_response) {
  if (start == SweepStart::NOTHING) return;
  dry = joint.dry_previous;
  lower = joint.lower_previous;
  upper = joint.upper_previous;
}

void IslandSweeps::loadJoints(SweepStart start) {
  joint_rows_.clear();
  for (std::size_t i = 0; i < island_->terms()->joints.size(); ++i) {
    const JointTerm& j = island_->terms()->joints[i];
    if (!(j.dry_bound > 0) && !(j.limit_gain > 0)) continue;
    JointRow row;
    row.term = static_cast<int>(i);
    row.dof = j.dof;
    row.unit = response_.unitOf(island_->forest.nodeOfDof(j.dof));
    row.column = response_.column(j.dof);
    row.axis = AxisRow(j, response_.entry(row.column, response_.units()[row.unit].rowOf(j.dof)), start);
    if (row.axis.response > 0) joint_rows_.push_back(row);
  }
}

void IslandSweeps::loadLoops(SweepStart start) {
  loop_pairs_.clear();
  loop_rows_.clear();
  for (std::size_t l = 0; l < island_->terms()->loops.size(); ++l) {
    const LoopTerm& loop = island_->terms()->loops[l];
    const BodyPair& pair = island_->model.loop_pairs[l];
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
    row.impulse = start == SweepStart::PREVIOUS ? loop.previous : Vector6::Zero();
    if (loop.rows < 6) row.impulse[5] = 0;
    row.axis = AxisRow(loop.drive, along(5, 5), start);
    loop_rows_.push_back(row);
  }
}

// Orders the patches from the ground up.
void IslandSweeps::orderPatches(const Vector3& up) {
  heights_.clear();
  for (const ContactPatch& patch : island_->model.patches) {
    const Vector3& reference = island_->motion.reference[island_->forest.nodes()[patch.pair.a].tree];
    heights_.push_back(up.dot(reference + island_->terms()->contacts[patch.first].point));
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
  group_start_.assign(1, 0);
  std::size_t count = 0;
  colour_start_.assign(COLOURS + 2, 0);
  for (const int p : order_) ++colour_start_[colour_[p] + 1];
  for (int c = 0; c <= COLOURS; ++c) colour_start_[c + 1] += colour_start_[c];
  by_colour_.resize(order_.size());
  chosen_.assign(colour_start_.begin(), colour_start_.end() - 1);
  for (const int p : order_) by_colour_[chosen_[colour_[p]]++] = p;
  const auto contactsOf = [this](int p) { return island_->model.patches[p].end - island_->model.patches[p].first; };
  for (int c = 0; c <= COLOURS; ++c) {
    const auto begin = by_colour_.begin() + colour_start_[c], end = by_colour_.begin() + colour_start_[c + 1];
    if (c < COLOURS)
      std::sort(begin, end, [&](int a, int b) { return contactsOf(a) > contactsOf(b) || (contactsOf(a) == contactsOf(b) && a < b); });
    const int width = c < COLOURS ? SWEEP_LANES : 1;
    for (auto p = begin; p != end;) {
      SweepGroup group;
      group.first = static_cast<int>(count);
      int longest = 0;
      for (int lane = 0; lane < SWEEP_LANES; ++lane) {
        group.patch[lane] = lane < width && p != end ? *p++ : -1;
        if (group.patch[lane] >= 0) longest = std::max(longest, contactsOf(group.patch[lane]));
      }
      count += longest;
      group.end = static_cast<int>(count);
      groups_.push_back(group);
    }
    group_start_.push_back(groups_.size());
  }
  contacts_.resize(count);
  impulses_.resize(count);
  changes_.resize(groups_.size());
  bodies_.resize(groups_.size());
}

void IslandSweeps::loadBodies(SweepGroup* group, SweepBodies* bodies) const {
  group->free = true;
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    const int p = group->patch[lane];
    const ResponseSide none, &a = p < 0 ? none : pairs_[p].a, &b = p < 0 ? none : pairs_[p].b;
    group->free = group->free && a.unit < 0 && b.unit < 0;
    if (!group->free) return;
    response_.setLane(a, lane, &bodies->a);
    response_.setLane(b, lane, &bodies->b);
    for (int i = 0; i < 3; ++i) bodies->shift[i][lane] = p < 0 ? 0 : pairs_[p].pair.shift[i];
  }
}

void IslandSweeps::loadContacts(SweepStart start) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    SweepGroup& group = groups_[g];
    loadBodies(&group, &bodies_[g]);
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      const int p = group.patch[lane];
      Matrix6 response = Matrix6::Identity();
      if (p >= 0) response = response_.relative(pairs_[p].pair, pairs_[p].a, pairs_[p].b);
      for (int r = 0, at = 0; r < 6; ++r)
        for (int c = 0; c <= r; ++c, ++at) group.response[at][lane] = response(r, c);
      for (int i = group.first; i < group.end; ++i) {
        const int contact = p < 0 ? -1 : island_->model.patches[p].first + i - group.first;
        const bool exists = contact >= 0 && contact < island_->model.patches[p].end;
        setLane(exists ? &island_->terms()->contacts[contact] : nullptr, lane, &contacts_[i], &impulses_[i]);
      }
    }
    setGains(group, contacts_.data() + group.first, contacts_.data() + group.end);
  }
  if (start == SweepStart::NOTHING) blem_sim::dynamics::scale(0, impulses_.data(), impulses_.data() + impulses_.size());
}

}  // namespace blem_sim::dynamics
