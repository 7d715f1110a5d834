#include "trees/forest_motion.h"

#include <algorithm>

#include "lanes/lanes.h"
#include "scene/joint_readings.h"

namespace blem_sim::dynamics {
namespace {

/** Twist about the reference point of a unit joint velocity. */
Vector6 jointTwist(JointKind kind, const Vector3& axis_W, const Vector3& origin) {
  return kind == JointKind::REVOLUTE ? spatial(axis_W, origin.cross(axis_W)) : spatial(Vector3::Zero(), axis_W);
}

}  // namespace

void ForestMotion::resize(const Forest& forest) {
  const std::size_t nodes = forest.nodes().size(), dofs = forest.dofCount(), trees = forest.trees().size();
  for (auto* v : {&origin, &com, &joint_origin, &joint_axis}) v->resize(nodes);
  for (auto* v : {&twist, &node_twist, &node_force, &node_change, &drift}) v->assign(nodes, Vector6::Zero());
  for (auto* v : {&inertia, &composite}) v->resize(nodes);
  rotation.resize(nodes);
  position.resize(nodes);
  subspace.resize(dofs);
  for (auto* v : {&velocity, &change, &next_velocity, &products, &applied, &owed}) v->setZero(dofs);
  mass.assign(forest.entryCount(), 0);
  reference.resize(trees);
  momentum.assign(trees, Vector6::Zero());
  tree_com.resize(trees);
  pace.assign(trees, Pace::SLOW);
  lead.assign(trees, Lead());
}

BLEM_SIM_LANES void placeBodies(const Forest& forest, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    if (node.joint < 0) continue;
    const bool held = node.parent < 0;
    Matrix3 R_WJ = node.X_PJ.linear();
    Vector3 p_WJ = node.X_PJ.translation();
    if (!held) {
      R_WJ = motion->rotation[node.parent] * R_WJ;
      p_WJ = motion->origin[node.parent] + motion->rotation[node.parent] * p_WJ;
    }
    motion->joint_origin[i] = p_WJ;
    motion->joint_axis[i] = R_WJ * node.axis;
    if (node.kind == JointKind::PRISMATIC) p_WJ += motion->position[i] * motion->joint_axis[i];
    if (node.kind == JointKind::REVOLUTE) R_WJ *= Eigen::AngleAxisd(motion->position[i], node.axis).toRotationMatrix();
    motion->rotation[i] = R_WJ * node.X_JC.linear();
    motion->origin[i] = p_WJ + R_WJ * node.X_JC.translation();
  }
}

BLEM_SIM_LANES void computeBodies(const Forest& forest, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  const Vector3& reference = motion->reference[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    motion->com[i] = motion->origin[i] - reference + motion->rotation[i] * node.inertial.com;
    motion->inertia[i] = SpatialInertia(node.inertial, motion->rotation[i], motion->com[i]);
    if (node.joint < 0)
      for (int d = 0; d < 6; ++d) motion->subspace[node.first_dof + d] = Vector6::Unit(d);
    if (node.dofs == 1)
      motion->subspace[node.first_dof] = jointTwist(node.kind, motion->joint_axis[i], motion->joint_origin[i] - reference);
  }
}

BLEM_SIM_LANES void computeInertias(const Forest& forest, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  Vector3& reference = motion->reference[tree];
  reference = motion->origin[t.first_node];
  if (t.free) reference += motion->rotation[t.first_node] * forest.nodes()[t.first_node].inertial.com;
  computeBodies(forest, tree, motion);
  for (int i = t.first_node; i < t.node_end; ++i) motion->composite[i] = motion->inertia[i];
  for (int i = t.node_end - 1; i > t.first_node; --i) motion->composite[forest.nodes()[i].parent].add(motion->composite[i]);
  const SpatialInertia& whole = motion->composite[t.first_node];
  motion->tree_com[tree] = whole.first_moment / whole.mass;
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    const Vector6 momentum = motion->composite[forest.nodeOfDof(k)].times(motion->subspace[k]);
    const int* column = forest.columns(k);
    double* row = motion->mass.data() + forest.rowStart(k);
    const int length = forest.rowLength(k), unit = t.free ? std::min(6, length) : 0;
    for (int e = 0; e < unit; ++e) row[e] = momentum[e];
    for (int e = unit; e < length; ++e) row[e] = motion->subspace[column[e]].dot(momentum);
    row[length - 1] += forest.nodes()[forest.nodeOfDof(k)].armature;
  }
  computeTwists(forest, tree, *motion, motion->velocity, &motion->twist);
}

