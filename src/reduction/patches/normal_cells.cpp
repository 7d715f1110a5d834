#include "patches/normal_cells.h"

#include "blem_sim/geometry/roomy.h"

namespace blem_sim::reduction {

namespace {

constexpr double PER_UNIT = 16384;  // cells; contacts of one cell count as a flat patch
constexpr int OFFSET = 1 << 15;     // makes every number positive; one has 16 bits

// Axis-aligned normals lie in the middles of cells, so that theirs do not fall apart at a border.
std::uint64_t keyOf(const Vector3& normal) {
  const auto number = [](double part) { return static_cast<std::uint64_t>(static_cast<int>(part * PER_UNIT + (OFFSET + 0.5))); };
  return number(normal.x()) << 32 | number(normal.y()) << 16 | number(normal.z());
}

}  // namespace

int NormalCells::cellOf(std::uint64_t key) {
  for (std::size_t slot = key * 0x9E3779B97F4A7C15ull >> 54;; slot = (slot + 1) % SLOTS) {
    if (slots_[slot] >= 0 && cells_[slots_[slot]] == key) return slots_[slot];
    if (slots_[slot] >= 0) continue;
    if (count() == MOST) return -1;
    slots_[slot] = static_cast<std::int16_t>(count());
    cells_.push_back(key);
    return slots_[slot];
  }
}

bool NormalCells::group(const std::vector<contact::Contact>& contacts) {
  cells_.clear();
  ends_.clear();
  slots_.fill(-1);
  geometry::resizeRoomy(contacts.size(), &cell_of_);
  int last = -1;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const std::uint64_t key = keyOf(contacts[i].normal_BA);
    if (last < 0 || cells_[last] != key) last = cellOf(key);
    if (last < 0) {
      cells_.clear();
      return false;
    }
    cell_of_[i] = static_cast<std::int16_t>(last);
  }
  // Counting sort; ends_[c + 1] is the place of the next member of cell c.
  geometry::makeRoomFor(cells_.size() + 2, &ends_);
  ends_.assign(cells_.size() + 2, 0);
  for (const std::int16_t cell : cell_of_) ++ends_[cell + 2];
  for (std::size_t c = 2; c < ends_.size(); ++c) ends_[c] += ends_[c - 1];
  geometry::resizeRoomy(contacts.size(), &members_);
  for (std::size_t i = 0; i < contacts.size(); ++i) members_[ends_[cell_of_[i] + 1]++] = static_cast<int>(i);
  return true;
}

Vector3 NormalCells::normal(int cell) const {
  const auto part = [&](int shift) { return static_cast<double>(static_cast<int>(cells_[cell] >> shift & 0xFFFF) - OFFSET); };
  return Vector3(part(32), part(16), part(0)).normalized();
}

}  // namespace blem_sim::reduction
