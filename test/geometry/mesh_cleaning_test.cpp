#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "blem_sim/geometry/triangle_mesh.h"
#include "geometry/ply_soup.h"
#include "geometry/random_shapes.h"
#include "support/shared_data.h"

namespace blem_sim::geometry {
namespace {

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
constexpr double INFINITE = std::numeric_limits<double>::infinity();

/** Three vertices for each triangle, as an STL file has them. */
TriangleMesh unshared(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Vector3i& e : mesh.elements) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(mesh.vertices[e[k]]);
    soup.elements.emplace_back(first, first + 1, first + 2);
  }
  return soup;
}

TEST(CleanMesh, LeavesACleanMeshAsItIs) {
  const TriangleMesh box = boxMesh({1, 2, 3});
  MeshReport report;
  const TriangleMesh mesh = cleanMesh(box, &report);
  EXPECT_EQ(mesh.vertices, box.vertices);
  EXPECT_EQ(mesh.elements, box.elements);
  EXPECT_EQ(report.vertices, 8);
  EXPECT_EQ(report.triangles, 12);
  EXPECT_EQ(report.degenerate + report.duplicate + report.nonfinite + report.invalid + report.welded, 0);
  EXPECT_EQ(report.open_edges, 0);
  EXPECT_EQ(report.nonmanifold_edges, 0);
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.extents.isApprox(Box(Vector3(-0.5, -1, -1.5), Vector3(0.5, 1, 1.5))));
}

TEST(CleanMesh, WeldsASoup) {
  MeshReport report;
  const TriangleMesh mesh = cleanMesh(unshared(boxMesh({1, 2, 3})), &report);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(report.welded, 28);
  EXPECT_EQ(report.triangles, 12);
  EXPECT_TRUE(report.closed);
}

TEST(CleanMesh, MinusZeroIsZeroAndTheNextNumberIsNot) {
  TriangleMesh soup;
  soup.vertices = {{0.0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, -0.0, 0}, {1, -0.0, 0}, {0, -1, 0}, {std::nextafter(1, 2), 0, 0}};
  soup.elements = {{0, 1, 2}, {3, 5, 4}, {3, 5, 6}};
  MeshReport report;
  cleanMesh(soup, &report);
  EXPECT_EQ(report.welded, 2);
  EXPECT_EQ(report.vertices, 5);
}

TEST(CleanMesh, DropsWhatCannotBeUsed) {
  TriangleMesh soup = boxMesh({1, 1, 1});
  soup.vertices.emplace_back(NOT_A_NUMBER, 0, 0);
  soup.vertices.emplace_back(0, INFINITE, 0);
  soup.vertices.emplace_back(0, 0, 1e31);
  soup.elements.insert(soup.elements.begin(), {{8, 0, 1}, {0, 9, 1}, {0, 1, 10}, {8, 8, 8}, {0, 1, 11}, {-1, 0, 1}, {0, 99, 8}});
  MeshReport report;
  const TriangleMesh mesh = cleanMesh(soup, &report);
  EXPECT_EQ(report.nonfinite, 4);
  EXPECT_EQ(report.invalid, 3);
  EXPECT_EQ(mesh.elements, boxMesh({1, 1, 1}).elements);
  EXPECT_EQ(mesh.vertices.size(), 8u);
}

TEST(CleanMesh, DropsTrianglesWithoutAreaButKeepsNeedles) {
  TriangleMesh soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0.3, 1e-9, 0}, {1, 0, 0}, {0.1, 0.3, 0.7}, {0.2, 0.6, 1.4}, {0.3, 0.9, 2.1}};
  soup.elements = {{0, 1, 2}, {0, 1, 4}, {5, 6, 7}, {0, 1, 3}};
  MeshReport report;
  const TriangleMesh mesh = cleanMesh(soup, &report);
  EXPECT_EQ(report.degenerate, 3) << "collinear, two corners in one place, collinear to rounding";
  ASSERT_EQ(mesh.elements.size(), 1u) << "the needle is a nanometre high";
  EXPECT_EQ(mesh.vertices[mesh.elements[0][2]].y(), 1e-9);
}

TEST(CleanMesh, AreaDoesNotDependOnSize) {
  for (const double size : {1e-100, 1e-20, 1e-6, 1.0, 1e6, 1e29}) {
    MeshReport report;
    cleanMesh(transformed(boxMesh({1, 1, 1}), Pose::Identity(), Vector3::Constant(size)), &report);
    EXPECT_EQ(report.triangles, 12) << size;
    EXPECT_TRUE(report.closed) << size;
  }
}

