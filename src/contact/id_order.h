// Contacts by their ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim {

/** Sorts contacts by id; room that is kept between calls. */
class IdOrder {
 public:
  /** Their indices by id, those of one id ascending. Good until the next call. */
  const std::vector<std::uint32_t>& of(const Contact* contacts, std::size_t count);

 private:
  bool pack(const Contact* contacts, std::size_t count);
  void sortKeys();

  // Ids with as few bits as tell them apart, each with its contact's index below.
  std::vector<std::uint64_t> keys_, room_;
  int key_bits_ = 0, index_bits_ = 0;
  std::vector<std::uint32_t> order_;
};

}  // namespace blem_sim
