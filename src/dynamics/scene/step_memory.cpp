#include "scene/step_memory.h"

#include <algorithm>

#include "scene/contact_records.h"

namespace blem_sim::dynamics {

const ContactRecord* StepMemory::find(std::uint64_t id) const {
  if (contacts.empty()) return nullptr;
  const std::size_t bucket = id >> shift_;
  const auto first = contacts.begin() + first_[bucket], end = contacts.begin() + first_[bucket + 1];
  if (first != end && first->id == id) return &*first;
  const auto it = std::lower_bound(first, end, id, [](const ContactRecord& c, std::uint64_t i) { return c.id < i; });
  return it != end && it->id == id ? &*it : nullptr;
}

// Ids of the simulator's contacts are spread evenly, so that a bucket holds one or none.
void StepMemory::index() {
  std::size_t buckets = 2;
  for (shift_ = 63; buckets < 2 * contacts.size(); buckets *= 2) --shift_;
  first_.assign(buckets + 1, 0);
  for (const ContactRecord& c : contacts) ++first_[(c.id >> shift_) + 1];
  for (std::size_t b = 0; b < buckets; ++b) first_[b + 1] += first_[b];
}

bool StepMemory::knows(const Scene& scene, std::size_t joint) const {
  return joint < joints.size() && occupants_[joint] == scene.joints()[joint].occupant;
}

void StepMemory::resize(const Scene& scene) {
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (!knows(scene, j)) joints[j] = JointRecord();
  joints.resize(scene.joints().size());
  occupants_.clear();
  for (const JointSlot& slot : scene.joints()) occupants_.push_back(slot.occupant);
}

void StepMemory::forgetContacts(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on) {
  forgetRecords(ids, go_on, &contacts);
  index();
}

void StepMemory::save(const Scene& scene, geometry::StateWriter* writer) const {
  writer->word(contacts.size());
  for (const ContactRecord& c : contacts) {
    writer->word(c.id);
    writer->vector(c.force);
    writer->number(c.slip);
  }
  // A joint that was added since the last step has nothing to remember.
  for (std::size_t j = 0; j < scene.joints().size(); ++j) {
    if (!scene.joints()[j].joint) continue;
    const JointRecord record = knows(scene, j) ? joints[j] : JointRecord();
    for (const double x : {record.dry, record.lower, record.upper, record.dry_change}) writer->number(x);
    if (!scene.joints()[j].in_tree) writer->numbers(record.loop.data(), 6);
  }
}

void StepMemory::restore(const Scene& scene, geometry::StateReader* reader) {
  contacts.resize(reader->count(1, 4));
  for (ContactRecord& c : contacts) {
    c.id = reader->word();
    c.force = reader->vector();
    c.slip = reader->number();
  }
  const auto follows = [](const ContactRecord& a, const ContactRecord& b) { return b.id < a.id; };
  if (std::adjacent_find(contacts.begin(), contacts.end(), follows) != contacts.end()) reader->refuse();
  index();
  resize(scene);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!scene.joints()[j].joint) continue;
    for (double* x : {&joints[j].dry, &joints[j].lower, &joints[j].upper, &joints[j].dry_change}) *x = reader->number();
    if (!scene.joints()[j].in_tree) reader->numbers(joints[j].loop.data(), 6);
  }
}

}  // namespace blem_sim::dynamics
