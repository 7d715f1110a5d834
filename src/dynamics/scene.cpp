#include "scene.h"

#include <algorithm>
#include <mutex>

namespace blem_sim {
namespace {

// Worlds an ODE failure left half way through a step: they cannot be destroyed safely, so they are kept out of the way.
struct AbandonedWorld {
  dWorldID world;
  dThreadingImplementationID threading;
  dJointGroupID contact_group;
};

void abandon(const AbandonedWorld& world) {
  static std::mutex mutex;
  // Never destroyed: what it points to stays reachable until the process ends.
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
  // ODE's default job list is shared by all worlds of a process; each of ours has its own.
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
  for (JointSlot& slot : joints_) {
    if (!slot.joint || (slot.spec.child != body && slot.spec.parent != body)) continue;
    dJointDestroy(slot.joint);
    if (slot.motor) dJointDestroy(slot.motor);
    slot.joint = slot.motor = nullptr;
  }
  dBodyDestroy(bodies_[body].ode);
  bodies_[body].ode = nullptr;
  bodies_[body].pending = Wrench();
  orderJoints();
}

void Scene::rebuild(const std::vector<BodyBits>& state) {
  abandon({world_, threading_, contact_group_});
  createWorld();
  for (BodySlot& slot : bodies_)
    if (slot.ode) createBody(&slot);
  // ODE takes a joint's geometry from where its bodies stand.
  for (JointSlot& slot : joints_) {
    if (!slot.joint) continue;
    setBits(slot.spec.child, slot.child_assembled);
    if (slot.spec.parent != WORLD_BODY) setBits(slot.spec.parent, slot.parent_assembled);
    createJoint(&slot);
  }
  setBits(state);
}

void Scene::orderJoints() {
  ++structure_;
  const int body_count = static_cast<int>(bodies_.size());
  std::vector<int> parent(body_count, WORLD_BODY), depth(body_count, 0);
  std::vector<bool> has_parent(body_count, false);
  leaves_first_.clear();
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
    JointSlot& slot = joints_[j];
    if (!slot.joint) continue;
    bool loop = has_parent[slot.spec.child];
    for (int b = slot.spec.parent; b != WORLD_BODY && !loop; b = parent[b]) loop = b == slot.spec.child;
    slot.in_tree = !loop;
    if (loop) continue;
    has_parent[slot.spec.child] = true;
    parent[slot.spec.child] = slot.spec.parent;
    leaves_first_.push_back(j);
  }
  for (int b = 0; b < body_count; ++b)
    for (int a = b; has_parent[a]; a = parent[a]) {
      ++depth[b];
      if (parent[a] == WORLD_BODY) break;
    }
  std::stable_sort(leaves_first_.begin(), leaves_first_.end(),
                   [&](int a, int b) { return depth[joints_[a].spec.child] > depth[joints_[b].spec.child]; });
}

void Scene::bits(std::vector<BodyBits>* out) const {
  out->resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) (*out)[b] = bodies_[b].ode ? bits(static_cast<int>(b)) : BodyBits{};
}

void Scene::setBits(const std::vector<BodyBits>& bits) {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].ode) setBits(static_cast<int>(b), bits[b]);
}

}  // namespace blem_sim
