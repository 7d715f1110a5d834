#include "trees/forest.h"

#include "scene/joint_motion.h"

namespace blem_sim::dynamics {
namespace {

/** Pose of body B from its centre of mass and rotation. */
Pose bodyPose(const BodyBits& bits, const geometry::MassProperties& body) {
  Pose X_WB = Pose::Identity();
  X_WB.linear() = bits.rotation();
  X_WB.translation() = bits.com() - bits.rotation() * body.com;
  return X_WB;
}

/** Child body against the joint frame at position 0. */
Pose childInJoint(const Scene& scene, const JointSlot& slot) {
  const bool grounded = slot.spec.parent == WORLD_BODY;
  const Pose X_WP = grounded ? Pose::Identity() : bodyPose(slot.parent_assembled, scene.bodies()[slot.spec.parent].spec.inertial);
  const Pose assembled = (X_WP * slot.spec.X_PJ).inverse() * bodyPose(slot.child_assembled, scene.bodies()[slot.spec.child].spec.inertial);
  return jointMotion(slot.spec.kind, slot.spec.axis, -slot.assembled_position) * assembled;
}

}  // namespace

void Forest::build(const Scene& scene) {
  const int bodies = static_cast<int>(scene.bodies().size());
  nodes_.clear();
  trees_.clear();
  mimics_.clear();
  loops_.clear();
  dof_node_.clear();
  columns_.clear();
  row_start_.assign(1, 0);
  row_length_.clear();
  body_node_.assign(bodies, -1);
  findJoints(scene);
  const auto carried = [&](int body) { return body_joint_[body] >= 0 && scene.joints()[body_joint_[body]].spec.parent != WORLD_BODY; };
  for (int body = 0; body < bodies; ++body)
    if (scene.exists(body) && !carried(body)) addTree(scene, body);
  findMimics(scene);
  for (std::size_t j = 0; j < scene.joints().size(); ++j) {
    const JointSlot& slot = scene.joints()[j];
    if (!slot.joint || slot.in_tree) continue;
    LoopClosure loop;
    loop.joint = static_cast<int>(j);
    loop.child = body_node_[slot.spec.child];
    loop.parent = slot.spec.parent == WORLD_BODY ? -1 : body_node_[slot.spec.parent];
    loop.kind = slot.spec.kind;
    loop.X_PJ = slot.spec.X_PJ;
    loop.X_CJ = childInJoint(scene, slot).inverse();
    loop.axis = slot.spec.axis;
    loops_.push_back(loop);
  }
}

void Forest::findJoints(const Scene& scene) {
  body_joint_.assign(scene.bodies().size(), -1);
  first_joint_.assign(scene.bodies().size(), -1);
  next_joint_.assign(scene.joints().size(), -1);
  for (int j = static_cast<int>(scene.joints().size()) - 1; j >= 0; --j) {
    const JointSlot& slot = scene.joints()[j];
    if (!slot.joint || !slot.in_tree) continue;
    body_joint_[slot.spec.child] = j;
    if (slot.spec.parent == WORLD_BODY) continue;
    next_joint_[j] = first_joint_[slot.spec.parent];
    first_joint_[slot.spec.parent] = j;
  }
}

void Forest::addTree(const Scene& scene, int root) {
  const int joint = body_joint_[root];
  ForestTree tree;
  tree.first_node = static_cast<int>(nodes_.size());
  tree.first_dof = dofCount();
  tree.free = joint < 0;
  trees_.push_back(tree);
  addNode(scene, root, -1, joint);
  trees_.back().node_end = static_cast<int>(nodes_.size());
  trees_.back().dof_end = dofCount();
}

void Forest::addNode(const Scene& scene, int body, int parent, int joint) {
  ForestNode node;
  node.body = body;
  node.tree = static_cast<int>(trees_.size()) - 1;
  node.parent = parent;
  node.joint = joint;
  node.inertial = scene.bodies()[body].spec.inertial;
  node.dofs = 6;
  if (joint >= 0) {
    const JointSlot& slot = scene.joints()[joint];
    node.kind = slot.spec.kind;
    node.X_PJ = slot.spec.X_PJ;
    node.axis = slot.spec.axis;
    node.armature = slot.spec.armature;
    node.X_JC = childInJoint(scene, slot);
    node.dofs = node.kind == JointKind::FIXED ? 0 : 1;
  }
  const int index = static_cast<int>(nodes_.size());
  addDofs(&node, index);
  body_node_[body] = index;
  nodes_.push_back(node);
  for (int j = first_joint_[body]; j >= 0; j = next_joint_[j]) addNode(scene, scene.joints()[j].spec.child, index, j);
}

void Forest::addDofs(ForestNode* node, int index) {
  node->first_dof = dofCount();
  node->last_dof = node->parent < 0 ? -1 : nodes_[node->parent].last_dof;
  for (int d = 0; d < node->dofs; ++d) {
    const int dof = dofCount(), before = node->last_dof;
    if (before >= 0)
      for (int e = 0; e < row_length_[before]; ++e) columns_.push_back(columns_[row_start_[before] + e]);
    columns_.push_back(dof);
    row_length_.push_back(static_cast<int>(columns_.size()) - row_start_.back());
    while (columns_.size() % ROW_UNIT != 0) columns_.push_back(-1);
    row_start_.push_back(static_cast<int>(columns_.size()));
    dof_node_.push_back(index);
    node->last_dof = dof;
  }
}

void Forest::findMimics(const Scene& scene) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].dofs != 1 || scene.joints()[nodes_[i].joint].spec.mimic_joint < 0) continue;
    MimicRelation relation{static_cast<int>(i), -1};
    const JointSpec* spec = &scene.joints()[nodes_[i].joint].spec;
    for (; spec->mimic_joint >= 0; spec = &scene.joints()[spec->mimic_joint].spec) {
      relation.offset += relation.multiplier * spec->mimic_offset;
      relation.multiplier *= spec->mimic_multiplier;
    }
    relation.master = body_node_[spec->child];
    if (relation.master >= 0) mimics_.push_back(relation);
  }
}

}  // namespace blem_sim::dynamics
