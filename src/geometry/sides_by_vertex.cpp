#include "sides_by_vertex.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace blem_sim {
namespace {

/** Calls visit(lower vertex, side). */
template <typename Visit>
void visitSides(const TriangleMesh& mesh, Visit&& visit) {
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const Vector3i& e = mesh.elements[i];
    for (int k = 0; k < 3; ++k) {
      const int from = e[k], to = e[k == 2 ? 0 : k + 1];
      if (from != to) visit(std::min(from, to), Side(std::max(from, to), static_cast<std::uint32_t>(3 * i + k)));
    }
  }
}

}  // namespace

void accumulate(std::vector<int>* counts) {
  for (std::size_t i = 1; i < counts->size(); ++i) (*counts)[i] += (*counts)[i - 1];
}

SidesByVertex::SidesByVertex(const TriangleMesh& mesh) : begin(mesh.vertices.size() + 1, 0) {
  visitSides(mesh, [this](int vertex, Side) { ++begin[vertex + 1]; });
  accumulate(&begin);
  sides.resize(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  visitSides(mesh, [this, &next](int vertex, Side side) { sides[next[vertex]++] = side; });
  tbb::parallel_for(std::size_t{0}, mesh.vertices.size(),
                    [this](std::size_t v) { std::sort(sides.begin() + begin[v], sides.begin() + begin[v + 1]); });
}

}  // namespace blem_sim
