#include "scene/world_state.h"

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
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

void StateReader::refuse() {
  throw InputError("world state: it was not saved from a world with these bodies and joints; load it into the scene it came from");
}

double StateReader::number() {
  if (next_number_ >= state_.numbers.size()) refuse();
  return state_.numbers[next_number_++];
}

void StateReader::numbers(double* x, std::size_t count) {
  if (state_.numbers.size() - next_number_ < count) refuse();
  std::copy_n(state_.numbers.begin() + next_number_, count, x);
  next_number_ += count;
}

Vector3 StateReader::vector() {
  Vector3 v;
  numbers(v.data(), 3);
  return v;
}

std::uint64_t StateReader::word() {
  if (next_word_ >= state_.words.size()) refuse();
  return state_.words[next_word_++];
}

std::size_t StateReader::count(std::size_t words_each, std::size_t numbers_each) {
  const std::uint64_t items = word();
  if (words_each > 0 && items > (state_.words.size() - next_word_) / words_each) refuse();
  if (numbers_each > 0 && items > (state_.numbers.size() - next_number_) / numbers_each) refuse();
  return static_cast<std::size_t>(items);
}

void StateReader::finish() const {
  if (next_number_ != state_.numbers.size() || next_word_ != state_.words.size()) refuse();
}

void saveScene(const Scene& scene, StateWriter* writer) {
  writer->word(liveBodies(scene));
  writer->word(liveJoints(scene));
  writer->vector(scene.gravity());
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const BodySlot& slot = scene.bodies()[b];
    if (!slot.ode) continue;
    writer->numbers(scene.bits(static_cast<int>(b)).numbers, BodyBits::SIZE);
    writer->vector(slot.pending.force);
    writer->vector(slot.pending.torque);
  }
  for (const JointSlot& slot : scene.joints()) {
    if (!slot.joint) continue;
    writer->number(slot.last_position);
    writer->number(slot.last_effort);
  }
}

void restoreScene(Scene* scene, StateReader* reader) {
  if (reader->word() != liveBodies(*scene)) StateReader::refuse();
  if (reader->word() != liveJoints(*scene)) StateReader::refuse();
  scene->setGravity(reader->vector());
  for (std::size_t b = 0; b < scene->bodies().size(); ++b) {
    BodySlot& slot = scene->bodies()[b];
    if (!slot.ode) continue;
    BodyBits bits;
    reader->numbers(bits.numbers, BodyBits::SIZE);
    scene->setBits(static_cast<int>(b), bits);
    slot.pending.force = reader->vector();
    slot.pending.torque = reader->vector();
  }
  for (JointSlot& slot : scene->joints()) {
    if (!slot.joint) continue;
    slot.last_position = reader->number();
    slot.last_effort = reader->number();
  }
}

void saveMemory(const ContactMemory& memory, StateWriter* writer) {
  writer->word(memory.memos().size());
  for (const ContactMemo& memo : memory.memos()) {
    writer->word(memo.id);
    writer->vector(memo.friction);
    writer->number(memo.approach);
  }
}

void restoreMemory(ContactMemory* memory, StateReader* reader) {
  std::vector<ContactMemo> memos(reader->count(1, 4));
  for (ContactMemo& memo : memos) {
    memo.id = reader->word();
    memo.friction = reader->vector();
    memo.approach = reader->number();
  }
  memory->replace(std::move(memos));
}

}  // namespace blem_sim::dynamics
