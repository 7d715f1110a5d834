#include "scene/scene.h"

#include <algorithm>
#include <limits>
#include <mutex>

namespace blem_sim::dynamics {
namespace {

// Worlds an ODE failure left half way through a step: they cannot be destroyed safely, so they are kept out of the way.
struct AbandonedWorld {
  dWorldID world;
  dThreadingImplementationID threading;
  dJointGroupID contact_group;
};

void abandon(const AbandonedWorld& world) {
  static std::mutex mutex;
  // Never destroyed: the worlds it points to stay reachable until the process ends.
  static std::vector<AbandonedWorld>& abandoned = *new std::vector<AbandonedWorld>;
  const std::lock_guard<std::mutex> lock(mutex);
  abandoned.push_back(world);
}

}  // namespace

Scene::Scene(const Vector3& gravity, const SolverSettings& settings) : settings_(settings), gravity_(gravity) { createWorld(); }

Scene::~Scene() {
  dJointGroupDestroy(contact_group_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

void Scene::createWorld() {
  world_ = dWorldCreate();
  contact_group_ = dJointGroupCreate(0);
  // ODE's default job list is shared by all worlds of a process; each scene has its own.
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_), threading_);
  dWorldSetGravity(world_, gravity_.x(), gravity_.y(), gravity_.z());
  dWorldSetERP(world_, settings_.joint_erp);
  dWorldSetCFM(world_, settings_.joint_cfm);
  dWorldSetContactSurfaceLayer(world_, 0);
  dWorldSetAutoDisableFlag(world_, 0);
}

void Scene::setGravity(const Vector3& gravity) {
  gravity_ = gravity;
  dWorldSetGravity(world_, gravity.x(), gravity.y(), gravity.z());
}

void Scene::removeBody(int body) {
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j)
    if (joints_[j].joint && (joints_[j].spec.child == body || joints_[j].spec.parent == body)) emptyJoint(j);
  dBodyDestroy(bodies_[body].ode);
  bodies_[body] = BodySlot();
  free_bodies_.insert(body);
  findTrees();
}

void Scene::removeJoint(int joint) {
  emptyJoint(joint);
  findTrees();
}

// Empties a joint's slot, which then ties nothing: other bodies and joints may come to have the indices that its spec names.
void Scene::emptyJoint(int joint) {
  JointSlot& slot = joints_[joint];
  dJointDestroy(slot.joint);
  if (slot.motor) dJointDestroy(slot.motor);
  slot.joint = slot.motor = nullptr;
  slot.occupant = 0;
  slot.spec.parent = WORLD_BODY;
  slot.spec.mimic_joint = -1;
  slot.spec.name.clear();
  slot.spec.lower = -std::numeric_limits<double>::infinity();
  slot.spec.upper = std::numeric_limits<double>::infinity();
  slot.spec.armature = 0;
  slot.last_position = slot.last_effort = 0;
  for (JointSlot& other : joints_)
    if (other.spec.mimic_joint == joint) other.spec.mimic_joint = -1;
  free_joints_.insert(joint);
}

void Scene::rebuild(const std::vector<BodyBits>& state) {
  abandon({world_, threading_, contact_group_});
  createWorld();
  for (BodySlot& slot : bodies_)
    if (slot.ode) createBody(&slot);
  // ODE takes a joint's geometry from where its bodies stand.
  for (JointSlot& slot : joints_) {
    if (slot.joint) createJointWhereAssembled(&slot);
  }
  setBits(state);
}

void Scene::recreateJoint(JointSlot* slot) {
  std::vector<BodyBits> now;
  bits(&now);
  dJointDestroy(slot->joint);
  if (slot->motor) dJointDestroy(slot->motor);
  slot->motor = nullptr;
  createJointWhereAssembled(slot);
  setBits(now);
}

void Scene::createJointWhereAssembled(JointSlot* slot) {
  setBits(slot->spec.child, slot->child_assembled);
  if (slot->spec.parent != WORLD_BODY) setBits(slot->spec.parent, slot->parent_assembled);
  createJoint(slot);
}

// A joint closes a loop if its child has a joint of a tree already, or if its parent hangs on the child.
void Scene::placeInTree(int joint) {
  JointSlot& slot = joints_[joint];
  tree_parent_.resize(bodies_.size(), WORLD_BODY);
  has_parent_.resize(bodies_.size(), 0);
  bool loop = has_parent_[slot.spec.child] != 0;
  for (int b = slot.spec.parent; b != WORLD_BODY && !loop; b = tree_parent_[b]) loop = b == slot.spec.child;
  slot.in_tree = !loop;
  ++structure_;
  ordered_ = false;
  if (loop) return;
  has_parent_[slot.spec.child] = 1;
  tree_parent_[slot.spec.child] = slot.spec.parent;
}

void Scene::findTrees() {
  ++structure_;
  ordered_ = false;
  tree_parent_.clear();
  has_parent_.clear();
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j)
    if (joints_[j].joint) placeInTree(j);
}

const std::vector<int>& Scene::leavesFirst() const {
  if (!ordered_) orderJoints();
  return leaves_first_;
}

void Scene::orderJoints() const {
  ordered_ = true;
  leaves_first_.clear();
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j)
    if (joints_[j].joint && joints_[j].in_tree) leaves_first_.push_back(j);
  // Joints between a body and the root of its tree.
  constexpr int UNKNOWN = -1;
  depth_.assign(has_parent_.size(), UNKNOWN);
  std::vector<int> way;
  for (const int joint : leaves_first_) {
    int body = joints_[joint].spec.child;
    for (; body != WORLD_BODY && depth_[body] == UNKNOWN; body = has_parent_[body] ? tree_parent_[body] : WORLD_BODY) way.push_back(body);
    for (int above = body == WORLD_BODY ? 0 : depth_[body]; !way.empty(); way.pop_back())
      depth_[way.back()] = has_parent_[way.back()] ? ++above : above;
  }
  std::stable_sort(leaves_first_.begin(), leaves_first_.end(),
                   [&](int a, int b) { return depth_[joints_[a].spec.child] > depth_[joints_[b].spec.child]; });
}

void Scene::bits(std::vector<BodyBits>* out) const {
  out->resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) (*out)[b] = bodies_[b].ode ? bits(static_cast<int>(b)) : BodyBits{};
}

void Scene::setBits(const std::vector<BodyBits>& bits) {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].ode) setBits(static_cast<int>(b), bits[b]);
}

}  // namespace blem_sim::dynamics
