#include "step_problem.h"

#include <algorithm>
#include <cmath>

namespace blem_sim {

double JointTerm::motorImpulse(double v) const { return std::clamp(motor_gain * (motor_velocity - v), -motor_bound, motor_bound); }

double JointTerm::dryImpulse(double v) const { return std::clamp(dry_previous - dry_gain * v, -dry_bound, dry_bound); }

double JointTerm::limitImpulse(double v) const {
  if (limit_gain == 0) return 0;
  return std::max(0.0, lower_previous + limit_gain * (lower_velocity - v)) -
         std::max(0.0, upper_previous + limit_gain * (v - upper_velocity));
}

double JointTerm::stiffness(double v) const {
  double sum = viscous;
  if (std::abs(motor_gain * (motor_velocity - v)) < motor_bound) sum += motor_gain;
  if (std::abs(dry_previous - dry_gain * v) < dry_bound) sum += dry_gain;
  if (limit_gain > 0 && lower_previous + limit_gain * (lower_velocity - v) > 0) sum += limit_gain;
  if (limit_gain > 0 && upper_previous + limit_gain * (v - upper_velocity) > 0) sum += limit_gain;
  return sum;
}

double JointTerm::residual(double v) const {
  double worst = 0;
  if (dry_gain > 0 && std::abs(dry_previous - dry_gain * v) < dry_bound) worst = std::abs(v);
  if (limit_gain > 0 && lower_previous + limit_gain * (lower_velocity - v) > 0) worst = std::max(worst, std::abs(lower_velocity - v));
  if (limit_gain > 0 && upper_previous + limit_gain * (v - upper_velocity) > 0) worst = std::max(worst, std::abs(v - upper_velocity));
  return worst;
}

void StepProblem::massTimes(const Eigen::VectorXd& v, Eigen::VectorXd* out) const {
  out->setZero(v.size());
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const Eigen::MatrixXd& m = mass[t];
    const int base = offset[t];
    for (int k = 0; k < trees[t]->dofCount(); ++k) {
      double sum = m(k, k) * v[base + k];
      for (int j = trees[t]->dofParent(k); j >= 0; j = trees[t]->dofParent(j)) {
        sum += m(k, j) * v[base + j];
        (*out)[base + j] += m(k, j) * v[base + k];
      }
      (*out)[base + k] += sum;
    }
  }
}

void StepProblem::twists(const Eigen::VectorXd& v, std::vector<std::vector<Vector6>>* out) const {
  out->resize(trees.size());
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const std::vector<TreeNode>& nodes = trees[t]->nodes();
    std::vector<Vector6>& twist = (*out)[t];
    twist.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      twist[i] = nodes[i].parent < 0 ? Vector6(Vector6::Zero()) : twist[nodes[i].parent];
      for (int d = 0; d < nodes[i].dofs; ++d) {
        const int dof = nodes[i].first_dof + d;
        twist[i] += states[t]->subspace[dof] * v[offset[t] + dof];
      }
    }
  }
}

Vector3 StepProblem::relativeVelocity(const ContactTerm& c, const std::vector<std::vector<Vector6>>& twist) const {
  Vector3 u = Vector3::Zero();
  if (c.tree_a >= 0) {
    const Vector6& w = twist[c.tree_a][c.node_a];
    u += w.tail<3>() + w.head<3>().cross(c.point_a);
  }
  if (c.tree_b >= 0) {
    const Vector6& w = twist[c.tree_b][c.node_b];
    u -= w.tail<3>() + w.head<3>().cross(c.point_b);
  }
  return c.frame * u;
}

namespace {

/** y of the projection: what impulse the proximal point and the velocity ask for. */
Vector3 proximalPoint(const ContactTerm& c, const Vector3& u, double* w_n, double* w_t) {
  *w_n = c.compliance + c.rho;
  *w_t = c.rho;
  Vector3 target = c.target;
  target.x() -= c.friction * c.saxce_speed;
  const Vector3 y = c.rho * c.previous - (u - target);
  return Vector3(y.x() / *w_n, y.y() / *w_t, y.z() / *w_t);
}

Vector6 wrenchAbout(const Vector3& point, const Vector3& force) {
  Vector6 w;
  w.head<3>() = point.cross(force);
  w.tail<3>() = force;
  return w;
}

/** 3 x 6: velocity of a point in the contact's axes from a twist. */
Eigen::Matrix<double, 3, 6> pointJacobian(const Matrix3& frame, const Vector3& point) {
  Matrix3 cross;
  cross << 0, point.z(), -point.y(), -point.z(), 0, point.x(), point.y(), -point.x(), 0;
  Eigen::Matrix<double, 3, 6> j;
  j.leftCols<3>() = frame * cross;
  j.rightCols<3>() = frame;
  return j;
}

}  // namespace

