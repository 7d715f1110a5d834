#include "merge_contacts.h"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "id_order.h"

namespace blem_sim {
namespace {

/** Of one id the one to keep comes first; total. */
bool keptBefore(const Contact& a, const Contact& b) {
  const auto key = [](const Contact& c) { return std::make_tuple(!c.pierced, -c.depth, c.point.x(), c.point.y(), c.point.z()); };
  return key(a) < key(b);
}

/** @param place of a, instead of its own */
bool coincide(const Contact& a, const Vector3& place, const Contact& b) {
  return a.pierced == b.pierced && (place - b.point).squaredNorm() <= MERGE_DISTANCE * MERGE_DISTANCE &&
         (a.normal_BA - b.normal_BA).squaredNorm() <= MERGE_SINE * MERGE_SINE;
}

/** The places of contacts, by the cell of space that they lie in. */
class Cells {
 public:
  /** Empties them, with room for so many. */
  void clear(std::size_t contacts) {
    std::size_t size = 16;
    while (size < 2 * contacts) size *= 2;
    heads_.assign(size, NONE);
    entries_.clear();
  }

  /**
   * Calls visit(index, place) for every place within MERGE_DISTANCE of the point, and others, until it returns true; adds the point if it
   * never does. @return whether it did
   */
  template <typename Visit>
  bool visitNearOrAdd(const Vector3& point, Visit&& visit) {
    const Vector3 place = point * (1 / SIZE);
    const Cell own = cell(place);
    const std::size_t own_slot = slot(own);
    if (visitAll(own_slot, visit)) return true;
    if (!isInside(place, own) && visitNeighbours(place, own, visit)) return true;
    entries_.push_back({point, heads_[own_slot]});
    heads_[own_slot] = static_cast<std::uint32_t>(entries_.size()) - 1;
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    Vector3 place;
    std::uint32_t next;
  };
  static constexpr std::uint32_t NONE = 0xFFFFFFFF;
  static constexpr double SIZE = 64 * MERGE_DISTANCE;             // few points are that near a border
  static constexpr double REACH = 1.001 * MERGE_DISTANCE / SIZE;  // in cells, with room for rounding

  /** @param place in cells */
  static Cell cell(const Vector3& place) {
    // std::floor is a call where the instruction set has none.
    const auto floor = [](double value) {
      const auto towards_zero = static_cast<std::int64_t>(value);
      return towards_zero - (value < static_cast<double>(towards_zero));
    };
    return {floor(place.x()), floor(place.y()), floor(place.z())};
  }
  /** Is all within reach in the same cell? */
  static bool isInside(const Vector3& place, const Cell& cell) {
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const double part = place[k] - static_cast<double>(cell[k]);
      inside &= (part > REACH) & (part < 1 - REACH);
    }
    return inside;
  }
  std::size_t slot(const Cell& cell) const {
    const std::uint64_t mixed = static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15u +
                                static_cast<std::uint64_t>(cell[1]) * 0xC2B2AE3D27D4EB4Fu +
                                static_cast<std::uint64_t>(cell[2]) * 0x165667B19E3779F9u;
    return (mixed ^ mixed >> 32) & (heads_.size() - 1);
  }

  template <typename Visit>
  bool visitAll(std::size_t slot, Visit&& visit) const {
    for (std::uint32_t i = heads_[slot]; i != NONE; i = entries_[i].next)
      if (visit(i, entries_[i].place)) return true;
    return false;
  }

  template <typename Visit>
  bool visitNeighbours(const Vector3& place, const Cell& own, Visit&& visit) const {
    const Vector3 reach = Vector3::Constant(REACH);
    const Cell low = cell(place - reach), high = cell(place + reach);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const Cell each = {x, y, z};
          if (each != own && visitAll(slot(each), visit)) return true;
        }
      }
    }
    return false;
  }

  std::vector<std::uint32_t> heads_;
  std::vector<Entry> entries_;
};

// Kept between calls.
struct Buffers {
  IdOrder by_id;
  std::vector<std::uint32_t> best;
  Cells cells;  // places of the contacts that each of the merged ones began with
};

/** Of every id the best, sorted by id: buffers->best. */
void findBestOfEachId(const Contact* contacts, std::size_t count, Buffers* buffers) {
  std::vector<std::uint32_t>& best = buffers->best;
  best.resize(count);
  std::size_t left = 0;
  std::uint64_t last = 0;
  for (const std::uint32_t i : buffers->by_id.of(contacts, count)) {
    const std::uint64_t id = contacts[i].id;
    if (left == 0 || id != last) {
      best[left++] = i;
      last = id;
    } else if (keptBefore(contacts[i], contacts[best[left - 1]])) {
      best[left - 1] = i;
    }
  }
  best.resize(left);
}

}  // namespace

std::size_t mergeContacts(const Contact* contacts, std::size_t count, Contact* merged) {
  if (count == 0) return 0;
  thread_local Buffers buffers;
  findBestOfEachId(contacts, count, &buffers);
  buffers.cells.clear(buffers.best.size());
  std::size_t left = 0;
  for (const std::uint32_t index : buffers.best) {
    const Contact& contact = contacts[index];
    const bool is_merged = buffers.cells.visitNearOrAdd(contact.point, [&](std::uint32_t i, const Vector3& place) {
      Contact& other = merged[i];
      if (!coincide(other, place, contact)) return false;
      if (contact.depth > other.depth) {
        const std::uint64_t id = other.id;
        other = contact;
        other.id = id;
      }
      return true;
    });
    if (!is_merged) merged[left++] = contact;
  }
  return left;
}

}  // namespace blem_sim
