// Records of contacts from step to step, sorted by id.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::dynamics {

/**
 * Takes out the records with these ids; one that is turned over tells the same of A and B exchanged (turnOver).
 * @param ids ascending @param go_on as World::forgetContacts has it
 */
template <typename Record>
void forgetRecords(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on, std::vector<Record>* records) {
  const auto precedes = [](const Record& a, const Record& b) { return a.id < b.id; };
  const auto is_same = [](const Record& a, const Record& b) { return a.id == b.id; };
  std::vector<Record> renamed;
  for (const ContactRename& rename : go_on) {
    Record record;
    record.id = rename.from;
    const auto at = std::lower_bound(records->begin(), records->end(), record, precedes);
    if (at == records->end() || at->id != rename.from) continue;
    renamed.push_back(*at);
    renamed.back().id = rename.to;
    if (rename.turned) turnOver(&renamed.back());
  }
  const auto is_gone = [&](const Record& record) { return std::binary_search(ids.begin(), ids.end(), record.id); };
  records->erase(std::remove_if(records->begin(), records->end(), is_gone), records->end());
  records->insert(records->end(), renamed.begin(), renamed.end());
  std::stable_sort(records->begin(), records->end(), precedes);
  records->erase(std::unique(records->begin(), records->end(), is_same), records->end());
}

}  // namespace blem_sim::dynamics