void StepProblem::evaluateContacts(bool with_stiffness) {
  contact_velocity_.resize(contacts.size());
  contact_stiffness_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ContactTerm& c = contacts[i];
    double w_n, w_t;
    const Vector3 y = proximalPoint(c, contact_velocity_[i], &w_n, &w_t);
    const ConeProjection p = projectOnCone(y, c.friction, w_n, w_t, with_stiffness);
    c.impulse = p.impulse;
    if (with_stiffness) contact_stiffness_[i] = p.stiffness;
  }
}

void StepProblem::gradient(Eigen::VectorXd* out) {
  *out = mass_velocity_ - free_momentum;
  for (const JointTerm& j : joints) (*out)[j.dof] -= j.impulse(velocity[j.dof]);
  std::vector<std::vector<Vector6>> wrench(trees.size());
  for (std::size_t t = 0; t < trees.size(); ++t) wrench[t].assign(trees[t]->nodes().size(), Vector6::Zero());
  for (const ContactTerm& c : contacts) {
    const Vector3 impulse = c.frame.transpose() * c.impulse;
    if (c.tree_a >= 0) wrench[c.tree_a][c.node_a] += wrenchAbout(c.point_a, impulse);
    if (c.tree_b >= 0) wrench[c.tree_b][c.node_b] -= wrenchAbout(c.point_b, impulse);
  }
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const std::vector<TreeNode>& nodes = trees[t]->nodes();
    for (std::size_t i = nodes.size(); i-- > 0;) {
      for (int d = 0; d < nodes[i].dofs; ++d) {
        const int dof = nodes[i].first_dof + d;
        (*out)[offset[t] + dof] -= states[t]->subspace[dof].dot(wrench[t][i]);
      }
      if (nodes[i].parent >= 0) wrench[t][nodes[i].parent] += wrench[t][i];
    }
  }
}

void StepProblem::hessian() {
  hessian_.setZero(dofs_, dofs_);
  std::vector<std::vector<Matrix6>> body(trees.size());
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const int n = trees[t]->dofCount();
    hessian_.block(offset[t], offset[t], n, n) = mass[t];
    body[t].assign(trees[t]->nodes().size(), Matrix6::Zero());
  }
  for (const JointTerm& j : joints) hessian_(j.dof, j.dof) += j.stiffness(velocity[j.dof]);

  // Contacts of a body add up to one 6 x 6, which is pushed to the root like an inertia; a pair of moving bodies adds a cross term.
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactTerm& c = contacts[i];
    if (contact_stiffness_[i].isZero(0)) continue;
    Eigen::Matrix<double, 3, 6> ja, jb;
    if (c.tree_a >= 0) {
      ja = pointJacobian(c.frame, c.point_a);
      body[c.tree_a][c.node_a] += ja.transpose() * contact_stiffness_[i] * ja;
    }
    if (c.tree_b >= 0) {
      jb = pointJacobian(c.frame, c.point_b);
      body[c.tree_b][c.node_b] += jb.transpose() * contact_stiffness_[i] * jb;
    }
    if (c.tree_a < 0 || c.tree_b < 0) continue;
    const Matrix6 cross = ja.transpose() * contact_stiffness_[i] * jb;
    for (int k = trees[c.tree_a]->lastDof(c.node_a); k >= 0; k = trees[c.tree_a]->dofParent(k)) {
      const Vector6 row = cross.transpose() * states[c.tree_a]->subspace[k];
      for (int j = trees[c.tree_b]->lastDof(c.node_b); j >= 0; j = trees[c.tree_b]->dofParent(j)) {
        const double value = row.dot(states[c.tree_b]->subspace[j]);
        const int r = offset[c.tree_a] + k, s = offset[c.tree_b] + j;
        // Only the lower triangle is kept; a shared dof of both branches gets both halves.
        hessian_(std::max(r, s), std::min(r, s)) -= r == s ? 2 * value : value;
      }
    }
  }
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const std::vector<TreeNode>& nodes = trees[t]->nodes();
    for (std::size_t i = nodes.size(); i-- > 0;) {
      if (body[t][i].isZero(0)) continue;
      for (int d = nodes[i].dofs - 1; d >= 0; --d) {
        const int k = nodes[i].first_dof + d;
        const Vector6 row = body[t][i] * states[t]->subspace[k];
        for (int j = k; j >= 0; j = trees[t]->dofParent(j)) hessian_(offset[t] + k, offset[t] + j) += row.dot(states[t]->subspace[j]);
      }
      if (nodes[i].parent >= 0) body[t][nodes[i].parent] += body[t][i];
    }
  }
}

