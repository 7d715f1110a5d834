// Faces of a file as elements of a soup.
#pragma once

#include <vector>

#include "soup/surface_soup.h"

namespace blem_sim::model {

/** Appends faces to a soup, whose vertices they name: triangles, polygons as triangles, lines, points. */
class SoupFaces {
 public:
  explicit SoupFaces(SurfaceSoup* soup) : soup_(*soup) {}

  /** @param corners indices of vertices, any number; in range */
  void append(const std::vector<int>& corners);
  /** Notes what became of the faces. */
  void tell() const;

 private:
  void appendTriangle(const Vector3i& t);

  SurfaceSoup& soup_;
  std::size_t polygons_ = 0;
};

}  // namespace blem_sim::model