TEST(CleanMesh, DropsRepeatedTrianglesOfEitherWinding) {
  TriangleMesh soup = boxMesh({1, 1, 1});
  const TriangleMesh box = soup;
  soup.elements.emplace_back(box.elements[3]);
  soup.elements.emplace_back(box.elements[5].reverse());
  soup.elements.emplace_back(box.elements[5][1], box.elements[5][2], box.elements[5][0]);
  MeshReport report;
  EXPECT_EQ(cleanMesh(soup, &report).elements, box.elements);
  EXPECT_EQ(report.duplicate, 3);
  EXPECT_TRUE(report.closed);
}

TEST(CleanMesh, SegmentsAndPointsPassUnlessTheSoupHasNone) {
  TriangleMesh soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  soup.elements = {{0, 1, 2}, {0, 1, 1}, {1, 0, 0}, {2, 2, 3}, {3, 3, 3}, {3, 3, 3}};
  MeshReport report;
  cleanMesh(soup, &report);
  EXPECT_EQ(report.triangles, 1);
  EXPECT_EQ(report.segments, 2);
  EXPECT_EQ(report.points, 1);
  EXPECT_EQ(report.duplicate, 2) << "a segment the other way round and a point";
  EXPECT_EQ(report.degenerate, 0);
  EXPECT_FALSE(report.closed);

  const TriangleMesh triangles = cleanMesh(soup, &report, RepeatedIndices::ARE_DEGENERATE);
  EXPECT_EQ(report.degenerate, 5);
  EXPECT_EQ(report.triangles, 1);
  EXPECT_EQ(report.segments + report.points, 0);
  EXPECT_EQ(triangles.vertices.size(), 3u) << "the vertex of the points is unused";
}

TEST(CleanMesh, CountsOpenAndNonManifoldEdges) {
  MeshReport report;
  cleanMesh(gridMesh(1, 1, 4, 3), &report);
  EXPECT_EQ(report.open_edges, 14);
  EXPECT_EQ(report.nonmanifold_edges, 0);
  EXPECT_FALSE(report.closed);

  TriangleMesh book;  // five pages on one spine
  book.vertices = {{0, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < 5; ++i) {
    book.vertices.emplace_back(std::cos(i), std::sin(i), 0.5);
    book.elements.emplace_back(0, 1, 2 + i);
  }
  cleanMesh(book, &report);
  EXPECT_EQ(report.open_edges, 10);
  EXPECT_EQ(report.nonmanifold_edges, 1);
}

TEST(CleanMesh, OfNothingIsNothing) {
  MeshReport report;
  report.triangles = 77;
  report.duplicate = 77;
  EXPECT_TRUE(cleanMesh(TriangleMesh(), &report).elements.empty());
  EXPECT_EQ(report.triangles, 0);
  EXPECT_EQ(report.duplicate, 0);
  EXPECT_FALSE(report.closed);
  EXPECT_TRUE(report.extents.isEmpty());
  EXPECT_TRUE(cleanMesh(TriangleMesh(), nullptr).elements.empty());
}

TEST(CleanMesh, TwiceIsOnce) {
  RandomShapes random(21);
  TriangleMesh soup;
  for (int i = 0; i < 2000; ++i) soup.vertices.push_back(random.gridPoint(3));
  for (int i = 0; i < 3000; ++i) {
    const int a = random.integer(0, 1999), b = random.integer(0, 1999), c = random.integer(0, 1999);
    if (a != b && b != c && c != a) soup.elements.emplace_back(a, b, c);
  }
  MeshReport first, second;
  const TriangleMesh once = cleanMesh(soup, &first);
  const TriangleMesh twice = cleanMesh(once, &second);
  EXPECT_EQ(once.vertices, twice.vertices);
  EXPECT_EQ(once.elements, twice.elements);
  EXPECT_GT(first.degenerate, 0);
  EXPECT_GT(first.duplicate, 0);
  EXPECT_EQ(second.degenerate + second.duplicate + second.welded, 0);
  EXPECT_EQ(first.open_edges, second.open_edges);

  // The same set of triangles by the plainest means.
  using Corner = std::array<double, 3>;
  std::set<std::array<Corner, 3>> expected;
  for (const Vector3i& e : soup.elements) {
    const Vector3 a = soup.vertices[e[0]], b = soup.vertices[e[1]], c = soup.vertices[e[2]];
    if ((b - a).cross(c - a).norm() == 0) continue;
    std::array<Corner, 3> key = {{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}}};
    std::sort(key.begin(), key.end());
    expected.insert(key);
  }
  EXPECT_EQ(once.elements.size(), expected.size());
}