void computeTwist(const Forest& forest, int node, const ForestMotion& motion, const Eigen::VectorXd& velocity,
                  std::vector<Vector6>* twist) {
  const ForestNode& n = forest.nodes()[node];
  Vector6& v = (*twist)[node];
  if (n.joint < 0) {
    v = velocity.segment<6>(n.first_dof);
    return;
  }
  if (n.parent < 0)
    v.setZero();
  else
    v = (*twist)[n.parent];
  if (n.dofs == 1) v += motion.subspace[n.first_dof] * velocity[n.first_dof];
}

BLEM_SIM_LANES void computeTwists(const Forest& forest, int tree, const ForestMotion& motion, const Eigen::VectorXd& velocity,
                                  std::vector<Vector6>* twist) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) computeTwist(forest, i, motion, velocity, twist);
}

BLEM_SIM_LANES void computeProducts(const Forest& forest, int tree, const Eigen::VectorXd& velocity, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  std::vector<Vector6>&twist = motion->node_twist, &force = motion->node_force;
  computeTwists(forest, tree, *motion, velocity, &twist);
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    Vector6& drift = motion->drift[i];
    if (node.parent < 0)
      drift.setZero();
    else
      drift = motion->drift[node.parent];
    // A root's dofs hold the velocity of its moving centre of mass; that of the body's point at the reference is another one.
    if (node.joint < 0)
      drift.tail<3>() = -angular(twist[i]).cross(linear(twist[i]));
    else if (node.dofs == 1 && node.parent >= 0)
      drift += crossMotion(twist[node.parent], motion->subspace[node.first_dof] * velocity[node.first_dof]);
    force[i] = motion->inertia[i].times(drift) + crossForce(twist[i], motion->inertia[i].times(twist[i]));
  }
  motion->products.segment(t.first_dof, t.dofCount()).setZero();
  WrenchProjection{forest, *motion, 1, &force, &motion->products}.addTree(tree);
}

void computeApplied(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  const Vector3& gravity = scene.gravity();
  bool pushed = false;
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    const Wrench& pending = scene.bodies()[node.body].pending;
    pushed |= !pending.force.isZero(0) || !pending.torque.isZero(0);
    if (node.dofs == 0) continue;
    const SpatialInertia& whole = motion->composite[i];
    const Vector6 weight = spatial(whole.first_moment.cross(gravity), whole.mass * gravity);
    if (node.joint < 0)
      motion->applied.segment<6>(node.first_dof) = weight;
    else
      motion->applied[node.first_dof] = motion->subspace[node.first_dof].dot(weight);
  }
  if (!pushed) return;
  for (int i = t.first_node; i < t.node_end; ++i) {
    const Wrench& pending = scene.bodies()[forest.nodes()[i].body].pending;
    motion->node_force[i] = spatial(motion->com[i].cross(pending.force) + pending.torque, pending.force);
  }
  WrenchProjection{forest, *motion, 1, &motion->node_force, &motion->applied}.addTree(tree);
}

void WrenchProjection::addNode(int node) const {
  const ForestNode& n = forest.nodes()[node];
  const Vector6& w = (*wrench)[node];
  if (n.joint < 0)
    out->segment<6>(n.first_dof) += sign * w;
  else if (n.dofs == 1)
    (*out)[n.first_dof] += sign * motion.subspace[n.first_dof].dot(w);
  if (n.parent >= 0) (*wrench)[n.parent] += w;
}

void WrenchProjection::addTree(int tree) const {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.node_end - 1; i >= t.first_node; --i) addNode(i);
}

void readTree(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    motion->position[i] = 0;
    if (node.joint < 0) {
      const BodyState body = scene.bodyState(node.body);
      motion->rotation[i] = body.X_WB.linear();
      motion->origin[i] = body.X_WB.translation();
      motion->velocity.segment<6>(node.first_dof) = spatial(body.w_WB, body.v_WCom);
    } else if (node.dofs == 1) {
      motion->position[i] = jointPosition(scene, node.joint);
      motion->velocity[node.first_dof] = jointVelocity(scene, node.joint);
    }
  }
  motion->change.segment(t.first_dof, t.dofCount()).setZero();
  motion->owed.segment(t.first_dof, t.dofCount()).setZero();
}

void writeTree(const Forest& forest, int tree, const ForestMotion& motion, Scene* scene, std::vector<BodyBits>* written) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    BodyBits& bits = (*written)[i];
    bits.set(motion.reference[tree] + motion.com[i], motion.rotation[i], velocityAt(motion.twist[i], motion.com[i]),
             angular(motion.twist[i]));
    scene->setBits(forest.nodes()[i].body, bits);
  }
}

}  // namespace blem_sim::dynamics
