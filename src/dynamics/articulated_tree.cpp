#include "articulated_tree.h"

#include <cmath>

namespace blem_sim {

namespace {

SpatialInertia bodyInertia(const MassProperties& body, const Pose& X_WB, const Vector3& reference) {
  SpatialInertia inertia;
  const Vector3 com = X_WB * body.com - reference;
  inertia.mass = body.mass;
  inertia.first_moment = body.mass * com;
  inertia.rotational = X_WB.linear() * body.inertia * X_WB.linear().transpose() +
                       body.mass * (com.squaredNorm() * Matrix3::Identity() - com * com.transpose());
  return inertia;
}

/** Spatial cross product of twists: rate of change of w when carried along by v. */
Vector6 crossMotion(const Vector6& v, const Vector6& w) {
  Vector6 out;
  out.head<3>() = v.head<3>().cross(w.head<3>());
  out.tail<3>() = v.head<3>().cross(w.tail<3>()) + v.tail<3>().cross(w.head<3>());
  return out;
}

/** Spatial cross product of a twist and a momentum. */
Vector6 crossForce(const Vector6& v, const Vector6& f) {
  Vector6 out;
  out.head<3>() = v.head<3>().cross(f.head<3>()) + v.tail<3>().cross(f.tail<3>());
  out.tail<3>() = v.head<3>().cross(f.tail<3>());
  return out;
}

/** Twist about `reference` of a unit joint velocity. */
Vector6 jointTwist(JointKind kind, const Vector3& axis_W, const Vector3& origin_W, const Vector3& reference) {
  Vector6 twist = Vector6::Zero();
  if (kind == JointKind::REVOLUTE) {
    twist.head<3>() = axis_W;
    twist.tail<3>() = (origin_W - reference).cross(axis_W);
  } else {
    twist.tail<3>() = axis_W;
  }
  return twist;
}

Pose jointMotion(const JointSpec& joint, double position) {
  Pose X_JC = Pose::Identity();
  if (joint.kind == JointKind::REVOLUTE) X_JC.linear() = Eigen::AngleAxisd(position, joint.axis).toRotationMatrix();
  if (joint.kind == JointKind::PRISMATIC) X_JC.translation() = position * joint.axis;
  return X_JC;
}

/** Pose of body B from its centre of mass and rotation. */
Pose bodyPose(const BodyBits& bits, const MassProperties& body) {
  Pose X_WB = Pose::Identity();
  X_WB.linear() = bits.rotation();
  X_WB.translation() = bits.com() - bits.rotation() * body.com;
  return X_WB;
}

/** Child body against the joint frame where the joint was made. */
Pose assembledPose(const Scene& scene, const JointSlot& slot) {
  const bool grounded = slot.spec.parent == WORLD_BODY;
  const Pose X_WP = grounded ? Pose::Identity() : bodyPose(slot.parent_assembled, scene.bodies()[slot.spec.parent].spec.inertial);
  return (X_WP * slot.spec.X_PJ).inverse() * bodyPose(slot.child_assembled, scene.bodies()[slot.spec.child].spec.inertial);
}

}  // namespace

Vector6 SpatialInertia::times(const Vector6& v) const {
  Vector6 out;
  out.head<3>() = rotational * v.head<3>() + first_moment.cross(v.tail<3>());
  out.tail<3>() = mass * v.tail<3>() - first_moment.cross(v.head<3>());
  return out;
}

ArticulatedTree::ArticulatedTree(const Scene& scene, int root) {
  int joint = -1;
  for (std::size_t j = 0; j < scene.joints().size(); ++j)
    if (scene.joints()[j].joint && scene.joints()[j].spec.child == root) joint = static_cast<int>(j);
  addNode(scene, root, -1, joint);
}

void ArticulatedTree::addNode(const Scene& scene, int body, int parent, int joint) {
  TreeNode node;
  node.body = body;
  node.parent = parent;
  node.joint = joint;
  node.first_dof = dof_count_;
  if (joint < 0) {
    node.dofs = 6;
  } else {
    const JointSlot& slot = scene.joints()[joint];
    node.kind = slot.spec.kind;
    node.X_JC = jointMotion(slot.spec, -slot.assembled_position) * assembledPose(scene, slot);
    node.dofs = node.kind == JointKind::FIXED ? 0 : 1;
  }
  const int index = static_cast<int>(nodes_.size());
  int last = parent < 0 ? -1 : last_dof_[parent];
  for (int d = 0; d < node.dofs; ++d) {
    dof_node_.push_back(index);
    dof_parent_.push_back(last);
    last = dof_count_++;
  }
  nodes_.push_back(node);
  last_dof_.push_back(last);
  for (std::size_t j = 0; j < scene.joints().size(); ++j) {
    const JointSlot& slot = scene.joints()[j];
    if (slot.joint && slot.in_tree && slot.spec.parent == body) addNode(scene, slot.spec.child, index, static_cast<int>(j));
  }
}

void ArticulatedTree::kinematics(const Scene& scene, const Pose& root_pose, const std::vector<double>& positions,
                                 const Eigen::VectorXd& velocity, TreeState* state) const {
  const std::size_t n = nodes_.size();
  state->X_WB.resize(n);
  state->inertia.resize(n);
  state->subspace.resize(dof_count_);
  for (std::size_t i = 0; i < n; ++i) {
    const TreeNode& node = nodes_[i];
    if (node.joint < 0) {
      state->X_WB[i] = root_pose;
      state->reference = root_pose * scene.bodies()[node.body].spec.inertial.com;
      for (int d = 0; d < 6; ++d) state->subspace[node.first_dof + d] = Vector6::Unit(d);
    } else {
      const JointSpec& joint = scene.joints()[node.joint].spec;
      const Pose X_WJ = (node.parent < 0 ? Pose::Identity() : state->X_WB[node.parent]) * joint.X_PJ;
      state->X_WB[i] = X_WJ * jointMotion(joint, positions[i]) * node.X_JC;
      if (node.parent < 0) state->reference = state->X_WB[i].translation();
      if (node.dofs == 1)
        state->subspace[node.first_dof] = jointTwist(node.kind, X_WJ.linear() * joint.axis, X_WJ.translation(), state->reference);
    }
    state->inertia[i] = bodyInertia(scene.bodies()[node.body].spec.inertial, state->X_WB[i], state->reference);
  }
  setVelocity(velocity, state);
}

void ArticulatedTree::setVelocity(const Eigen::VectorXd& velocity, TreeState* state) const {
  state->twist.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const TreeNode& node = nodes_[i];
    Vector6& twist = state->twist[i];
    twist = node.parent < 0 ? Vector6(Vector6::Zero()) : state->twist[node.parent];
    for (int d = node.first_dof; d < node.first_dof + node.dofs; ++d) twist += state->subspace[d] * velocity[d];
  }
}

