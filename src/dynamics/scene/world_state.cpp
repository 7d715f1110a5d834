// Saving and restoring of scenes and of memories of contacts.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "scene/contact_law.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {
namespace {

std::uint64_t liveBodies(const Scene& scene) {
  return std::count_if(scene.bodies().begin(), scene.bodies().end(), [](const BodySlot& b) { return b.ode != nullptr; });
}

std::uint64_t liveJoints(const Scene& scene) {
  return std::count_if(scene.joints().begin(), scene.joints().end(), [](const JointSlot& j) { return j.joint != nullptr; });
}

}  // namespace

void Scene::save(geometry::StateWriter* writer) const {
  writer->word(liveBodies(*this));
  writer->word(liveJoints(*this));
  writer->vector(gravity());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BodySlot& slot = bodies_[b];
    if (!slot.ode) continue;
    writer->numbers(bits(static_cast<int>(b)).numbers, BodyBits::SIZE);
    writer->vector(slot.pending.force);
    writer->vector(slot.pending.torque);
  }
  for (const JointSlot& slot : joints_) {
    if (!slot.joint) continue;
    writer->number(slot.last_position);
    writer->number(slot.last_effort);
  }
}

void Scene::restore(geometry::StateReader* reader) {
  if (reader->word() != liveBodies(*this)) reader->refuse();
  if (reader->word() != liveJoints(*this)) reader->refuse();
  setGravity(reader->vector());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    BodySlot& slot = bodies_[b];
    if (!slot.ode) continue;
    BodyBits bits;
    reader->numbers(bits.numbers, BodyBits::SIZE);
    setBits(static_cast<int>(b), bits);
    slot.pending.force = reader->vector();
    slot.pending.torque = reader->vector();
  }
  for (JointSlot& slot : joints_) {
    if (!slot.joint) continue;
    slot.last_position = reader->number();
    slot.last_effort = reader->number();
  }
}

void ContactMemory::save(geometry::StateWriter* writer) const {
  writer->word(memos_.size());
  for (const ContactMemo& memo : memos_) {
    writer->word(memo.id);
    writer->vector(memo.friction);
    writer->number(memo.approach);
  }
}

void ContactMemory::restore(geometry::StateReader* reader) {
  std::vector<ContactMemo> memos(reader->count(1, 4));
  for (ContactMemo& memo : memos) {
    memo.id = reader->word();
    memo.friction = reader->vector();
    memo.approach = reader->number();
  }
  replace(std::move(memos));
}

}  // namespace blem_sim::dynamics
