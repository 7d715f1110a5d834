#include "step_islands.h"

#include "scene/contact_motion.h"

namespace blem_sim::dynamics {
namespace {

int treeOfNode(const Forest& forest, int node) { return forest.nodes()[node].tree; }

int treeOfBody(const Forest& forest, int body) { return treeOfNode(forest, forest.nodeOfBody(body)); }

// Whether a body of the contact can move; a contact between two that cannot is no contact.
bool isMoved(const Forest& forest, const ContactConstraint& c) {
  const auto moved = [&](int body) { return body != WORLD_BODY && forest.nodes()[forest.nodeOfBody(body)].last_dof >= 0; };
  return moved(c.body_a) || moved(c.body_b);
}

}  // namespace

void StepIslands::find(const Scene& scene, const Forest& forest, const std::vector<ContactConstraint>& contacts) {
  join(scene, forest, contacts);
  clear();
  fill(scene, forest, contacts);
}

void StepIslands::join(const Scene& scene, const Forest& forest, const std::vector<ContactConstraint>& contacts) {
  joined_.reset(static_cast<int>(forest.trees().size()));
  for (const ContactConstraint& c : contacts)
    if (c.body_a != WORLD_BODY && c.body_b != WORLD_BODY && isUsable(scene, c))
      joined_.join(treeOfBody(forest, c.body_a), treeOfBody(forest, c.body_b));
  for (const MimicRelation& m : forest.mimics()) joined_.join(treeOfNode(forest, m.node), treeOfNode(forest, m.master));
  for (const LoopClosure& l : forest.loops())
    if (l.parent >= 0) joined_.join(treeOfNode(forest, l.child), treeOfNode(forest, l.parent));
  count_ = joined_.number();
}

void StepIslands::clear() {
  if (static_cast<int>(islands_.size()) < count_) islands_.resize(count_);
  for (int i = 0; i < count_; ++i) {
    islands_[i].model.clear();
    for (auto* list : {&islands_[i].contacts, &islands_[i].mimics, &islands_[i].loops}) list->clear();
  }
}

void StepIslands::fill(const Scene& scene, const Forest& forest, const std::vector<ContactConstraint>& contacts) {
  for (int t = 0; t < static_cast<int>(forest.trees().size()); ++t) ofTree(t).model.trees.push_back(t);
  for (int m = 0; m < static_cast<int>(forest.mimics().size()); ++m)
    ofTree(treeOfNode(forest, forest.mimics()[m].node)).mimics.push_back(m);
  for (int l = 0; l < static_cast<int>(forest.loops().size()); ++l) ofTree(treeOfNode(forest, forest.loops()[l].child)).loops.push_back(l);
  for (int i = 0; i < static_cast<int>(contacts.size()); ++i) {
    const ContactConstraint& c = contacts[i];
    if (!isUsable(scene, c) || !isMoved(forest, c)) continue;
    ofTree(treeOfBody(forest, c.body_a != WORLD_BODY ? c.body_a : c.body_b)).contacts.push_back(i);
  }
}

}  // namespace blem_sim::dynamics