void ArticulatedTree::bias(const Scene& scene, const TreeState& state, Eigen::VectorXd* out) const {
  const std::size_t n = nodes_.size();
  std::vector<Vector6> acceleration(n), force(n);
  for (std::size_t i = 0; i < n; ++i) {
    const TreeNode& node = nodes_[i];
    Vector6 a = node.parent < 0 ? Vector6::Zero() : acceleration[node.parent];
    if (node.parent < 0) a.tail<3>() = -scene.gravity();
    // The free root's unknown is the velocity of its moving centre of mass; a twist's rate is that of a fixed point.
    if (node.joint < 0) a.tail<3>() -= state.twist[i].head<3>().cross(Vector3(state.twist[i].tail<3>()));
    if (node.dofs == 1) {
      const Vector6 parent_twist = node.parent < 0 ? Vector6::Zero() : state.twist[node.parent];
      const Vector6 joint_twist = state.twist[i] - parent_twist;
      a += crossMotion(parent_twist, joint_twist);
    }
    acceleration[i] = a;
    force[i] = state.inertia[i].times(a) + crossForce(state.twist[i], state.inertia[i].times(state.twist[i]));
    const BodySlot& body = scene.bodies()[node.body];
    const Vector3 com = state.X_WB[i] * body.spec.inertial.com - state.reference;
    force[i].head<3>() -= body.pending.torque + com.cross(body.pending.force);
    force[i].tail<3>() -= body.pending.force;
  }
  out->resize(dof_count_);
  for (std::size_t i = n; i-- > 0;) {
    const TreeNode& node = nodes_[i];
    for (int d = 0; d < node.dofs; ++d) (*out)[node.first_dof + d] = state.subspace[node.first_dof + d].dot(force[i]);
    if (node.parent >= 0) force[node.parent] += force[i];
  }
}

void ArticulatedTree::massMatrix(const TreeState& state, Eigen::MatrixXd* out) const {
  std::vector<SpatialInertia> composite = state.inertia;
  for (std::size_t i = nodes_.size(); i-- > 1;)
    if (nodes_[i].parent >= 0) composite[nodes_[i].parent].add(composite[i]);
  out->setZero(dof_count_, dof_count_);
  for (int k = 0; k < dof_count_; ++k) {
    const Vector6 momentum = composite[dof_node_[k]].times(state.subspace[k]);
    for (int j = k; j >= 0; j = dof_parent_[j]) (*out)(k, j) = state.subspace[j].dot(momentum);
  }
}

void ArticulatedTree::read(const Scene& scene, std::vector<double>* positions, Eigen::VectorXd* velocity, Pose* root_pose) const {
  positions->assign(nodes_.size(), 0);
  velocity->setZero(dof_count_);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const TreeNode& node = nodes_[i];
    if (node.joint < 0) {
      const BodyState body = scene.bodyState(node.body);
      *root_pose = body.X_WB;
      velocity->segment<3>(node.first_dof) = body.w_WB;
      velocity->segment<3>(node.first_dof + 3) = body.v_WCom;
      continue;
    }
    if (node.dofs == 0) continue;
    (*positions)[i] = scene.jointPosition(node.joint);
    (*velocity)[node.first_dof] = scene.jointVelocity(node.joint);
  }
}

void ArticulatedTree::write(const TreeState& state, Scene* scene) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    BodyState body;
    body.X_WB = state.X_WB[i];
    body.w_WB = state.twist[i].head<3>();
    const Vector3 com = body.X_WB * scene->bodies()[nodes_[i].body].spec.inertial.com - state.reference;
    body.v_WCom = state.twist[i].tail<3>() + body.w_WB.cross(com);
    scene->setBodyState(nodes_[i].body, body);
  }
}

}  // namespace blem_sim