TEST(PointCloudMesh, KeepsFinitePointsOnce) {
  MeshReport report;
  const TriangleMesh cloud =
      pointCloudMesh({{1, 2, 3}, {NOT_A_NUMBER, 0, 0}, {-0.0, 0, 0}, {1, 2, 3}, {0, INFINITE, 0}, {0, 0, 0}}, &report);
  EXPECT_EQ(report.nonfinite, 2);
  EXPECT_EQ(report.welded, 2);
  EXPECT_EQ(report.points, 2);
  EXPECT_EQ(report.vertices, 2);
  EXPECT_FALSE(report.closed);
  ASSERT_EQ(cloud.elements.size(), 2u);
  EXPECT_EQ(cloud.elements[1], Vector3i(1, 1, 1));
  EXPECT_EQ(cloud.vertices[0], Vector3(1, 2, 3));
  EXPECT_TRUE(pointCloudMesh({}, &report).elements.empty());
}

/** Counts of a file in pathological.yaml, as far as cleaning decides them. */
struct Expected {
  const char* file;
  int triangles, degenerate, duplicate, nonfinite;
  int open_edges, nonmanifold_edges;
};

/** Counts that the yaml gives before cleaning are corrected for dropped elements: a repeated triangle makes edges non-manifold. */
class PathologicalMesh : public testing::TestWithParam<Expected> {};

TEST_P(PathologicalMesh, IsReportedAsItWasMade) {
  const Expected& expected = GetParam();
  const std::string path = std::string("pathological/") + expected.file;
  SKIP_WITHOUT_SHARED_DATA(path);
  MeshReport report;
  const TriangleMesh mesh = cleanMesh(readPlySoup(*sharedData(path)), &report, RepeatedIndices::ARE_DEGENERATE);
  EXPECT_EQ(report.triangles, expected.triangles);
  EXPECT_EQ(report.degenerate, expected.degenerate);
  EXPECT_EQ(report.duplicate, expected.duplicate);
  EXPECT_EQ(report.nonfinite, expected.nonfinite);
  EXPECT_EQ(report.open_edges, expected.open_edges);
  EXPECT_EQ(report.nonmanifold_edges, expected.nonmanifold_edges);
  EXPECT_EQ(report.closed, expected.open_edges == 0 && expected.nonmanifold_edges == 0);
  EXPECT_EQ(report.invalid, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Files, PathologicalMesh,
    testing::Values(Expected{"cube_duplicate_faces.ply", 12, 0, 30, 0, 0, 0},
                    Expected{"cube_flipped.ply", 12, 0, 0, 0, 0,
                             0},  //
                                  // Two of the hundred are collinear only before rounding to float: needles of 1 nm.
                    Expected{"cube_zero_area.ply", 194, 98, 0, 0, 4, 2}, Expected{"cube_nan.ply", 192, 0, 0, 24, 0, 0},  //
                    Expected{"cube_cracked_soup.ply", 192, 0, 0, 0, 576, 0}, Expected{"cube_holes.ply", 138, 0, 0, 0, 124, 0},
                    Expected{"cube_nested_self_intersecting.ply", 576, 0, 0, 0, 0, 0}, Expected{"cube_layers.ply", 60, 0, 0, 0, 0, 0},  //
                    Expected{"cube_slivers.ply", 392, 0, 0, 0, 600, 0}, Expected{"cube_nonmanifold_fins.ply", 24, 0, 0, 0, 0, 17},
                    Expected{"cube_open_bottom.ply", 160, 0, 0, 0, 16, 0}),
    [](const testing::TestParamInfo<Expected>& info) {
      const std::string file = info.param.file;
      return file.substr(0, file.find('.'));
    });

TEST(PathologicalScan, SpoiledMugIsMended) {
  SKIP_WITHOUT_SHARED_DATA("pathological/srimug_spoiled.ply");
  MeshReport report;
  cleanMesh(readPlySoup(*sharedData("pathological/srimug_spoiled.ply")), &report, RepeatedIndices::ARE_DEGENERATE);
  EXPECT_EQ(report.duplicate, 583);
  EXPECT_EQ(report.degenerate + report.nonfinite, 9);
  EXPECT_EQ(report.triangles, 21792 - 583 - 9);
  EXPECT_FALSE(report.closed);
}

}  // namespace
}  // namespace blem_sim::geometry
