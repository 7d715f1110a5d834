// Extremes, never averages: an average of contacts lies inside their support polygon and shrinks it.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "blem_sim/contact/reduction.h"
#include "contact_order.h"
#include "patch_hull.h"
#include "wrench_choice.h"

namespace blem_sim {

namespace {

constexpr double EQUAL_NORMALS = 1.0 / 16384;  // cell of the grid over normals in which a patch counts as flat
constexpr double ALIKE_NORMALS = 1.0 / 32;     // coarser cell for crowds of contacts on noise: about 2 degrees
constexpr double STAIR = 1e-3;                 // [m] parallel patches with this much air between their heights are two patches
constexpr int CELL_OFFSET = 1 << 15;           // makes every cell's number positive; a number has 16 bits
constexpr std::size_t CROWD = 400;             // more than this many contacts are thinned before the choice, to save time

// Cell of the grid over normals that a contact falls into.
struct CellKey {
  std::uint64_t cell;
  int contact;
};

bool keyBefore(const CellKey& a, const CellKey& b) { return a.cell != b.cell ? a.cell < b.cell : a.contact < b.contact; }

// Rounding puts axis-aligned normals into the middles of cells, so that theirs do not fall apart at a border.
std::uint64_t cellNumber(double scaled) { return static_cast<std::uint64_t>(scaled + CELL_OFFSET + 0.5); }

std::uint64_t cellOf(const Vector3& normal, double cell) {
  return cellNumber(normal.x() / cell) << 32 | cellNumber(normal.y() / cell) << 16 | cellNumber(normal.z() / cell);
}

Vector3 cellNormal(std::uint64_t cell) {
  const auto part = [&](int shift) { return static_cast<double>(static_cast<int>(cell >> shift & 0xFFFF) - CELL_OFFSET); };
  return Vector3(part(32), part(16), part(0)).normalized();
}

std::vector<CellKey> sortedByCell(const std::vector<Contact>& contacts, double cell) {
  std::vector<CellKey> keys(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) keys[i] = {cellOf(contacts[i].normal_BA, cell), static_cast<int>(i)};
  if (!std::is_sorted(keys.begin(), keys.end(), keyBefore)) std::sort(keys.begin(), keys.end(), keyBefore);
  return keys;
}

// Adds the hull of every patch among contacts of one cell to `kept`. Reorders the members.
void keepHullsOfCell(const std::vector<Contact>& contacts, std::vector<int>& members, const Vector3& normal, std::vector<int>& kept) {
  const auto height = [&](int i) { return normal.dot(contacts[i].point); };
  double lowest = height(members[0]), highest = lowest;
  for (int i : members) {
    lowest = std::min(lowest, height(i));
    highest = std::max(highest, height(i));
  }
  if (highest - lowest > STAIR) {
    std::sort(members.begin(), members.end(), [&](int a, int b) { return height(a) != height(b) ? height(a) < height(b) : a < b; });
  }
  std::vector<int> patch;
  for (std::size_t i = 0; i < members.size(); ++i) {
    patch.push_back(members[i]);
    if (i + 1 < members.size() && std::abs(height(members[i + 1]) - height(members[i])) <= STAIR) continue;
    if (patch.size() > 1) patch = patchHull(contacts, patch, normal);
    kept.insert(kept.end(), patch.begin(), patch.end());
    patch.clear();
  }
}

// Replaces the contacts of every patch by its hull.
void keepPatchHulls(std::vector<Contact>& contacts, double cell) {
  const std::vector<CellKey> keys = sortedByCell(contacts, cell);
  std::vector<int> kept, members;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    members.push_back(keys[i].contact);
    if (i + 1 < keys.size() && keys[i].cell == keys[i + 1].cell) continue;
    if (members.size() > 1) {
      keepHullsOfCell(contacts, members, cellNormal(keys[i].cell), kept);
    } else {
      kept.push_back(members[0]);
    }
    members.clear();
  }
  if (kept.size() == contacts.size()) return;
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i < kept.size(); ++i) contacts[i] = contacts[kept[i]];
  contacts.resize(kept.size());
}

}  // namespace

void reduceHull(std::vector<Contact>& contacts, int k) {
  makeCanonical(contacts);
  keepPatchHulls(contacts, EQUAL_NORMALS);
  if (static_cast<int>(contacts.size()) <= k) return;
  if (contacts.size() > CROWD) keepPatchHulls(contacts, ALIKE_NORMALS);
  if (static_cast<int>(contacts.size()) <= k) return;
  const std::vector<int> chosen = chooseSpanningContacts(contacts, k);
  for (std::size_t i = 0; i < chosen.size(); ++i) contacts[i] = contacts[chosen[i]];
  contacts.resize(chosen.size());
}

}  // namespace blem_sim
