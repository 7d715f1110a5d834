#include "problem/joint_leads.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

constexpr double HOLDS = 0.5;   // of a dof's inertia: a joint that answers more stiffly keeps its velocity on the way
constexpr double LOCKED = 1e9;  // times its own inertia: a dof that keeps its velocity on the way

/** A tree and the terms of its joints. */
struct TreeJoints {
  int tree;
  JointTerm *begin, *end;
};

bool answers(const JointTerm& joint) { return joint.motor_gain > 0 || joint.viscous > 0; }

/** Fills space->direction with the accelerations of the free motion, and space->gradient with the diagonal of the mass matrix. */
void findFreeAcceleration(const Forest& forest, const TreeJoints& joints, ForestMotion* motion, SolverSpace* space) {
  const ForestTree& t = forest.trees()[joints.tree];
  computeProducts(forest, joints.tree, motion->velocity, motion);
  space->direction.segment(t.first_dof, t.dofCount()) = -motion->products.segment(t.first_dof, t.dofCount());
  motion->products.segment(t.first_dof, t.dofCount()).setZero();
  const auto lock = [&](int dof) {
    space->direction[dof] = 0;
    motion->mass[forest.diagonal(dof)] = LOCKED * space->gradient[dof];
  };
  for (JointTerm* j = joints.begin; j != joints.end; ++j) {
    const double inertia = motion->mass[forest.diagonal(j->dof)];
    space->gradient[j->dof] = inertia;
    if (keepsVelocity(*j, motion->velocity[j->dof], inertia)) lock(j->dof);
  }
  forFollowers(forest, joints.tree, [&](int dof, int master, double) {
    lock(dof);
    lock(master);
  });
  factorTree({forest, joints.tree, motion->mass}, &space->hessian);
  for (JointTerm* j = joints.begin; j != joints.end; ++j) motion->mass[forest.diagonal(j->dof)] = space->gradient[j->dof];
  solveTree(forest, joints.tree, space->hessian, &space->direction, &space->paths);
}

}  // namespace

bool keepsVelocity(const JointTerm& joint, double velocity, double inertia) { return joint.stiffness(velocity) > HOLDS * inertia; }

void setLeads(const TermSource& source, const std::vector<int>& trees, std::vector<JointTerm>* joints, ForestMotion* motion,
              SolverSpace* space) {
  JointTerm *begin = joints->data(), *const all_end = begin + joints->size();
  for (const int tree : trees) {
    const ForestTree& t = source.forest.trees()[tree];
    JointTerm* const end = std::find_if(begin, all_end, [&](const JointTerm& j) { return j.dof < t.first_dof || j.dof >= t.dof_end; });
    if (motion->pace[tree] == Pace::FAST && std::any_of(begin, end, answers)) {
      findFreeAcceleration(source.forest, {tree, begin, end}, motion, space);
      for (JointTerm* j = begin; j != end; ++j) j->setLead(0.5 * source.input.dt * space->direction[j->dof]);
    }
    begin = end;
  }
}

}  // namespace blem_sim::dynamics
