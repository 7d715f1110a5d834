// A solution of an island, to come back to if nothing better is found.
#pragma once

#include <vector>

#include "lanes/contact_term.h"
#include "lanes/joint_term.h"
#include "lanes/loop_term.h"
#include "trees/forest.h"

namespace blem_sim::dynamics {

/** Velocities, contact impulses, and the joints' and loops' terms, whose proximal points give their impulses. */
struct KeptSolution {
  std::vector<double> velocity;  ///< of the trees' dofs in turn
  std::vector<Vector3> impulses;
  std::vector<JointTerm> joints;
  std::vector<LoopTerm> loops;

  void take(const Eigen::VectorXd& v, const std::vector<int>& trees, const Forest& forest, const std::vector<ContactTerm>& contacts,
            const std::vector<JointTerm>& joint_terms, const std::vector<LoopTerm>& loop_terms);
  void put(const std::vector<int>& trees, const Forest& forest, Eigen::VectorXd* v, std::vector<ContactTerm>* contacts,
           std::vector<JointTerm>* joint_terms, std::vector<LoopTerm>* loop_terms) const;
};

}  // namespace blem_sim::dynamics
