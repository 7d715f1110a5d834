#include "problem/solver_space.h"

namespace blem_sim::dynamics {

void SolverSpace::resize(const Forest& forest) {
  for (auto* v : {&free_momentum, &velocity, &mass_velocity, &gradient, &direction, &mass_direction, &scale, &kinetic, &anchor, &idle_pull,
                  &first_velocity, &first_kinetic})
    v->setZero(forest.dofCount());
  idle.resize(forest);
  hessian.resize(forest);
  paths.resize(forest);
  for (auto* v : {&twist, &wrench}) v->assign(forest.nodes().size(), Vector6::Zero());
  stiffness.resize(forest.nodes().size());
  for (auto* v : {&stiff, &live}) v->resize(forest.nodes().size());
}

}  // namespace blem_sim::dynamics
