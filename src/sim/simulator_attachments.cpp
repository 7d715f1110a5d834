// Models that are welded to others for a while: grasps without friction, suction cups, tools.
#include <fmt/format.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "numbers/nearest_name.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

/** Bodies that hang rigidly together with one, itself among them. */
std::vector<int> rigidWith(const dynamics::World& world, int body) {
  std::vector<int> bodies = {body};
  const auto add = [&](int other) {
    if (other != dynamics::WORLD_BODY && std::find(bodies.begin(), bodies.end(), other) == bodies.end()) bodies.push_back(other);
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i] == dynamics::WORLD_BODY) continue;
    for (int joint = 0; joint < world.jointCount(); ++joint) {
      if (!world.hasJoint(joint) || world.jointSpec(joint).kind != dynamics::JointKind::FIXED) continue;
      const dynamics::JointSpec& spec = world.jointSpec(joint);
      if (spec.child == bodies[i]) add(spec.parent);
      if (spec.parent == bodies[i]) add(spec.child);
    }
  }
  return bodies;
}

/** Pairs of colliders of different models among these bodies, and those of the static model that carries one of them. */
std::vector<std::pair<int, int>> pairsAmong(const SimulatedWorld& world, const std::vector<int>& bodies, const LinkPart& part) {
  std::vector<int> members;
  for (int i = 0; i < static_cast<int>(world.colliders.size()); ++i) {
    const contact::Collider& c = world.colliders[i];
    const bool is_static = c.body == dynamics::WORLD_BODY && part.body == dynamics::WORLD_BODY && c.model == part.model;
    const bool hangs = c.body != dynamics::WORLD_BODY && std::find(bodies.begin(), bodies.end(), c.body) != bodies.end();
    if (c.enabled && (is_static || hangs)) members.push_back(i);
  }
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = i + 1; j < members.size(); ++j)
      if (world.colliders[members[i]].model != world.colliders[members[j]].model) pairs.emplace_back(members[i], members[j]);
  return pairs;
}

/** State of a body that a part carries: as the part moves, at the place that the weld gives it. */
dynamics::BodyState carriedBy(const dynamics::World& world, const AttachedModel& weld) {
  dynamics::BodyState state;
  const dynamics::BodyState carrier = weld.part.body == dynamics::WORLD_BODY ? dynamics::BodyState() : world.bodyState(weld.part.body);
  state.X_WB = carrier.X_WB * world.jointSpec(weld.joint).X_PJ;
  if (weld.part.body == dynamics::WORLD_BODY) return state;
  const Vector3 com = state.X_WB * world.bodySpec(weld.body).inertial.com;
  state.w_WB = carrier.w_WB;
  state.v_WCom = carrier.v_WCom + carrier.w_WB.cross(com - carrier.X_WB * world.bodySpec(weld.part.body).inertial.com);
  return state;
}

void checkLimit(const char* field, double limit) {
  if (!(limit > 0))
    throw InputError(fmt::format("{}: is {:g}; give it more than 0, or infinity for a weld that holds anything", field, limit));
}

}  // namespace

const AttachedModel* Simulator::Impl::carrierOf(int model) const {
  for (const AttachedModel& weld : world_.attachments)
    if (weld.model == model) return &weld;
  return nullptr;
}

void Simulator::Impl::attach(const std::string& object, const LinkPart& part, double max_force, double max_torque) {
  requireName(object, modelNames(world_.models), "attach", "model");
  const int model = world_.modelIndex(object), robot = world_.robotOf(model);
  if (world_.models[model].kind == ModelKind::ENVIRONMENT || (robot >= 0 && world_.robots[robot].fixed_base))
    throw InputError(fmt::format("'{}' is fixed to the world; attach something that can move", object));
  if (const AttachedModel* by = carrierOf(model))
    throw InputError(fmt::format("'{}' is attached to '{}' already; detach it first", object, by->part.name));
  for (int carrier = part.model; carrier >= 0; carrier = carrierOf(carrier) ? carrierOf(carrier)->part.model : -1)
    if (carrier == model) throw InputError(fmt::format("'{}' cannot carry '{}', which is what it hangs on", part.name, object));
  checkLimit("max_force", max_force);
  checkLimit("max_torque", max_torque);

  AttachedModel weld;
  weld.object = object;
  weld.model = model;
  weld.body = world_.models[model].bodies.front();
  weld.part = part;
  weld.max_force = max_force;
  weld.max_torque = max_torque;
  const dynamics::World& world = world_.world;
  dynamics::JointSpec spec;
  spec.name = object + "::attached";
  spec.kind = dynamics::JointKind::FIXED;
  spec.parent = part.body;
  spec.child = weld.body;
  const Pose X_WP = part.body == dynamics::WORLD_BODY ? Pose::Identity() : world.bodyState(part.body).X_WB;
  spec.X_PJ = X_WP.inverse() * world.bodyState(weld.body).X_WB;
  weld.joint = world_.addJoint(spec, 0, JointMotor(MotorSettings(), 0));
  world_.attachments.push_back(weld);
  partWelded();
  forgetContacts(world_.collidersOf(model));
  layout_.clear();
  reportWithoutStep();
}

void Simulator::Impl::detach(const std::string& object) {
  auto& welds = world_.attachments;
  const auto weld = std::find_if(welds.begin(), welds.end(), [&](const AttachedModel& w) { return w.object == object; });
  if (weld == welds.end()) throw InputError(fmt::format("'{}' is not attached to anything", object));
  removeAttachment(weld - welds.begin());
  reportWithoutStep();
}

void Simulator::Impl::detachAll(int model) {
  for (std::size_t i = world_.attachments.size(); i-- > 0;)
    if (world_.attachments[i].model == model || world_.attachments[i].part.model == model) removeAttachment(i);
}

void Simulator::Impl::removeAttachment(std::size_t index) {
  const AttachedModel weld = world_.attachments[index];
  for (const std::pair<int, int>& pair : weld.never_touch) world_.disabled_pairs.erase(pair);
  world_.removeJoint(weld.joint);
  world_.attachments.erase(world_.attachments.begin() + static_cast<std::ptrdiff_t>(index));
  partWelded();
  forgetContacts(world_.collidersOf(weld.model));
  layout_.clear();
}

// Two that hang on the same part do not touch each other either; when one of them is gone, the other's pairs are others.
void Simulator::Impl::partWelded() {
  for (AttachedModel& weld : world_.attachments) {
    for (const std::pair<int, int>& pair : weld.never_touch) world_.disabled_pairs.erase(pair);
    weld.never_touch.clear();
  }
  for (AttachedModel& weld : world_.attachments)
    for (const std::pair<int, int>& pair : pairsAmong(world_, rigidWith(world_.world, weld.body), weld.part))
      if (world_.disabled_pairs.insert(pair).second) weld.never_touch.push_back(pair);
}

void Simulator::Impl::carryAlong(int model) {
  for (const AttachedModel& weld : world_.attachments) {
    if (weld.part.model != model) continue;
    moveRigidly(weld.model, weld.body, carriedBy(world_.world, weld));
    carryAlong(weld.model);
  }
}

void Simulator::Impl::watchAttachments() {
  for (std::size_t i = world_.attachments.size(); i-- > 0;) {
    AttachedModel& weld = world_.attachments[i];
    weld.wrench = part_reports_.jointWrenches()[weld.joint];
    if (weld.wrench.force.norm() <= weld.max_force && weld.wrench.torque.norm() <= weld.max_torque) continue;
    report_.broken_attachments.push_back(weld.object);
    removeAttachment(i);
  }
}

}  // namespace blem_sim::sim
