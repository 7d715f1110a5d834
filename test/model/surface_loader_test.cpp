#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

std::string dataFile(const std::string& name) { return std::string(BLEM_SIM_SOURCE_DIR) + "/test/data/model/" + name; }

double signedVolume(const geometry::TriangleMesh& mesh) {
  double six = 0;
  for (const Vector3i& e : mesh.elements) six += mesh.vertices[e[0]].dot(mesh.vertices[e[1]].cross(mesh.vertices[e[2]]));
  return six / 6;
}

double area(const geometry::TriangleMesh& mesh) {
  double twice = 0;
  for (const Vector3i& e : mesh.elements)
    twice += (mesh.vertices[e[1]] - mesh.vertices[e[0]]).cross(mesh.vertices[e[2]] - mesh.vertices[e[0]]).norm();
  return twice / 2;
}

void expectBounds(const LoadedSurface& surface, const Vector3& lower, const Vector3& upper) {
  EXPECT_LT((surface.report.extents.min() - lower).norm(), 1e-6) << surface.report.extents.min().transpose();
  EXPECT_LT((surface.report.extents.max() - upper).norm(), 1e-6) << surface.report.extents.max().transpose();
}

/** Binary STL of the tetrahedron with edges 1, 2, 3 along x, y, z. */
std::string binaryStl(const std::string& header, std::uint32_t announced) {
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  const int triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&announced), 4);
  for (const auto& triangle : triangles) {
    bytes.append(12, '\0');
    for (int corner : triangle) bytes.append(reinterpret_cast<const char*>(corners[corner]), 12);
    bytes.append(2, '\0');
  }
  return bytes;
}

const char* const ASCII_STL = R"(solid tetra
facet normal 0 0 0
 outer loop
  vertex 0 0 0
  vertex 0 2 0
  vertex 1 0 0
 endloop
endfacet
facet normal 0 0 0
 outer loop
  vertex 0 0 0
  vertex 1 0 0
  vertex 0 0 3
 endloop
endfacet
facet normal 0 0 0
 outer loop
  vertex 0 0 0
  vertex 0 0 3
  vertex 0 2 0
 endloop
endfacet
facet normal 0 0 0
 outer loop
  vertex 1 0 0
  vertex 0 2 0
  vertex 0 0 3
 endloop
endfacet
endsolid tetra
)";
const char* const PLY =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const char* const OBJ = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const char* const OFF = "OFF # a comment\n4 4 6\n0 0 0\n1 0 0\n\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

// Comments and blank rows anywhere, counts behind the keyword, none of edges.
const char* const LOOSE_OFF =
    "OFF 4 4\n# vertices\n0 0 0\n# more\n1 0 0\n\n0 2 0 # third\n0 0 3\n3 0 2 1\n# f\n3 0 1 3\n\n3 0 3 2\n3 1 2 3\n";

struct FormatRow {
  const char* name;
  std::string bytes;
};

class Formats : public testing::TestWithParam<FormatRow> {};

TEST_P(Formats, giveTheSameTetrahedron) {
  const TemporaryFolder folder;
  const LoadedSurface surface = loadSurface(folder.write(GetParam().name, GetParam().bytes));
  EXPECT_EQ(surface.report.triangles, 4);
  EXPECT_EQ(surface.report.vertices, 4);
  EXPECT_TRUE(surface.report.closed);
  EXPECT_EQ(surface.report.open_edges, 0);
  EXPECT_EQ(surface.radius, 0);
  EXPECT_NEAR(signedVolume(*surface.mesh), 1, 1e-12);
  expectBounds(surface, Vector3::Zero(), Vector3(1, 2, 3));
}

INSTANTIATE_TEST_SUITE_P(All, Formats,
                         testing::Values(FormatRow{"a.stl", binaryStl("binary", 4)}, FormatRow{"b.STL", binaryStl("solid binary", 4)},
                                         FormatRow{"trailing.stl", binaryStl("binary", 4) + "more"}, FormatRow{"c.stl", ASCII_STL},
                                         FormatRow{"d.ply", PLY}, FormatRow{"e.obj", OBJ}, FormatRow{"f.off", OFF},
                                         FormatRow{"g.off", LOOSE_OFF}));