void StepProblem::foldGradient(Eigen::VectorXd* g) const {
  for (const MimicFold& m : mimics) {
    (*g)[m.master] += m.multiplier * (*g)[m.dof];
    (*g)[m.dof] = 0;
  }
}

bool StepProblem::solveDense(const Eigen::VectorXd& gradient, Eigen::VectorXd* direction) {
  if (!mimics.empty()) hessian_.triangularView<Eigen::StrictlyUpper>() = hessian_.transpose();
  for (const MimicFold& m : mimics) {
    hessian_.row(m.master) += m.multiplier * hessian_.row(m.dof);
    hessian_.col(m.master) += m.multiplier * hessian_.col(m.dof);
    hessian_.row(m.dof).setZero();
    hessian_.col(m.dof).setZero();
    hessian_(m.dof, m.dof) = 1;
  }
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> llt(hessian_);
  if (llt.info() != Eigen::Success) return false;
  *direction = -llt.solve(gradient);
  for (const MimicFold& m : mimics) (*direction)[m.dof] = m.multiplier * (*direction)[m.master];
  return true;
}

bool StepProblem::solveTrees(const Eigen::VectorXd& gradient, Eigen::VectorXd* direction) {
  // L' L factorisation along the tree: no fill-in outside the ancestors [Featherstone 2008, 6.5].
  *direction = -gradient;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const ArticulatedTree& tree = *trees[t];
    const int base = offset[t];
    for (int k = tree.dofCount() - 1; k >= 0; --k) {
      double& pivot = hessian_(base + k, base + k);
      if (!(pivot > 0)) return false;
      pivot = std::sqrt(pivot);
      for (int i = tree.dofParent(k); i >= 0; i = tree.dofParent(i)) hessian_(base + k, base + i) /= pivot;
      for (int i = tree.dofParent(k); i >= 0; i = tree.dofParent(i))
        for (int j = i; j >= 0; j = tree.dofParent(j))
          hessian_(base + i, base + j) -= hessian_(base + k, base + i) * hessian_(base + k, base + j);
    }
    for (int k = tree.dofCount() - 1; k >= 0; --k) {
      double& x = (*direction)[base + k];
      x /= hessian_(base + k, base + k);
      for (int i = tree.dofParent(k); i >= 0; i = tree.dofParent(i)) (*direction)[base + i] -= hessian_(base + k, base + i) * x;
    }
    for (int k = 0; k < tree.dofCount(); ++k) {
      double& x = (*direction)[base + k];
      for (int i = tree.dofParent(k); i >= 0; i = tree.dofParent(i)) x -= hessian_(base + k, base + i) * (*direction)[base + i];
      x /= hessian_(base + k, base + k);
    }
  }
  return true;
}

