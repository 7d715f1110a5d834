#include "island_problem.h"
#include "tree_factor.h"

namespace blem_sim {
namespace {

constexpr int MAX_LINE_SEARCH = 30;
constexpr double LINE_SEARCH_SLOPE = 1e-3;  // of the first slope: where the search is near enough to its minimum
// Of the first gradient of a proximal step: the next step changes the problem again, so this one need not be solved to the last digit.
constexpr double INEXACT = 0.02;
// Proximal weights of the first steps against the last one's: soft contacts and soft joint friction find who sticks in few iterations.
constexpr int SOFT_STAGES = 2;
constexpr double CONTACT_SOFTNESS[SOFT_STAGES] = {1000, 30};
constexpr double JOINT_SOFTNESS[SOFT_STAGES] = {10, 3};
constexpr int FIRST_ITERATIONS = 4;  // of the hard problem, before the soft ones are asked
constexpr double NO_STEP = 1e-16;    // [rad/s or m/s] largest change of a velocity that is none

}  // namespace

bool IslandProblem::solveTrees() {
  SolverSpace& s = *space_;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) s.direction[k] = -s.gradient[k];
    if (!factorTree(*forest_, tree, &s.hessian)) return false;
    solveTree(*forest_, tree, s.hessian, &s.direction);
  }
  return true;
}

bool IslandProblem::solveBlocks() {
  SolverSpace& s = *space_;
  Eigen::Ref<Eigen::VectorXd> x = block_vector_.head(matrix_.size());
  const auto rowOf = [&](int tree, int dof) { return matrix_.offset(s.block[tree]) + s.block_row[dof]; };
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    BlockMatrix::Block h = matrix_.diagonal(s.block[tree]);
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      const double* packed = s.hessian.data() + forest_->rowStart(k);
      for (int e = 0; e < forest_->rowLength(k); ++e) h(s.block_row[k], s.block_row[forest_->columns(k)[e]]) += packed[e];
      x[rowOf(tree, k)] = -s.gradient[k];
    }
  }
  for (const MimicFold& m : mimics)
    matrix_.fold(s.block[forest_->nodes()[forest_->nodeOfDof(m.dof)].tree], s.block_row[m.dof], s.block_row[m.master], m.multiplier);
  if (!matrix_.factor()) return false;
  matrix_.solve(x);
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) s.direction[k] = x[rowOf(tree, k)];
  }
  for (const MimicFold& m : mimics) s.direction[m.dof] = m.multiplier * s.direction[m.master];
  return true;
}

// Slope of the objective at a along the direction, and its derivative.
double IslandProblem::slope(double a, double* curvature) {
  responses_at_ = a;
  double first = linear_ + a * quadratic_, second = quadratic_;
  for (const JointTerm& j : joints) {
    const double d = space_->direction[j.dof], v = space_->velocity[j.dof] + a * d;
    first -= j.impulse(v) * d;
    second += j.stiffness(v) * d * d;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactTerm& c = contacts[i];
    const ConeResponse& response = responses_[i] = c.respond(c.velocity + a * c.step);
    first -= response.impulse.dot(c.step);
    second += response.curvature(c.step);
  }
  for (const LoopTerm& loop : loops) {
    for (int r = 0; r < 6; ++r) {
      const double d = loop.step[r], v = loop.velocity[r] + a * d;
      first -= loop.impulse(r, v) * d;
      second += loop.stiffness(r, v) * d * d;
    }
  }
  *curvature = second;
  return first;
}

double IslandProblem::lineSearch() {
  SolverSpace& s = *space_;
  linear_ = quadratic_ = 0;
  double start = 0;
  for (const int tree : trees) {
    massTimes(*forest_, tree, *motion_, s.direction, &s.mass_direction);
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      quadratic_ += s.direction[k] * s.mass_direction[k];
      linear_ += s.direction[k] * (s.mass_velocity[k] - s.free_momentum[k]);
      start += s.direction[k] * s.gradient[k];
    }
  }
  relativeSteps(s.direction, false);
  double low = 0, high = -1, a = 1, curvature;
  for (int it = 0; it < MAX_LINE_SEARCH; ++it) {
    const double here = slope(a, &curvature);
    if (std::abs(here) <= LINE_SEARCH_SLOPE * std::abs(start)) break;
    (here < 0 ? low : high) = a;
    double next = a - here / curvature;
    if (high > 0 && !(next > low && next < high)) next = 0.5 * (low + high);
    if (high < 0 && !(next > low)) next = 2 * a;
    if (next == a) break;
    a = next;
  }
  return a;
}

double IslandProblem::gradientNorm() const {
  double worst = 0;
  for (const int tree : trees)
    for (int k = forest_->trees()[tree].first_dof; k < forest_->trees()[tree].dof_end; ++k)
      worst = std::max(worst, std::abs(space_->gradient[k]) * space_->scale[k]);
  return worst;
}