TEST(SurfaceLoader, colladaUnitsAreAppliedAndTheUpAxisIsNot) {
  expectBounds(loadSurface(dataFile("millimetre_z_up.dae")), Vector3::Zero(), Vector3(0.001, 0.002, 0.003));
  expectBounds(loadSurface(dataFile("inch_y_up.dae")), Vector3::Zero(), 0.0254 * Vector3(1, 2, 3));
}

TEST(SurfaceLoader, nodeTransformsAreBakedInFileUnits) {
  // The mesh is scaled by 2, turned by 90 deg about z, moved by (10, 20, 30) inches.
  expectBounds(loadSurface(dataFile("inch_z_up_nested.dae")), 0.0254 * Vector3(6, 20, 30), 0.0254 * Vector3(10, 22, 36));
}

TEST(SurfaceLoader, mirroringKeepsTheOutsideOutside) {
  const LoadedSurface node = loadSurface(dataFile("metre_x_up_mirrored.dae"));
  expectBounds(node, Vector3(-1, 0, 0), Vector3(0, 2, 3));
  EXPECT_NEAR(signedVolume(*node.mesh), 1, 1e-6);
  const TemporaryFolder folder;
  const LoadedSurface scaled = loadSurface(folder.write("a.obj", OBJ), Vector3(2, -0.5, 1));
  expectBounds(scaled, Vector3(0, -1, 0), Vector3(2, 0, 3));
  EXPECT_NEAR(signedVolume(*scaled.mesh), 1, 1e-6);
}

TEST(SurfaceLoader, concavePolygonsAreSplitInsideTheirOutline) {
  const LoadedSurface surface = loadSurface(dataFile("concave_polygons.obj"));
  EXPECT_EQ(surface.report.triangles, 6);
  EXPECT_EQ(surface.report.segments, 1);
  EXPECT_NEAR(area(*surface.mesh), 4, 1e-6);  // a fan from a wrong corner would overlap and give more
}

TEST(SurfaceLoader, pointsOfAPlyWithoutFaces) {
  const TemporaryFolder folder;
  const std::string file = folder.write("points.ply",
                                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                                        "end_header\n0 0 0\n1 0 0\nnan 0 0\n1 0 0\n");
  CloudOptions options;
  options.point_radius = 0.02;
  const LoadedSurface surface = loadSurface(file, Vector3(2, 1, 1), options);
  EXPECT_EQ(surface.report.points, 2);
  EXPECT_EQ(surface.report.nonfinite, 1);
  EXPECT_EQ(surface.report.welded, 1);
  EXPECT_EQ(surface.radius, 0.02);
  EXPECT_EQ(surface.report.boundary_width, 0.02);
  expectBounds(surface, Vector3::Zero(), Vector3(2, 0, 0));
}

TEST(SurfaceLoader, meshAskedForAsPointsGivesItsVertices) {
  const TemporaryFolder folder;
  CloudOptions options;
  options.as = CloudOptions::As::POINTS;
  const LoadedSurface surface = loadSurface(folder.write("a.ply", PLY), Vector3::Ones(), options);
  EXPECT_EQ(surface.report.points, 4);
  EXPECT_EQ(surface.report.triangles, 0);
  EXPECT_EQ(surface.radius, options.point_radius);
}

std::string pcdHeader(const std::string& size_and_type, int width, int height, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n" + size_and_type + "COUNT 1 1 1\nWIDTH " + std::to_string(width) + "\nHEIGHT " +
         std::to_string(height) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(width * height) + "\nDATA " + data + "\n";
}

const std::string FLOATS = "SIZE 4 4 4\nTYPE F F F\n";

/** 3 x 2 pixels, 1 cm apart; the last one was not measured, or lies far behind. */
std::string gridPcd(const std::string& last) {
  return pcdHeader(FLOATS, 3, 2, "ascii") + "0 0 1\n0.01 0 1\n0.02 0 1\n0 0.01 1\n0.01 0.01 1\n" + last + "\n";
}

