// Faces of a file as elements of a soup.
#pragma once

#include <vector>

#include "soup/surface_soup.h"

namespace blem_sim::model {

/** A list of faces: triangles, polygons as triangles, lines, points. */
class SoupFaces {
 public:
  /** @param vertices that the faces name; they may grow, and must outlive this */
  explicit SoupFaces(const std::vector<Vector3>* vertices) : vertices_(vertices) {}

  /** Memory for `more` triangles. */
  void makeRoom(std::size_t more);
  /** @param corners indices of vertices, any number; in range */
  void append(const std::vector<int>& corners);
  /** Makes the faces of some lists, one list behind the other, those of a soup, and notes what became of them. */
  static void give(std::vector<SoupFaces>&& lists, SurfaceSoup* soup);

 private:
  void appendTriangle(const Vector3i& t);

  const std::vector<Vector3>* vertices_;
  std::vector<Vector3i> elements_;
  int collapsed_ = 0;
  std::size_t polygons_ = 0;
};

}  // namespace blem_sim::model
