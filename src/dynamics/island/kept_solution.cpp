#include "island/kept_solution.h"

namespace blem_sim::dynamics {

void KeptSolution::take(const Eigen::VectorXd& v, const std::vector<int>& trees, const Forest& forest,
                        const std::vector<ContactTerm>& contacts, const std::vector<JointTerm>& joint_terms,
                        const std::vector<LoopTerm>& loop_terms) {
  velocity.clear();
  impulses.clear();
  for (const int tree : trees)
    for (int k = forest.trees()[tree].first_dof; k < forest.trees()[tree].dof_end; ++k) velocity.push_back(v[k]);
  for (const ContactTerm& c : contacts) impulses.push_back(c.impulse);
  joints = joint_terms;
  loops = loop_terms;
}

void KeptSolution::put(const std::vector<int>& trees, const Forest& forest, Eigen::VectorXd* v, std::vector<ContactTerm>* contacts,
                       std::vector<JointTerm>* joint_terms, std::vector<LoopTerm>* loop_terms) const {
  const double* next = velocity.data();
  for (const int tree : trees)
    for (int k = forest.trees()[tree].first_dof; k < forest.trees()[tree].dof_end; ++k) (*v)[k] = *next++;
  for (std::size_t i = 0; i < impulses.size(); ++i) (*contacts)[i].impulse = impulses[i];
  *joint_terms = joints;
  *loop_terms = loops;
}

}  // namespace blem_sim::dynamics