// The gradient as the velocity that each dof's own inertia would make of it.
double IslandProblem::imbalance() const {
  double worst = 0;
  for (const int tree : trees)
    for (int k = forest_->trees()[tree].first_dof; k < forest_->trees()[tree].dof_end; ++k)
      worst = std::max(worst, std::abs(space_->gradient[k]) * space_->scale[k] * space_->scale[k]);
  return worst;
}

// Moves by a along the direction. Returns the largest change of a velocity.
double IslandProblem::take(double a) {
  SolverSpace& s = *space_;
  double moved = 0;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      s.velocity[k] += a * s.direction[k];
      s.mass_velocity[k] += a * s.mass_direction[k];
      moved = std::max(moved, std::abs(a * s.direction[k]));
    }
  }
  for (ContactTerm& c : contacts) c.velocity += a * c.step;
  responses_known_ = a == responses_at_;
  for (LoopTerm& loop : loops) loop.velocity += a * loop.step;
  return moved;
}

bool IslandProblem::findDirection() {
  SolverSpace& s = *space_;
  for (const int tree : trees) treeHessian(tree);
  for (const JointTerm& j : joints) s.hessian[forest_->rowStart(j.dof) + forest_->rowLength(j.dof) - 1] += j.stiffness(s.velocity[j.dof]);
  return coupled_ ? solveBlocks() : solveTrees();
}

// Until the gradient is below `exactness` times the first one, or the tolerance.
int IslandProblem::newton(const NewtonSettings& settings, double exactness, int max_iterations) {
  double enough = settings.gradient_tolerance;
  responses_known_ = false;
  responses_.resize(contacts.size());
  for (int iterations = 0;; ++iterations) {
    evaluate();
    gradient();
    for (const MimicFold& m : mimics) {
      space_->gradient[m.master] += m.multiplier * space_->gradient[m.dof];
      space_->gradient[m.dof] = 0;
    }
    gradient_norm_ = gradientNorm();
    if (iterations == 0) enough = std::max(enough, exactness * gradient_norm_);
    if (gradient_norm_ <= enough || iterations >= max_iterations || !findDirection()) return iterations;
    if (take(lineSearch()) < NO_STEP) return iterations + 1;
  }
}

void IslandProblem::soften(double contact, double joint) {
  for (ContactTerm& c : contacts) c.rho = contact * c.stiffest_rho;
  for (JointTerm& j : joints) j.softness = joint;
  for (LoopTerm& loop : loops) loop.drive.softness = joint;
}

void IslandProblem::remember() {
  for (ContactTerm& c : contacts) c.remember();
  for (JointTerm& j : joints) j.remember(space_->velocity[j.dof]);
  for (LoopTerm& loop : loops) loop.remember();
}

void IslandProblem::assess(NewtonReport* report) const {
  report->contact_residual = report->joint_creep = 0;
  report->imbalance = imbalance();
  for (const ContactTerm& c : contacts) report->contact_residual = std::max(report->contact_residual, c.residual());
  for (const JointTerm& j : joints) report->joint_creep = std::max(report->joint_creep, j.creep(space_->velocity[j.dof]));
  for (const LoopTerm& loop : loops) report->joint_creep = std::max(report->joint_creep, loop.creep());
}

// The fold's reaction is what the gradient lacks on the mimic's own dof.
void IslandProblem::readMimics() {
  mimic_impulses.clear();
  if (mimics.empty()) return;
  evaluate();
  gradient();
  for (const MimicFold& m : mimics) mimic_impulses.push_back(space_->gradient[m.dof]);
}

NewtonReport IslandProblem::solve(const Forest& forest, const ForestMotion& motion, const NewtonSettings& settings, SolverSpace* space) {
  forest_ = &forest;
  motion_ = &motion;
  space_ = space;
  start();
  NewtonReport report;
  const auto left = [&] { return settings.max_iterations - report.iterations; };
  // Most steps are like the one before: the hard problem is solved in a few iterations. Where it is not, soft ones lead to it.
  soften(1, 1);
  report.iterations = newton(settings, 0, FIRST_ITERATIONS);
  if (report.iterations == FIRST_ITERATIONS) {
    for (int stage = 0; stage < SOFT_STAGES; ++stage) {
      soften(CONTACT_SOFTNESS[stage], JOINT_SOFTNESS[stage]);
      report.iterations += newton(settings, INEXACT, left());
      remember();
    }
    soften(1, 1);
    report.iterations += newton(settings, INEXACT, left());
  }
  for (int outer = 1; outer < settings.max_outer; ++outer) {
    assess(&report);
    const bool lawful = report.contact_residual <= settings.contact_tolerance && report.joint_creep <= settings.joint_tolerance;
    const bool exact = gradient_norm_ <= settings.gradient_tolerance;
    if ((lawful && exact) || left() <= 0) break;
    if (!lawful) remember();
    report.iterations += newton(settings, lawful ? 0 : INEXACT, left());
  }
  assess(&report);
  readMimics();
  return report;
}

}  // namespace blem_sim
