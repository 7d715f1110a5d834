#include "soup/soup_faces.h"

#include <utility>

#include <fmt/format.h>

#include "blem_sim/geometry/collected.h"
#include "soup/polygon_split.h"

namespace blem_sim::model {

void SoupFaces::makeRoom(std::size_t more) { model::makeRoom(more, &elements_); }

void SoupFaces::append(const std::vector<int>& corners) {
  if (corners.size() > 3) {
    ++polygons_;
    // assimp's own triangulation splits some concave quadrilaterals along the outer diagonal.
    for (const Vector3i& triangle : splitPolygon(*vertices_, corners)) appendTriangle(triangle);
  } else if (corners.size() == 3) {
    appendTriangle(Vector3i(corners[0], corners[1], corners[2]));
  } else if (!corners.empty()) {
    elements_.emplace_back(corners.front(), corners.back(), corners.back());
  }
}

void SoupFaces::appendTriangle(const Vector3i& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    ++collapsed_;
  else
    elements_.push_back(t);
}

void SoupFaces::give(std::vector<SoupFaces>&& lists, SurfaceSoup* soup) {
  std::vector<std::vector<Vector3i>> elements;
  std::size_t polygons = 0;
  for (SoupFaces& list : lists) {
    elements.push_back(std::move(list.elements_));
    soup->collapsed += list.collapsed_;
    polygons += list.polygons_;
  }
  soup->mesh.elements = geometry::concatenated(std::move(elements));
  if (polygons > 0) soup->notes.push_back(fmt::format("{} polygons split into triangles", polygons));
}

}  // namespace blem_sim::model
