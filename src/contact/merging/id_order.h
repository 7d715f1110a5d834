// Contacts by their ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim::contact {

/** Sorts contacts by id; room that is kept between calls. */
class IdOrder {
 public:
  struct Entry {
    std::uint64_t id;
    std::uint32_t index;  ///< of the contact
  };

  /** The contacts by id, those of one id by index. Good until the next call. */
  const std::vector<Entry>& of(const Contact* contacts, std::size_t count);

 private:
  void sortByFirstFeature(std::uint64_t different);
  bool insertAll();

  std::vector<Entry> entries_, room_;
};

}  // namespace blem_sim::contact