TEST(SurfaceLoader, pcdInAsciiAndBinaryAndDouble) {
  const TemporaryFolder folder;
  const float floats[6] = {1, 2, 3, 4, 5, 6};
  const double doubles[6] = {1, 2, 3, 4, 5, 6};
  const std::string binary(reinterpret_cast<const char*>(floats), sizeof(floats));
  const std::string wide(reinterpret_cast<const char*>(doubles), sizeof(doubles));
  for (const std::string& file : {folder.write("a.pcd", pcdHeader(FLOATS, 2, 1, "ascii") + "1 2 3\n4 5 6\n"),
                                  folder.write("b.pcd", pcdHeader(FLOATS, 2, 1, "binary") + binary),
                                  folder.write("c.pcd", pcdHeader("SIZE 8 8 8\nTYPE F F F\n", 2, 1, "binary") + wide)}) {
    const LoadedSurface surface = loadSurface(file);
    EXPECT_EQ(surface.report.points, 2) << file;
    expectBounds(surface, Vector3(1, 2, 3), Vector3(4, 5, 6));
  }
}

TEST(SurfaceLoader, organizedCloudIsJoinedOnItsGrid) {
  const TemporaryFolder folder;
  CloudOptions options;
  options.as = CloudOptions::As::MESH;
  options.max_edge = 0.02;
  const LoadedSurface whole = loadSurface(folder.write("whole.pcd", gridPcd("0.02 0.01 1")), Vector3::Ones(), options);
  EXPECT_EQ(whole.report.triangles, 4);
  EXPECT_NEAR(area(*whole.mesh), 2e-4, 1e-9);
  const LoadedSurface hole = loadSurface(folder.write("hole.pcd", gridPcd("nan nan nan")), Vector3::Ones(), options);
  EXPECT_EQ(hole.report.triangles, 3);
  EXPECT_EQ(hole.report.nonfinite, 1);
  EXPECT_NEAR(area(*hole.mesh), 1.5e-4, 1e-9);
  const LoadedSurface step = loadSurface(folder.write("step.pcd", gridPcd("0.02 0.01 2")), Vector3::Ones(), options);
  EXPECT_EQ(step.report.triangles, 3);  // no curtain between the near and the far pixel
}

TEST(SurfaceLoader, unorganizedCloudIsJoinedByProjection) {
  // A unit square of points one centimetre apart; every point doubled, one not finite.
  std::string rows;
  int count = 1;
  for (int i = 0; i < 21; ++i)
    for (int j = 0; j < 21; ++j, count += 2)
      for (int twice = 0; twice < 2; ++twice)
        rows +=
            std::to_string(0.01 * i + 0.0007 * std::sin(7.0 * j)) + " " + std::to_string(0.01 * j + 0.0007 * std::sin(11.0 * i)) + " 0.5\n";
  const TemporaryFolder folder;
  CloudOptions options;
  options.as = CloudOptions::As::MESH;
  options.max_edge = 0.03;
  const LoadedSurface surface =
      loadSurface(folder.write("a.pcd", pcdHeader(FLOATS, count, 1, "ascii") + rows + "nan nan nan\n"), Vector3::Ones(), options);
  EXPECT_EQ(surface.report.nonfinite, 1);
  EXPECT_EQ(surface.report.welded, 21 * 21);
  EXPECT_EQ(surface.radius, 0);
  EXPECT_NEAR(area(*surface.mesh), 0.04, 0.003);
}

TEST(SurfaceLoader, reportNamesSourceAndWhatWasDone) {
  const TemporaryFolder folder;
  const std::string file = folder.write("twice.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n2 0 0\n3 0 1 2\n3 2 1 0\n3 0 1 3\n3 1 1 2\n");
  const geometry::MeshReport report = loadSurface(file).report;
  EXPECT_EQ(report.source, file);
  EXPECT_EQ(report.triangles, 1);
  EXPECT_EQ(report.duplicate, 1);
  EXPECT_EQ(report.degenerate, 2);  // one collinear, one that names a vertex twice
  EXPECT_EQ(report.segments, 0);
  EXPECT_EQ(report.notes.size(), 2u);
}

}  // namespace
}  // namespace blem_sim::model
