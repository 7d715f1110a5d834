#include "island/island.h"

namespace blem_sim::dynamics {

void makeTerms(const TermSource& source, Island* island) {
  const Forest& forest = source.forest;
  IslandModel& model = island->model;
  IslandTerms& terms = *island->solver.terms();
  terms.clear();
  model.clearTies();
  for (const int tree : model.trees) {
    if (forest.trees()[tree].free) addRootTerms(source, forest.trees()[tree].first_node, &terms.joints);
    for (int i = forest.trees()[tree].first_node; i < forest.trees()[tree].node_end; ++i)
      if (forest.nodes()[i].dofs == 1) terms.joints.push_back(jointTerm(source, i));
  }
  model.joints = static_cast<int>(terms.joints.size());
  for (const int index : island->mimics) {
    const MimicRelation& m = forest.mimics()[index];
    model.mimics.push_back({forest.nodes()[m.node].first_dof, forest.nodes()[m.master].first_dof, m.multiplier});
  }
  for (const int l : island->loops) {
    BodyPair pair;
    terms.loops.push_back(loopTerm(source, l, &pair));
    model.loop_pairs.push_back(pair);
  }
  makeContactTerms(source, island->contacts, island->solver.team(), &model, &terms);
}

}  // namespace blem_sim::dynamics
