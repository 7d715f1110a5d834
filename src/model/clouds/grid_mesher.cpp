#include <algorithm>

#include "clouds/cloud_meshers.h"

namespace blem_sim::model {
namespace {

class GridMesher {
 public:
  GridMesher(const PixelGrid& grid, const Vector3& viewpoint, const CloudOptions& options) : grid_(grid), options_(options) {
    ranges_.reserve(grid.points.size());
    for (const Vector3& p : grid.points) ranges_.push_back((p - viewpoint).norm());
  }

  std::vector<Vector3i> triangles() {
    for (int row = 0; row + 1 < grid_.height; ++row)
      for (int column = 0; column + 1 < grid_.width; ++column) addCell(row * grid_.width + column);
    return std::move(triangles_);
  }

 private:
  double edge(int a, int b) const { return (grid_.points[a] - grid_.points[b]).norm(); }
  // NaN compares false: nothing joins a point that was not measured, and an infinite jump is none at the viewpoint itself.
  bool joins(int a, int b) const {
    const auto [near, far] = std::minmax(ranges_[a], ranges_[b]);
    return edge(a, b) <= options_.max_edge && !(far - near > options_.max_depth_jump * near);
  }
  bool add(int a, int b, int c) {
    if (!(joins(a, b) && joins(b, c) && joins(c, a))) return false;
    triangles_.emplace_back(a, b, c);
    return true;
  }
  void addCell(int corner) {
    const int a = corner, b = corner + 1, c = corner + grid_.width, d = c + 1;
    const bool along_bc = !(edge(a, d) < edge(b, c));
    const bool first = along_bc ? add(a, c, b) : add(a, c, d);
    const bool second = along_bc ? add(b, c, d) : add(a, d, b);
    if (first || second) return;
    // Three good corners on the other diagonal.
    if (along_bc ? add(a, c, d) : add(a, c, b)) return;
    if (along_bc)
      add(a, d, b);
    else
      add(b, c, d);
  }

  const PixelGrid& grid_;
  const CloudOptions& options_;
  std::vector<double> ranges_;  // [m] of the vertices from the viewpoint
  std::vector<Vector3i> triangles_;
};

}  // namespace

std::vector<Vector3i> gridTriangles(const PixelGrid& grid, const Vector3& viewpoint, const CloudOptions& options) {
  return GridMesher(grid, viewpoint, options).triangles();
}

}  // namespace blem_sim::model
