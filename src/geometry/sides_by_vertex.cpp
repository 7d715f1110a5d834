#include "sides_by_vertex.h"

#include <algorithm>

#include "blem_sim/geometry/for_all.h"
#include "threads/grouped.h"

namespace blem_sim::geometry {

SidesByVertex::SidesByVertex(const TriangleMesh& mesh) {
  const auto visitSides = [&mesh](int i, auto&& visit) {
    const Vector3i& e = mesh.elements[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) {
      const int from = e[k], to = e[k == 2 ? 0 : k + 1];
      if (from != to) visit(std::min(from, to), Side(std::max(from, to), static_cast<std::uint32_t>(3 * i + k)));
    }
  };
  const int vertices = static_cast<int>(mesh.vertices.size());
  begin = grouped(static_cast<int>(mesh.elements.size()), vertices, visitSides, [this](std::size_t count) {
    sides.reset(new Side[count]);
    return sides.get();
  });
  forAll(vertices, [this](int v) { std::sort(sides.get() + begin[v], sides.get() + begin[v + 1]); });
}

}  // namespace blem_sim::geometry
