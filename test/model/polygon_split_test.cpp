#include "soup/polygon_split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace blem_sim::model {
namespace {

/** Sum of the triangles' signed areas and of their sizes; equal if none lies outside the polygon or over another. */
std::pair<double, double> areas(const std::vector<Vector3>& vertices, const Vector3& normal) {
  std::vector<int> polygon(vertices.size());
  std::iota(polygon.begin(), polygon.end(), 0);
  std::pair<double, double> sum{0, 0};
  const std::vector<Vector3i> triangles = splitPolygon(vertices, polygon);
  EXPECT_EQ(triangles.size(), vertices.size() - 2);
  for (const Vector3i& t : triangles) {
    const Vector3 twice = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
    sum.first += twice.dot(normal) / 2;
    sum.second += twice.norm() / 2;
  }
  return sum;
}

Matrix3 turned() { return makePose(Vector3::Zero(), Vector3(0.4, -1.2, 2.5)).linear(); }

TEST(PolygonSplit, everyStartOfAConcaveQuadrilateral) {
  const std::vector<Vector3> arrow = {{5, 0, 0}, {6, 2, 0}, {5, 1, 0}, {4, 2, 0}};
  for (int start = 0; start < 4; ++start) {
    std::vector<Vector3> vertices;
    for (int i = 0; i < 4; ++i) vertices.push_back(turned() * arrow[(start + i) % 4]);
    const auto [inside, all] = areas(vertices, turned().col(2));
    EXPECT_NEAR(inside, 1, 1e-12);
    EXPECT_NEAR(all, 1, 1e-12);
  }
}

TEST(PolygonSplit, starAndCombWithCollinearCorners) {
  std::vector<Vector3> star;
  for (int i = 0; i < 24; ++i) {
    const double radius = i % 2 ? 0.2 : 1, angle = 2 * M_PI * i / 24;
    star.push_back(turned() * Vector3(radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  const double exact = 12 * 0.2 * std::sin(2 * M_PI / 24);
  EXPECT_NEAR(areas(star, turned().col(2)).first, exact, 1e-12);
  EXPECT_NEAR(areas(star, turned().col(2)).second, exact, 1e-12);
  const std::vector<Vector3> comb = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 2, 0}, {3, 2, 0},
                                     {3, 1, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  EXPECT_NEAR(areas(comb, Vector3::UnitZ()).first, 6, 1e-12);
  EXPECT_NEAR(areas(comb, Vector3::UnitZ()).second, 6, 1e-12);
}

TEST(PolygonSplit, endsOnPolygonsThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  areas({{0, 0, 0}, {1, 0, 0}, {nan, 1, 0}, {0, 1, 0}}, Vector3::UnitZ());
  areas({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 3, 0}}, Vector3::UnitZ());
  areas({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, Vector3::UnitZ());
}

}  // namespace
}  // namespace blem_sim::model
