#include "merge_contacts.h"

#include <algorithm>
#include <array>
#include <tuple>

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

/** Contacts by the cell of space that they lie in. */
class Cells {
 public:
  /** Empties them, with room for so many. */
  void clear(std::size_t contacts) {
    std::size_t size = 16;
    while (size < 2 * contacts) size *= 2;
    heads_.assign(size, NONE);
    next_.clear();
  }

  void add(const Vector3& point) {
    std::uint32_t& head = heads_[slot(cell(point / SIZE))];
    next_.push_back(head);
    head = static_cast<std::uint32_t>(next_.size()) - 1;
  }

  /** Calls visit(index) for every contact within MERGE_DISTANCE of the point, and others, until it returns true. */
  template <typename Visit>
  void visitNear(const Vector3& point, Visit&& visit) const {
    const Vector3 place = point / SIZE, reach = Vector3::Constant(MERGE_DISTANCE / SIZE);
    const Cell low = cell(place - reach), high = cell(place + reach);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          for (std::uint32_t i = heads_[slot({x, y, z})]; i != NONE; i = next_[i])
            if (visit(i)) return;
        }
      }
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t NONE = 0xFFFFFFFF;
  static constexpr double SIZE = 64 * MERGE_DISTANCE;  // few points are that near a border

  /** @param place in cells */
  static Cell cell(const Vector3& place) {
    // std::floor is a call where the instruction set has none.
    const auto floor = [](double value) {
      const auto towards_zero = static_cast<std::int64_t>(value);
      return towards_zero - (value < static_cast<double>(towards_zero));
    };
    return {floor(place.x()), floor(place.y()), floor(place.z())};
  }
  std::size_t slot(const Cell& cell) const {
    const std::uint64_t mixed = static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15u +
                                static_cast<std::uint64_t>(cell[1]) * 0xC2B2AE3D27D4EB4Fu +
                                static_cast<std::uint64_t>(cell[2]) * 0x165667B19E3779F9u;
    return (mixed ^ mixed >> 32) & (heads_.size() - 1);
  }

  std::vector<std::uint32_t> heads_, next_;
};

// Kept between calls.
struct Buffers {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  std::vector<std::uint32_t> best;
  std::vector<Contact> merged;
  Cells cells;
  std::vector<Vector3> firsts;  // places of the contacts that each of the merged ones began with
};

/** Of every id the best, sorted by id: buffers->best. */
void findBestOfEachId(const std::vector<Contact>& contacts, Buffers* buffers) {
  auto& order = buffers->order;
  order.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) order.emplace_back(contacts[i].id, i);
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t>& best = buffers->best;
  best.clear();
  for (const auto& [id, i] : order) {
    if (best.empty() || contacts[best.back()].id != id) {
      best.push_back(i);
    } else if (keptBefore(contacts[i], contacts[best.back()])) {
      best.back() = i;
    }
  }
}

}  // namespace

void mergeContacts(std::vector<Contact>* contacts) {
  thread_local Buffers thread_buffers;
  Buffers& buffers = thread_buffers;
  findBestOfEachId(*contacts, &buffers);
  std::vector<Contact>& merged = buffers.merged;
  merged.clear();
  buffers.firsts.clear();
  buffers.cells.clear(buffers.best.size());
  for (const std::uint32_t index : buffers.best) {
    const Contact& contact = (*contacts)[index];
    bool is_merged = false;
    buffers.cells.visitNear(contact.point, [&](std::uint32_t i) {
      Contact& other = merged[i];
      if (!coincide(other, buffers.firsts[i], contact)) return false;
      if (contact.depth > other.depth) {
        const std::uint64_t id = other.id;
        other = contact;
        other.id = id;
      }
      return is_merged = true;
    });
    if (is_merged) continue;
    buffers.cells.add(contact.point);
    buffers.firsts.push_back(contact.point);
    merged.push_back(contact);
  }
  contacts->assign(merged.begin(), merged.end());
}

}  // namespace blem_sim
