// Contacts in groups of equal normals: cells of a grid over normals.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim::reduction {

/** Contacts by the cell of a fine grid over normals that theirs lies in. Keeps its memory. */
class NormalCells {
 public:
  static constexpr int MOST = 400;  ///< cells

  /** @return false if there are more than MOST cells; none is formed then. The outcome does not depend on the order of the contacts. */
  bool group(const std::vector<contact::Contact>& contacts);

  int count() const { return static_cast<int>(cells_.size()); }
  /** Unit normal in the middle of a cell. */
  Vector3 normal(int cell) const;
  /** Indices of the cell's contacts, which may be reordered. */
  int* begin(int cell) { return members_.data() + ends_[cell]; }
  int* end(int cell) { return members_.data() + ends_[cell + 1]; }

 private:
  static constexpr std::size_t SLOTS = 1024;
  /** Cell of a key, a new one if it has none; -1 if there is no room for another. */
  int cellOf(std::uint64_t key);

  std::array<std::int16_t, SLOTS> slots_;
  std::vector<std::uint64_t> cells_;
  std::vector<std::int16_t> cell_of_;
  std::vector<int> ends_, members_;
};

}  // namespace blem_sim::reduction
