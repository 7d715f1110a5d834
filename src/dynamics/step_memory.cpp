#include "step_memory.h"

#include <algorithm>

namespace blem_sim {

const ContactRecord* StepMemory::find(std::uint64_t id) const {
  const auto it = std::lower_bound(contacts.begin(), contacts.end(), id, [](const ContactRecord& c, std::uint64_t i) { return c.id < i; });
  return it != contacts.end() && it->id == id ? &*it : nullptr;
}

void StepMemory::save(StateWriter* writer) const {
  writer->word(contacts.size());
  for (const ContactRecord& c : contacts) {
    writer->word(c.id);
    writer->vector(c.force);
    writer->number(c.slip);
    writer->number(c.approach);
  }
  writer->word(joints.size());
  for (const JointRecord& j : joints)
    for (const double x : {j.dry, j.lower, j.upper}) writer->number(x);
  writer->word(loops.size());
  for (const LoopRecord& l : loops) writer->numbers(l.force.data(), 6);
}

void StepMemory::restore(StateReader* reader) {
  contacts.resize(reader->word());
  for (ContactRecord& c : contacts) {
    c.id = reader->word();
    c.force = reader->vector();
    c.slip = reader->number();
    c.approach = reader->number();
  }
  joints.resize(reader->word());
  for (JointRecord& j : joints)
    for (double* x : {&j.dry, &j.lower, &j.upper}) *x = reader->number();
  loops.resize(reader->word());
  for (LoopRecord& l : loops) reader->numbers(l.force.data(), 6);
}

}  // namespace blem_sim
