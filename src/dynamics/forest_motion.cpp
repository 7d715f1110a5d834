#include "forest_motion.h"

#include "joint_motion.h"

namespace blem_sim {
namespace {

/** Twist about the reference point of a unit joint velocity. */
Vector6 jointTwist(JointKind kind, const Vector3& axis_W, const Vector3& origin) {
  return kind == JointKind::REVOLUTE ? spatial(axis_W, origin.cross(axis_W)) : spatial(Vector3::Zero(), axis_W);
}

Pose jointFrame(const ForestNode& node, const ForestMotion& motion) {
  if (node.parent < 0) return node.X_PJ;
  Pose X_WP = Pose::Identity();
  X_WP.linear() = motion.rotation[node.parent];
  X_WP.translation() = motion.origin[node.parent];
  return X_WP * node.X_PJ;
}

}  // namespace

Vector3 jointOrigin(const Forest& forest, int node, const ForestMotion& motion) {
  return jointFrame(forest.nodes()[node], motion).translation();
}

void ForestMotion::resize(const Forest& forest) {
  const std::size_t nodes = forest.nodes().size(), dofs = forest.dofCount(), trees = forest.trees().size();
  for (auto* v : {&origin, &com}) v->resize(nodes);
  for (auto* v : {&twist, &node_twist, &node_force, &drift}) v->resize(nodes);
  for (auto* v : {&inertia, &composite}) v->resize(nodes);
  rotation.resize(nodes);
  position.resize(nodes);
  subspace.resize(dofs);
  for (auto* v : {&velocity, &change, &next_velocity, &products, &applied}) v->setZero(dofs);
  mass.resize(forest.entryCount());
  reference.resize(trees);
  momentum.assign(trees, Vector6::Zero());
  tree_com.resize(trees);
}

void placeBodies(const Forest& forest, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    if (node.joint < 0) continue;
    const Pose X_WB = jointFrame(node, *motion) * jointMotion(node.kind, node.axis, motion->position[i]) * node.X_JC;
    motion->rotation[i] = X_WB.linear();
    motion->origin[i] = X_WB.translation();
  }
}

void computeInertias(const Forest& forest, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  const ForestNode& root = forest.nodes()[t.first_node];
  Vector3& reference = motion->reference[tree];
  reference = motion->origin[t.first_node];
  if (t.free) reference += motion->rotation[t.first_node] * root.inertial.com;
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    motion->com[i] = motion->origin[i] - reference + motion->rotation[i] * node.inertial.com;
    motion->inertia[i] = motion->composite[i] = SpatialInertia(node.inertial, motion->rotation[i], motion->com[i]);
    if (node.joint < 0)
      for (int d = 0; d < 6; ++d) motion->subspace[node.first_dof + d] = Vector6::Unit(d);
    if (node.dofs != 1) continue;
    const Pose X_WJ = jointFrame(node, *motion);
    motion->subspace[node.first_dof] = jointTwist(node.kind, X_WJ.linear() * node.axis, X_WJ.translation() - reference);
  }
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

void computeTwists(const Forest& forest, int tree, const ForestMotion& motion, const Eigen::VectorXd& velocity,
                   std::vector<Vector6>* twist) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    Vector6& v = (*twist)[i];
    if (node.joint < 0) {
      v = velocity.segment<6>(node.first_dof);
      continue;
    }
    if (node.parent < 0)
      v.setZero();
    else
      v = (*twist)[node.parent];
    if (node.dofs == 1) v += motion.subspace[node.first_dof] * velocity[node.first_dof];
  }
}

void computeForces(const Forest& forest, int tree, const Eigen::VectorXd& velocity, const Eigen::VectorXd* acceleration,
                   ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  std::vector<Vector6>&twist = motion->node_twist, &force = motion->node_force;
  computeTwists(forest, tree, *motion, velocity, &twist);
  // First the nodes' accelerations, in `force`.
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    Vector6& a = force[i];
    if (node.parent < 0)
      a.setZero();
    else
      a = force[node.parent];
    if (node.joint < 0) {
      if (acceleration) a = acceleration->segment<6>(node.first_dof);
      // The velocity of a moving centre of mass is given; that of the body's point at the reference is another one.
      a.tail<3>() -= angular(twist[i]).cross(linear(twist[i]));
    } else if (node.dofs == 1) {
      const Vector6& s = motion->subspace[node.first_dof];
      if (node.parent >= 0) a += crossMotion(twist[node.parent], s * velocity[node.first_dof]);
      if (acceleration) a += s * (*acceleration)[node.first_dof];
    }
  }
  for (int i = t.first_node; i < t.node_end; ++i) {
    if (!acceleration) motion->drift[i] = force[i];
    force[i] = motion->inertia[i].times(force[i]) + crossForce(twist[i], motion->inertia[i].times(twist[i]));
  }
}

void computeProducts(const Forest& forest, int tree, const Eigen::VectorXd& velocity, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  computeForces(forest, tree, velocity, nullptr, motion);
  motion->products.segment(t.first_dof, t.dofCount()).setZero();
  addProjected(forest, tree, *motion, 1, &motion->node_force, &motion->products);
}

void computeApplied(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    const Wrench& pending = scene.bodies()[node.body].pending;
    const Vector3 force = node.inertial.mass * scene.gravity() + pending.force;
    motion->node_force[i] = spatial(motion->com[i].cross(force) + pending.torque, force);
  }
  motion->applied.segment(t.first_dof, t.dofCount()).setZero();
  addProjected(forest, tree, *motion, 1, &motion->node_force, &motion->applied);
}

void massTimes(const Forest& forest, int tree, const ForestMotion& motion, const Eigen::VectorXd& v, Eigen::VectorXd* out) {
  const ForestTree& t = forest.trees()[tree];
  out->segment(t.first_dof, t.dofCount()).setZero();
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    const int* column = forest.columns(k);
    const double* row = motion.mass.data() + forest.rowStart(k);
    const int last = forest.rowLength(k) - 1;
    double sum = row[last] * v[k];
    for (int e = 0; e < last; ++e) {
      sum += row[e] * v[column[e]];
      (*out)[column[e]] += row[e] * v[k];
    }
    (*out)[k] += sum;
  }
}

void addProjected(const Forest& forest, int tree, const ForestMotion& motion, double sign, std::vector<Vector6>* wrench,
                  Eigen::VectorXd* out) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    const ForestNode& node = forest.nodes()[i];
    const Vector6& w = (*wrench)[i];
    if (node.joint < 0)
      out->segment<6>(node.first_dof) += sign * w;
    else if (node.dofs == 1)
      (*out)[node.first_dof] += sign * motion.subspace[node.first_dof].dot(w);
    if (node.parent >= 0) (*wrench)[node.parent] += w;
  }
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
      motion->position[i] = scene.jointPosition(node.joint);
      motion->velocity[node.first_dof] = scene.jointVelocity(node.joint);
    }
  }
  motion->change.segment(t.first_dof, t.dofCount()).setZero();
}

void writeTree(const Forest& forest, int tree, const ForestMotion& motion, Scene* scene) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& node = forest.nodes()[i];
    BodyState body;
    body.X_WB.linear() = motion.rotation[i];
    body.X_WB.translation() = motion.origin[i];
    body.w_WB = angular(motion.twist[i]);
    body.v_WCom = velocityAt(motion.twist[i], motion.com[i]);
    scene->setBodyState(node.body, body);
  }
}

}  // namespace blem_sim
