// The step problem of one island: minimise, over the velocities v at the end of the step,
//   1/2 (v - v*)' M (v - v*) + sum_j phi_j(v_j) + sum_c psi_c(J_c v)
// by Newton's method with an exact line search. Every reaction is minus a gradient.
#pragma once

#include <vector>

#include "articulated_tree.h"
#include "friction_cone.h"

namespace blem_sim {

/** Impulse of one joint as a function of its velocity: motor, friction and limits, each piecewise linear and falling. */
struct JointTerm {
  int dof = -1;           ///< in the island
  double motor_gain = 0;  ///< D [N m s^2/rad]: impulse D (motor_velocity - v), within +-motor_bound
  double motor_velocity = 0;
  double motor_bound = 0;
  double viscous = 0;   ///< h mu_V
  double dry_gain = 0;  ///< impulse dry_previous - dry_gain v, within +-dry_bound
  double dry_previous = 0;
  double dry_bound = 0;
  double limit_gain = 0;                          ///< 0: no limits
  double lower_velocity = 0, lower_previous = 0;  ///< impulse max(0, lower_previous + limit_gain (lower_velocity - v))
  double upper_velocity = 0, upper_previous = 0;  ///< impulse -max(0, upper_previous + limit_gain (v - upper_velocity))

  double motorImpulse(double v) const;
  double dryImpulse(double v) const;
  double limitImpulse(double v) const;
  double impulse(double v) const { return motorImpulse(v) - viscous * v + dryImpulse(v) + limitImpulse(v); }
  /** -d impulse / dv >= 0 */
  double stiffness(double v) const;
  /** Speed [rad/s or m/s] by which friction that sticks still creeps, or a limit that pushes is still missed. */
  double residual(double v) const;
};

/** One contact of an island. */
struct ContactTerm {
  int tree_a = -1, node_a = -1;  ///< tree of the island and node of body A; -1: the static world
  int tree_b = -1, node_b = -1;
  Vector3 point_a, point_b;  ///< the contact point about the tree's reference point
  Matrix3 frame;             ///< rows: normal_BA, two tangents
  double friction = 0;
  double compliance = 0;               ///< R_n [m/s per N s], 0 = rigid
  double rho = 0;                      ///< proximal weight
  Vector3 target = Vector3::Zero();    ///< u^: relative velocity asked for
  Vector3 previous = Vector3::Zero();  ///< impulse of the proximal point
  Vector3 impulse = Vector3::Zero();   ///< of the last evaluation
  double saxce_speed = 0;              ///< |u_t| of the previous outer step: De Saxce's term
};

/** v[dof] = multiplier * v[master], kept exactly: the column of dof is folded into that of its master. */
struct MimicFold {
  int dof = -1, master = -1;  ///< in the island; a master is never folded itself
  double multiplier = 1;
};

/** What a solve needed and how good it is. */
struct NewtonReport {
  int iterations = 0;
  int outer = 0;
  double contact_residual = 0;  ///< [N s] largest violation of Coulomb's law over the contacts
  double joint_residual = 0;    ///< [rad/s or m/s] largest creep of joint friction that sticks, or miss of a limit
};

struct NewtonSettings {
  int max_iterations = 60;
  int max_outer = 5;
  double gradient_tolerance = 1e-10;
  double contact_tolerance = 1e-5;  ///< [N s]
  double joint_tolerance = 1e-7;    ///< [rad/s or m/s]
};

/** One island: trees that contacts couple. Reused from step to step. */
class StepProblem {
 public:
  std::vector<const ArticulatedTree*> trees;
  std::vector<const TreeState*> states;
  std::vector<int> offset;            ///< first dof of each tree in the island
  std::vector<Eigen::MatrixXd> mass;  ///< per tree, lower triangle
  Eigen::VectorXd free_momentum;      ///< M v*
  std::vector<JointTerm> joints;
  std::vector<ContactTerm> contacts;
  std::vector<MimicFold> mimics;
  Eigen::VectorXd velocity;  ///< in: start; out: solution

  NewtonReport solve(const NewtonSettings& settings);
  /** After solve: impulse on each mimic's own dof by which it follows its master [N m s or N s]. */
  std::vector<double> foldImpulses();

 private:
  void massTimes(const Eigen::VectorXd& v, Eigen::VectorXd* out) const;
  void twists(const Eigen::VectorXd& v, std::vector<std::vector<Vector6>>* out) const;
  Vector3 relativeVelocity(const ContactTerm& c, const std::vector<std::vector<Vector6>>& twists) const;
  void evaluateContacts(bool with_stiffness);
  void gradient(Eigen::VectorXd* out);
  void hessian();
  void foldGradient(Eigen::VectorXd* g) const;
  bool solveDense(const Eigen::VectorXd& gradient, Eigen::VectorXd* direction);
  bool solveTrees(const Eigen::VectorXd& gradient, Eigen::VectorXd* direction);
  void remember();
  double lineSearch(const Eigen::VectorXd& direction);
  int newton(const NewtonSettings& settings);
  double coulombResidual() const;
  double jointResidual() const;

  int dofs_ = 0;
  bool coupled_ = false;  ///< contacts tie two branches or two trees: dense factorisation
  Eigen::MatrixXd hessian_;
  std::vector<Matrix3> contact_stiffness_;
  std::vector<Vector3> contact_velocity_;
  std::vector<std::vector<Vector6>> twists_;
  Eigen::VectorXd mass_velocity_;
};

}  // namespace blem_sim
