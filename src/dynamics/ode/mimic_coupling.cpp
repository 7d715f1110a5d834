#include "ode/mimic_coupling.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "scene/joint_readings.h"

namespace blem_sim::dynamics {
namespace {

constexpr double SPEED_TOLERANCE = 1e-10;  // [rad/s or m/s]
constexpr int MAX_SOLVES = 20;             // in a step
constexpr int PROBE_AGAIN_AFTER = 8;       // solves without convergence
constexpr double PROBE_SPEED = 1e-3;       // [rad/s or m/s] that a probing effort gives a free joint in a step

}  // namespace

void MimicCoupling::findRelations(const Scene& scene, double dt, const SolverSettings& settings) {
  relations_.clear();
  for (std::size_t j = 0; j < scene.joints().size(); ++j) {
    const JointSlot& slot = scene.joints()[j];
    const int joint = static_cast<int>(j), master = slot.spec.mimic_joint;
    if (!slot.motor || master < 0 || !scene.joints()[master].motor) continue;
    const double multiplier = slot.spec.mimic_multiplier;
    const double error = jointPosition(scene, joint) - multiplier * jointPosition(scene, master) - slot.spec.mimic_offset;
    const double cap = settings.max_correction_speed;
    relations_.push_back({joint, master, multiplier, std::max(-cap, std::min(cap, -settings.joint_erp * error / dt))});
  }
}

Eigen::VectorXd MimicCoupling::residual(const Scene& scene, const Eigen::VectorXd& f, const Solve& solve) {
  std::fill(efforts_.begin(), efforts_.end(), 0.0);
  for (std::size_t i = 0; i < relations_.size(); ++i) {
    efforts_[relations_[i].joint] += f[i];
    efforts_[relations_[i].master] -= relations_[i].multiplier * f[i];
  }
  solve(efforts_);
  last_f_ = f;
  Eigen::VectorXd r(relations_.size());
  for (std::size_t i = 0; i < relations_.size(); ++i)
    r[i] = jointVelocity(scene, relations_[i].joint) - relations_[i].multiplier * jointVelocity(scene, relations_[i].master) -
           relations_[i].speed;
  return r;
}

void MimicCoupling::probe(const Scene& scene, double dt, const Eigen::VectorXd& f, const Eigen::VectorXd& r, const Solve& solve) {
  const int n = static_cast<int>(relations_.size());
  Eigen::MatrixXd derivative(n, n);
  for (int i = 0; i < n; ++i) {
    const Relation& relation = relations_[i];
    const double inverse_inertia =
        inverseInertia(scene, relation.joint) + relation.multiplier * relation.multiplier * inverseInertia(scene, relation.master);
    const double effort = PROBE_SPEED / (dt * inverse_inertia);
    derivative.col(i) = (residual(scene, f + effort * Eigen::VectorXd::Unit(n, i), solve) - r) / (dt * effort);
  }
  inverse_ = derivative.fullPivLu().inverse();
}

void MimicCoupling::iterate(const Scene& scene, double dt, const Solve& solve) {
  Eigen::VectorXd f = f_, r = residual(scene, f, solve);
  Eigen::VectorXd best_f = f, best_r = r;
  if (inverse_.rows() != f.size()) probe(scene, dt, f, r, solve);
  bool current = inverse_.allFinite();
  for (int solves = 1; solves < MAX_SOLVES && best_r.cwiseAbs().maxCoeff() > SPEED_TOLERANCE; ++solves) {
    if (solves == PROBE_AGAIN_AFTER || !current) {
      f = best_f, r = best_r;
      probe(scene, dt, f, r, solve);
    }
    const Eigen::VectorXd step = -inverse_ * r / dt;
    if (!step.allFinite()) break;
    const Eigen::VectorXd next_r = residual(scene, f + step, solve);
    // Broyden's rank-one correction of the inverse.
    const Eigen::VectorXd mapped = inverse_ * (next_r - r) / dt;
    const double scale = step.dot(mapped);
    if (std::abs(scale) > 1e-12 * step.squaredNorm()) inverse_ += (step - mapped) * (step.transpose() * inverse_) / scale;
    current = inverse_.allFinite();
    f += step, r = next_r;
    if (r.cwiseAbs().maxCoeff() < best_r.cwiseAbs().maxCoeff()) best_f = f, best_r = r;
  }
  // The state must be that of the efforts that are reported.
  if (last_f_ != best_f) residual(scene, best_f, solve);
  f_ = best_f;
}

void MimicCoupling::solve(const Scene& scene, double dt, const SolverSettings& settings, const Solve& solve) {
  efforts_.assign(scene.joints().size(), 0);
  findRelations(scene, dt, settings);
  if (relations_.empty()) {
    solve(efforts_);
    return;
  }
  if (f_.size() != static_cast<int>(relations_.size())) {
    f_ = Eigen::VectorXd::Zero(relations_.size());
    inverse_.resize(0, 0);
  }
  iterate(scene, dt, solve);
}

void MimicCoupling::save(geometry::StateWriter* writer) const {
  writer->word(f_.size());
  writer->word(inverse_.rows());
  writer->numbers(f_.data(), f_.size());
  writer->numbers(inverse_.data(), inverse_.size());
}

void MimicCoupling::restore(std::size_t joints, geometry::StateReader* reader) {
  const std::uint64_t relations = reader->word(), rows = reader->word();
  if (relations > joints || (rows != 0 && rows != relations)) reader->refuse();
  f_.resize(relations);
  inverse_.resize(rows, rows);
  reader->numbers(f_.data(), f_.size());
  reader->numbers(inverse_.data(), inverse_.size());
}

}  // namespace blem_sim::dynamics
