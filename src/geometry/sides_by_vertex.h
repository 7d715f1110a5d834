// The sides of a mesh's elements, those of one edge beside each other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** A side of an element, from one corner to the next one; sorts by its higher vertex, then by element and corner. */
class Side {
 public:
  Side() = default;  // not set: there are millions
  Side(int higher, std::uint32_t index) : bits_(static_cast<std::uint64_t>(higher) << 32 | index) {}

  int higher() const { return static_cast<int>(bits_ >> 32); }  ///< vertex
  int element() const { return static_cast<int>(static_cast<std::uint32_t>(bits_) / 3); }
  int corner() const { return static_cast<int>(static_cast<std::uint32_t>(bits_) % 3); }
  bool operator<(const Side& other) const { return bits_ < other.bits_; }

 private:
  std::uint64_t bits_;
};

/** All sides with a length, grouped by their lower vertex and sorted. Precondition: indices in range. */
struct SidesByVertex {
  explicit SidesByVertex(const TriangleMesh& mesh);

  std::vector<int> begin;  ///< size vertices + 1: sides of vertex i are sides[begin[i] .. [i + 1])
  std::unique_ptr<Side[]> sides;
};

/** Calls visit(first, last) for each edge with the range of its sides. */
template <typename Visit>
void visitEdges(const SidesByVertex& by_vertex, int lower_vertex, Visit&& visit) {
  const Side* first = by_vertex.sides.get() + by_vertex.begin[lower_vertex];
  const Side* const end = by_vertex.sides.get() + by_vertex.begin[lower_vertex + 1];
  while (first != end) {
    const Side* last = first + 1;
    while (last != end && last->higher() == first->higher()) ++last;
    visit(first, last);
    first = last;
  }
}

}  // namespace blem_sim::geometry
