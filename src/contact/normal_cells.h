// Contacts in groups of alike normals: cells of a grid over normals.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim {

/** Number of the cell that a normal lies in; axis-aligned normals lie in the middles of cells, so that theirs do not fall apart at a
 * border. @param cell its size, at least 2^-15 */
inline std::uint64_t normalCell(const Vector3& normal, double cell) {
  constexpr int OFFSET = 1 << 15;  // makes every number positive; one has 16 bits
  const auto number = [cell](double part) { return static_cast<std::uint64_t>(part / cell + OFFSET + 0.5); };
  return number(normal.x()) << 32 | number(normal.y()) << 16 | number(normal.z());
}

/** Unit normal in the middle of a cell. */
inline Vector3 cellNormal(std::uint64_t cell) {
  const auto part = [cell](int shift) { return static_cast<double>(static_cast<int>(cell >> shift & 0xFFFF) - (1 << 15)); };
  return Vector3(part(32), part(16), part(0)).normalized();
}

/** Calls visit(members, normal) for every cell, in order; members ascending, the visitor may reorder them. */
template <typename Visit>
void forEachNormalCell(const std::vector<Contact>& contacts, double cell, Visit&& visit) {
  struct Key {
    std::uint64_t cell;
    int contact;
    bool operator<(const Key& other) const { return cell != other.cell ? cell < other.cell : contact < other.contact; }
  };
  std::vector<Key> keys(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) keys[i] = {normalCell(contacts[i].normal_BA, cell), static_cast<int>(i)};
  if (!std::is_sorted(keys.begin(), keys.end())) std::sort(keys.begin(), keys.end());
  std::vector<int> members;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    members.push_back(keys[i].contact);
    if (i + 1 < keys.size() && keys[i].cell == keys[i + 1].cell) continue;
    visit(members, cellNormal(keys[i].cell));
    members.clear();
  }
}

}  // namespace blem_sim