double StepProblem::lineSearch(const Eigen::VectorXd& direction) {
  Eigen::VectorXd mass_direction;
  massTimes(direction, &mass_direction);
  const double quadratic = direction.dot(mass_direction);
  const double linear = direction.dot(mass_velocity_ - free_momentum);
  std::vector<std::vector<Vector6>> twist;
  twists(direction, &twist);
  std::vector<Vector3> step(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) step[i] = relativeVelocity(contacts[i], twist);

  // Slope of the objective along the direction and its derivative.
  const auto slope = [&](double a, double* curvature) {
    double first = linear + a * quadratic;
    double second = quadratic;
    for (const JointTerm& j : joints) {
      const double d = direction[j.dof], v = velocity[j.dof] + a * d;
      first -= j.impulse(v) * d;
      second += j.stiffness(v) * d * d;
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      double w_n, w_t;
      const Vector3 y = proximalPoint(contacts[i], contact_velocity_[i] + a * step[i], &w_n, &w_t);
      const ConeProjection p = projectOnCone(y, contacts[i].friction, w_n, w_t, true);
      first -= p.impulse.dot(step[i]);
      second += step[i].dot(p.stiffness * step[i]);
    }
    *curvature = second;
    return first;
  };

  double curvature;
  const double start = slope(0, &curvature);
  double low = 0, high = -1, a = 1;
  for (int it = 0; it < 30; ++it) {
    const double s = slope(a, &curvature);
    if (std::abs(s) <= 1e-10 * std::abs(start)) break;
    (s < 0 ? low : high) = a;
    double next = a - s / curvature;
    if (high > 0 && !(next > low && next < high)) next = 0.5 * (low + high);
    if (high < 0 && !(next > low)) next = 2 * a;
    if (next == a) break;
    a = next;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) contact_velocity_[i] += a * step[i];
  velocity += a * direction;
  mass_velocity_ += a * mass_direction;
  return a;
}

int StepProblem::newton(const NewtonSettings& settings) {
  Eigen::VectorXd g, direction;
  Eigen::VectorXd scale(dofs_);
  for (std::size_t t = 0; t < trees.size(); ++t)
    for (int k = 0; k < trees[t]->dofCount(); ++k) scale[offset[t] + k] = 1 / std::sqrt(mass[t](k, k));
  massTimes(velocity, &mass_velocity_);
  twists(velocity, &twists_);
  contact_velocity_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) contact_velocity_[i] = relativeVelocity(contacts[i], twists_);
  int iterations = 0;
  for (; iterations < settings.max_iterations; ++iterations) {
    evaluateContacts(true);
    gradient(&g);
    foldGradient(&g);
    if ((g.array() * scale.array()).matrix().lpNorm<Eigen::Infinity>() <= settings.gradient_tolerance) break;
    hessian();
    if (!(coupled_ ? solveDense(g, &direction) : solveTrees(g, &direction))) break;
    const double a = lineSearch(direction);
    if (a * direction.lpNorm<Eigen::Infinity>() < 1e-16) break;
  }
  return iterations;
}

std::vector<double> StepProblem::foldImpulses() {
  std::vector<double> impulses;
  if (mimics.empty()) return impulses;
  Eigen::VectorXd g;
  gradient(&g);
  for (const MimicFold& m : mimics) impulses.push_back(g[m.dof]);
  return impulses;
}

double StepProblem::coulombResidual() const {
  double worst = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactTerm& c = contacts[i];
    Vector3 u = contact_velocity_[i] - c.target;
    u.x() += c.friction * contact_velocity_[i].tail<2>().norm() + c.compliance * c.impulse.x();
    const Vector3 y = c.impulse - u / c.rho;
    const ConeProjection p = projectOnCone(y, c.friction, 1, 1, false);
    worst = std::max(worst, (p.impulse - c.impulse).norm());
  }
  return worst;
}

double StepProblem::jointResidual() const {
  double worst = 0;
  for (const JointTerm& j : joints) worst = std::max(worst, j.residual(velocity[j.dof]));
  return worst;
}

void StepProblem::remember() {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].previous = contacts[i].impulse;
    contacts[i].saxce_speed = contact_velocity_[i].tail<2>().norm();
  }
  for (JointTerm& j : joints) {
    const double v = velocity[j.dof], limit = j.limitImpulse(v);
    j.dry_previous = j.dryImpulse(v);
    j.lower_previous = std::max(0.0, limit);
    j.upper_previous = std::max(0.0, -limit);
  }
}

NewtonReport StepProblem::solve(const NewtonSettings& settings) {
  dofs_ = static_cast<int>(velocity.size());
  coupled_ = !mimics.empty();
  for (const ContactTerm& c : contacts) coupled_ |= c.tree_a >= 0 && c.tree_b >= 0;
  for (const MimicFold& m : mimics) velocity[m.dof] = m.multiplier * velocity[m.master];
  NewtonReport total;
  for (total.outer = 1;; ++total.outer) {
    total.iterations += newton(settings);
    total.contact_residual = coulombResidual();
    total.joint_residual = jointResidual();
    const bool done = total.contact_residual <= settings.contact_tolerance && total.joint_residual <= settings.joint_tolerance;
    if (done || total.outer >= settings.max_outer) return total;
    remember();
  }
}

}  // namespace blem_sim
