// Mimic joints: q = multiplier * q[master] + offset, held by an effort on the joint and its reaction on the master.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "scene/scene.h"
#include "scene/stepper.h"

namespace blem_sim::dynamics {

/**
 * ODE's public joints know two bodies, a mimic relation up to four. So the step is solved with coupling efforts f on the mimic joints and
 * -multiplier f on their masters, and f is corrected by Broyden's method until the joints' speeds at the end of the step keep the relation;
 * the first guess is the last step's f, so a joint at rest or in steady motion costs few solves. Without mimic joints there is one solve
 * and no more.
 */
class MimicCoupling {
 public:
  /** Solves a step from the state it is at; may be called many times, last with efforts(). @param efforts [N m or N] per joint slot */
  using Solve = std::function<void(const std::vector<double>& efforts)>;

  /** Precondition: the scene is at the start of the step. Afterwards it is at its end. */
  void solve(const Scene& scene, double dt, const SolverSettings& settings, const Solve& solve);
  const std::vector<double>& efforts() const { return efforts_; }

  void save(geometry::StateWriter* writer) const;
  /** @param joints of the scene: a state has no more relations */
  void restore(std::size_t joints, geometry::StateReader* reader);

 private:
  struct Relation {
    int joint, master;
    double multiplier;
    double speed;  ///< [rad/s or m/s] joint against master, that corrects the present error
  };
  void findRelations(const Scene& scene, double dt, const SolverSettings& settings);
  Eigen::VectorXd residual(const Scene& scene, const Eigen::VectorXd& f, const Solve& solve);
  void probe(const Scene& scene, double dt, const Eigen::VectorXd& f, const Eigen::VectorXd& r, const Solve& solve);
  void iterate(const Scene& scene, double dt, const Solve& solve);

  std::vector<Relation> relations_;
  std::vector<double> efforts_;
  Eigen::VectorXd f_;        ///< [N m or N] coupling efforts of the last step
  Eigen::VectorXd last_f_;   ///< those of the last solve
  Eigen::MatrixXd inverse_;  ///< of d residual / d f, times dt
};

}  // namespace blem_sim::dynamics
