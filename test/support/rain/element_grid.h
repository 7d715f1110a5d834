// Elements of a mesh in square columns, seen from above: a search that shares nothing with the trees of the code under test.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/geometry/closest_points.h"

namespace blem_sim {

class ElementGrid {
 public:
  explicit ElementGrid(const geometry::TriangleMesh& mesh) : mesh_(mesh), bounds_(mesh.bounds()), columns_(COLUMNS * COLUMNS) {
    for (std::size_t i = 0; i < mesh.elements.size(); ++i)
      visitColumns(boxOf(i), [&](std::vector<int>* column) { column->push_back(static_cast<int>(i)); });
  }

  /** Calls visit(element) for each element whose box meets this one; for some more than once. */
  template <typename Visit>
  void visit(const Box& box, Visit&& visit) {
    if (!bounds_.intersects(box)) return;
    visitColumns(box, [&](std::vector<int>* column) {
      for (int i : *column)
        if (boxOf(i).intersects(box)) visit(i);
    });
  }

  geometry::Triangle triangle(int element) const { return geometry::triangleOf(mesh_, element); }

 private:
  static constexpr int COLUMNS = 256;  // a side

  Box boxOf(std::size_t element) const {
    Box box;
    for (const Vector3& corner : geometry::triangleOf(mesh_, element)) box.extend(corner);
    return box;
  }

  int columnOf(double x, int axis) const {
    const double size = std::max(bounds_.sizes()[axis], 1e-9);
    return static_cast<int>(std::clamp(std::floor(COLUMNS * (x - bounds_.min()[axis]) / size), 0.0, COLUMNS - 1.0));
  }

  template <typename Visit>
  void visitColumns(const Box& box, Visit&& visit) {
    for (int x = columnOf(box.min().x(), 0); x <= columnOf(box.max().x(), 0); ++x)
      for (int y = columnOf(box.min().y(), 1); y <= columnOf(box.max().y(), 1); ++y) visit(&columns_[COLUMNS * x + y]);
  }

  const geometry::TriangleMesh& mesh_;
  const Box bounds_;
  std::vector<std::vector<int>> columns_;
};

}  // namespace blem_sim
