#include "soup/polygon_split.h"

#include <algorithm>

namespace blem_sim::model {
namespace {

using Vector2 = Eigen::Vector2d;

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

class EarCutter {
 public:
  EarCutter(const std::vector<Vector3>& vertices, const std::vector<int>& polygon) {
    // Newell's normal; the plane is seen along its largest component, so that area and order of the corners survive.
    Vector3 normal = Vector3::Zero();
    const Vector3& origin = vertices[polygon[0]];
    for (std::size_t i = 0; i < polygon.size(); ++i)
      normal += (vertices[polygon[i]] - origin).cross(vertices[polygon[(i + 1) % polygon.size()]] - origin);
    int drop = 0;
    normal.cwiseAbs().maxCoeff(&drop);
    const double sign = normal[drop] < 0 ? -1 : 1;
    for (int vertex : polygon) {
      const Vector3 p = vertices[vertex] - origin;
      corners_.push_back({vertex, Vector2(p[(drop + 1) % 3], sign * p[(drop + 2) % 3])});
    }
  }

  std::vector<Vector3i> run() {
    while (corners_.size() > 3) cut(ear());
    cut(1);
    return std::move(triangles_);
  }

 private:
  struct Corner {
    int vertex;
    Vector2 p;
  };

  const Corner& at(std::size_t i) const { return corners_[i % corners_.size()]; }

  void cut(std::size_t ear) {
    const std::size_t n = corners_.size();
    triangles_.emplace_back(at(ear + n - 1).vertex, at(ear).vertex, at(ear + 1).vertex);
    corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(ear));
  }

  /** First corner that can be cut off; the second one, which makes a fan, if there is none. */
  std::size_t ear() const {
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (isEar(i)) return i;
    return 1;
  }

  bool isEar(std::size_t i) const {
    const std::size_t n = corners_.size();
    const Vector2 &a = at(i + n - 1).p, &b = at(i).p, &c = at(i + 1).p;
    if (!(cross(b - a, c - b) > 0)) return false;
    for (std::size_t k = i + 2; k + 1 < i + n; ++k) {
      const Vector2& p = at(k).p;
      if (p == a || p == b || p == c) continue;
      if (cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0) return false;
    }
    return true;
  }

  std::vector<Corner> corners_;
  std::vector<Vector3i> triangles_;
};

}  // namespace

std::vector<Vector3i> splitPolygon(const std::vector<Vector3>& vertices, const std::vector<int>& polygon) {
  return EarCutter(vertices, polygon).run();
}

}  // namespace blem_sim::model
