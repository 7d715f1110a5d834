#include "soup/soup_faces.h"

#include <fmt/format.h>

#include "soup/polygon_split.h"

namespace blem_sim::model {

void SoupFaces::append(const std::vector<int>& corners) {
  if (corners.size() > 3) {
    ++polygons_;
    // assimp's own triangulation splits some concave quadrilaterals along the outer diagonal.
    for (const Vector3i& triangle : splitPolygon(soup_.mesh.vertices, corners)) appendTriangle(triangle);
  } else if (corners.size() == 3) {
    appendTriangle(Vector3i(corners[0], corners[1], corners[2]));
  } else if (!corners.empty()) {
    soup_.mesh.elements.emplace_back(corners.front(), corners.back(), corners.back());
  }
}

void SoupFaces::appendTriangle(const Vector3i& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    ++soup_.collapsed;
  else
    soup_.mesh.elements.push_back(t);
}

void SoupFaces::tell() const {
  if (polygons_ > 0) soup_.notes.push_back(fmt::format("{} polygons split into triangles", polygons_));
}

}  // namespace blem_sim::model
