// Cracks are closed, T-junctions split, noisy planes made planes; surfaces that are whole, curved or meant to be apart stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/geometry/mesh_topology.h"
#include "contact/stl_soup.h"
#include "geometry/lens_shapes.h"
#include "geometry/ply_soup.h"
#include "support/broken_meshes.h"
#include "support/shared_data.h"

namespace blem_sim::geometry {
namespace {

constexpr double CRACKS = 1e-5;                                // [m] in each coordinate
constexpr double FARTHEST_CRACK = 1.7321 * CRACKS;             // [m]
constexpr double MOST = FARTHEST_CRACK + 2 * PLANE_DEVIATION;  // [m] from where a vertex should be
constexpr const char* MUG = BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl";

/** A mesh as the loader would clean it, and as mending made it. */
struct Mended {
  explicit Mended(const TriangleMesh& soup) : cleaned(cleanMesh(soup, &report)), mesh(mendMesh(cleaned, &report, &what)) {}

  bool same() const { return mesh.vertices == cleaned.vertices && mesh.elements == cleaned.elements; }

  MeshReport report;
  MeshMending what;
  TriangleMesh cleaned, mesh;
};

int ridges(const TriangleMesh& mesh) {
  const MeshTopology topology(mesh);
  int bent = 0;
  for (int edge = 0; edge < topology.edgeCount(); ++edge) bent += !topology.isFlatEdge(edge);
  return bent;
}

double distanceFromBox(const Vector3& p, double half) { return std::abs(p.cwiseAbs().maxCoeff() - half); }

/** Largest distance of a vertex of one from the nearest of the other. */
double farthest(const TriangleMesh& of, const TriangleMesh& from) {
  double largest = 0;
  for (const Vector3& p : of.vertices) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3& q : from.vertices) nearest = std::min(nearest, (p - q).squaredNorm());
    largest = std::max(largest, nearest);
  }
  return std::sqrt(largest);
}

TriangleMesh noisy(TriangleMesh mesh, double amplitude, RandomShapes& random) {
  for (Vector3& p : mesh.vertices) p += random.point(amplitude);
  return mesh;
}

TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Vector3i& e : b.elements) both.elements.push_back(e + Vector3i::Constant(static_cast<int>(a.vertices.size())));
  return both;
}

TEST(MeshMending, WholeMeshesStayAsTheyAre) {
  const TriangleMesh box = boxMesh({0.1, 0.07, 0.3});
  for (const TriangleMesh& mesh :
       {box, subdivided(box, 3), transformed(subdivided(box, 2), makePose({1, 2, 3}, {0.3, 0.4, 0.5})), gridMesh(2, 3, 20, 30),
        icosphereMesh(0.04, 0), icosphereMesh(0.04, 3), icosphereMesh(0.04, 6), cylinderMesh(0.04, 0.1), cylinderMesh(0.04, 0.1, 300),
        segmentMesh({0, 0, 0}, {1, 0, 0}), pointMesh({0, 0, 0}), TriangleMesh()}) {
    const Mended mended(mesh);
    EXPECT_TRUE(mended.same()) << mesh.elements.size();
    EXPECT_EQ(mended.what.cracks + mended.what.split_edges + mended.what.planes + mended.what.flattened, 0);
  }
}

TEST(MeshMending, MeshesOfTheDemosStayAsTheyAre) {
  for (const auto& entry : std::filesystem::directory_iterator(BLEM_SIM_SOURCE_DIR "/meshes")) {
    if (entry.path().extension() == ".stl") {
      EXPECT_TRUE(Mended(contact::readStlSoup(entry.path().string())).same()) << entry.path();
    }
    if (entry.path().extension() == ".ply") {
      EXPECT_TRUE(Mended(readPlySoup(entry.path().string())).same()) << entry.path();
    }
  }
}

TEST(MeshMending, CrackedBoxIsABoxAgain) {
  RandomShapes random(1);
  for (int i = 0; i < 200; ++i) {
    const TriangleMesh box = subdivided(boxMesh(Vector3::Constant(0.1)), i % 4);
    const Mended mended(crackedCopy(box, CRACKS, random));
    ASSERT_TRUE(mended.report.closed) << i;
    EXPECT_EQ(mended.mesh.elements.size(), box.elements.size());
    EXPECT_EQ(mended.mesh.vertices.size(), box.vertices.size());
    EXPECT_EQ(mended.what.cracks, static_cast<int>(3 * box.elements.size() / 2));
    EXPECT_LE(mended.what.widest_crack, 2 * FARTHEST_CRACK);
    EXPECT_EQ(ridges(mended.mesh), 12 << (i % 4)) << i;
    for (const Vector3& p : mended.mesh.vertices) EXPECT_LE(distanceFromBox(p, 0.05), MOST);
  }
}

TEST(MeshMending, CrackedCurvedSurfacesStayCurved) {
  RandomShapes random(2);
  for (const TriangleMesh& mesh : {icosphereMesh(0.04, 2), icosphereMesh(0.04, 5), cleanMesh(contact::readStlSoup(MUG), nullptr)}) {
    MeshReport whole;
    cleanMesh(mesh, &whole);
    const Mended mended(crackedCopy(mesh, CRACKS, random));
    EXPECT_EQ(mended.report.triangles, whole.triangles);
    EXPECT_EQ(mended.report.vertices, whole.vertices);
    EXPECT_EQ(mended.report.open_edges, whole.open_edges);
    EXPECT_LE(farthest(mended.mesh, mesh), MOST);
    EXPECT_LE(farthest(mesh, mended.mesh), MOST);
  }
}

TEST(MeshMending, TJunctionsAreSplit) {
  const TriangleMesh box = boxMesh(Vector3::Constant(0.1));
  const Mended mended(tJunctionCopy(box));
  EXPECT_GT(mended.what.split_edges, 0);
  EXPECT_EQ(mended.what.cracks + mended.what.planes, 0);
  EXPECT_TRUE(mended.report.closed);
  EXPECT_EQ(mended.mesh.vertices, mended.cleaned.vertices);
  const MeshTopology topology(mended.mesh);
  for (int i = 0; i < topology.edgeCount(); ++i) {
    const auto [start, end] = topology.ends(mended.mesh, i);
    const Vector3 middle = 0.5 * (mended.mesh.vertices[start] + mended.mesh.vertices[end]);
    const bool on_edge = (middle.array().abs() > 0.05 - 1e-9).count() == 2;
    EXPECT_EQ(!topology.isFlatEdge(i), on_edge);
  }
}

TEST(MeshMending, TJunctionsOfTheMugAreSplit) {
  const TriangleMesh mug = cleanMesh(contact::readStlSoup(MUG), nullptr);
  const Mended mended(tJunctionCopy(mug));
  MeshReport whole;
  cleanMesh(mug, &whole);
  EXPECT_GE(mended.report.open_edges, whole.open_edges);
  EXPECT_LE(mended.report.open_edges, 2 * whole.open_edges);
  EXPECT_EQ(mended.what.planes, 0);
  EXPECT_EQ(mended.mesh.vertices, mended.cleaned.vertices);
}

TEST(MeshMending, CrackedTJunctionsAreClosed) {
  RandomShapes random(3);
  for (int i = 0; i < 100; ++i) {
    const TriangleMesh box = subdivided(boxMesh(Vector3::Constant(0.1)), i % 3);
    const Mended mended(crackedCopy(tJunctionCopy(box), CRACKS, random));
    EXPECT_TRUE(mended.report.closed) << i;
    EXPECT_EQ(mended.what.planes, 6);
    for (const Vector3& p : mended.mesh.vertices) EXPECT_LE(distanceFromBox(p, 0.05), MOST);
    const MeshTopology topology(mended.mesh);
    for (int k = 0; k < topology.edgeCount(); ++k) {
      const auto [start, end] = topology.ends(mended.mesh, k);
      const Vector3 middle = 0.5 * (mended.mesh.vertices[start] + mended.mesh.vertices[end]);
      if ((middle.array().abs() > 0.0499).count() < 2) {
        EXPECT_TRUE(topology.isFlatEdge(k)) << i << " " << middle.transpose();
      }
    }
  }
}

TEST(MeshMending, OrderDoesNotMatter) {
  RandomShapes random(4);
  const TriangleMesh broken = crackedCopy(tJunctionCopy(subdivided(boxMesh({0.1, 0.08, 0.06}), 1)), CRACKS, random);
  const Mended first(broken);
  for (int i = 0; i < 20; ++i) {
    const Mended other(rewoundCopy(shuffledCopy(broken, random), random));
    EXPECT_EQ(other.mesh.elements.size(), first.mesh.elements.size());
    EXPECT_EQ(other.mesh.vertices.size(), first.mesh.vertices.size());
    EXPECT_EQ(other.what.cracks, first.what.cracks);
    EXPECT_EQ(other.what.split_edges, first.what.split_edges);
    EXPECT_EQ(other.what.planes, first.what.planes);
    EXPECT_LE(farthest(other.mesh, first.mesh), 1e-14);
    EXPECT_LE(farthest(first.mesh, other.mesh), 1e-14);
  }
}

TEST(MeshMending, SheetsCloseTogetherStayApart) {
  RandomShapes random(5);
  const TriangleMesh sheet = gridMesh(0.1, 0.1, 5, 5), above = transformed(sheet, makePose({0, 0, 3e-5}));
  EXPECT_TRUE(Mended(together(sheet, above)).same());
  const Mended cracked(together(crackedCopy(sheet, 2e-6, random), crackedCopy(above, 2e-6, random)));
  EXPECT_EQ(cracked.report.vertices, 2 * 36);
  EXPECT_EQ(cracked.report.open_edges, 2 * 20);
  for (const Vector3& p : cracked.mesh.vertices) EXPECT_LT(std::min(std::abs(p.z()), std::abs(p.z() - 3e-5)), 4e-6);
}

TEST(MeshMending, WhatIsSmallOrApartIsNotJoined) {
  const TriangleMesh tile = gridMesh(0.1, 0.1, 2, 2);
  EXPECT_TRUE(Mended(together(tile, transformed(tile, makePose({0.1001, 0, 0})))).same());   // a joint of 0.1 mm
  EXPECT_TRUE(Mended(gridMesh(0.1, 3e-5, 5, 1)).same());                                     // a ribbon of 30 um
  EXPECT_TRUE(Mended(gridMesh(1e-4, 1e-4, 6, 6)).same());                                    // edges of 17 um
  EXPECT_TRUE(Mended(together(tile, transformed(tile, makePose({3e-5, 0, 3e-5})))).same());  // sheets that are shifted
  EXPECT_TRUE(Mended(boxMesh({0.1, 0.1, 3e-5})).same());                                     // a plate of 30 um
}

/** Triangles side by side in a square. @param step [m] from one to the next */
TriangleMesh minuteTriangles(int rows, double step) {
  TriangleMesh soup;
  for (int i = 0; i < rows * rows; ++i) {
    const Vector3 corner(i % rows * step, i / rows * step, 0);
    const int first = static_cast<int>(soup.vertices.size());
    for (const Vector3& p : {Vector3(0, 0, 0), Vector3(0.8 * step, 0, 0), Vector3(0, 0.8 * step, 0)}) soup.vertices.push_back(corner + p);
    soup.elements.emplace_back(first, first + 1, first + 2);
  }
  return soup;
}

// Many lie within the width of one crack, as those of a mesh in the wrong unit or of a sensor's cloud of one place do.
TEST(MeshMending, ManyMinuteTrianglesTakeNoLongerThanLargeOnes) {
  for (const double step : {1e-8, 1e-6}) {
    const auto start = std::chrono::steady_clock::now();
    const Mended mended(minuteTriangles(160, step));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10)) << step;  // minutes, if each is held against each
    EXPECT_EQ(mended.what.cracks, 0);
  }
}

TEST(MeshMending, NoiseOnPlanesGoes) {
  RandomShapes random(6);
  for (const int level : {2, 3, 4}) {
    const Mended mended(noisy(subdivided(boxMesh(Vector3::Constant(0.1)), level), CRACKS, random));
    EXPECT_EQ(mended.what.planes, 6);
    EXPECT_LE(mended.what.farthest, 2 * PLANE_DEVIATION);
    EXPECT_EQ(ridges(mended.mesh), 12 << level);
    for (const Vector3& p : mended.mesh.vertices) EXPECT_LE(distanceFromBox(p, 0.05), MOST);
    EXPECT_EQ(mended.report.extents.min(), mended.mesh.bounds().min());
  }
}

TEST(MeshMending, ReliefStays) {
  RandomShapes random(7);
  EXPECT_TRUE(Mended(noisy(gridMesh(1, 1, 100, 100), 5e-4, random)).same());                            // a scan
  EXPECT_TRUE(Mended(noisy(subdivided(boxMesh(Vector3::Constant(0.1)), 3), 6e-5, random)).same());      // rough
  EXPECT_TRUE(Mended(noisy(subdivided(boxMesh(Vector3::Constant(0.002)), 4), CRACKS, random)).same());  // small: 10 um are a shape
  TriangleMesh dome = gridMesh(0.1, 0.1, 50, 50);
  for (Vector3& p : dome.vertices) p.z() = p.head<2>().squaredNorm() / (2 * 2.0);  // 2 m of radius: 0.6 mm high
  EXPECT_TRUE(Mended(dome).same());
}

TEST(MeshMending, LensesStayLenses) {
  RandomShapes random(8);
  for (const double sag : {1e-6, 4e-6, 16e-6, 25e-6, 36e-6, 60e-6}) {
    for (const int rings : {1, 2, 3, 5, 20}) {
      for (const int sides : {12, 24, 60, 200}) {
        const TriangleMesh lens = lensMesh(0.015, 0.003, sag, rings, sides);
        EXPECT_TRUE(Mended(transformed(lens, makePose({0.1, 0.2, 0.3}, {0.3, 0.4, 0.5}))).same()) << sag << " " << rings << " " << sides;
        EXPECT_TRUE(Mended(shuffledCopy(lens, random)).same()) << sag << " " << rings << " " << sides;
      }
    }
  }
}

TEST(MeshMending, SurfacesThatBulgeBetweenSharpEdgesStay) {
  const auto bent = [](int cells, const auto& height) {
    TriangleMesh mesh = gridMesh(0.1, 0.1, cells, cells);
    for (Vector3& p : mesh.vertices) p.z() = height(p.x() / 0.05, p.y() / 0.05);
    return mesh;
  };
  for (const int cells : {5, 10, 40}) {
    EXPECT_TRUE(Mended(bent(cells, [](double x, double) { return 15e-6 * x * x; })).same()) << cells;         // a barrel
    EXPECT_TRUE(Mended(bent(cells, [](double x, double y) { return 15e-6 * x * y; })).same()) << cells;       // a saddle
    EXPECT_TRUE(Mended(bent(cells, [](double x, double y) { return 8e-6 * (x + y) * y; })).same()) << cells;  // both
  }
  EXPECT_TRUE(Mended(bent(60, [](double x, double y) { return 15e-6 * std::sin(7 * x) * std::cos(5 * y); })).same());  // waves
}

// Bulges that the noise of cracks explains are flattened: ten micrometres of noise hide a bulge of sixteen, a tenth does not.
TEST(MeshMending, CrackedLensesStayLenses) {
  RandomShapes random(9);
  for (const double sag : {16e-6, 36e-6}) {
    const TriangleMesh lens = lensMesh(0.015, 0.003, sag, 6, 48);
    const Mended mended(crackedCopy(lens, 1e-7, random));
    EXPECT_EQ(mended.report.vertices, static_cast<int>(lens.vertices.size()));
    EXPECT_LE(farthest(mended.mesh, lens), 1e-6);
  }
}

TEST(MeshMending, RobotsMoveByLittle) {
  SKIP_WITHOUT_SHARED_DATA("robots/klampt/huboplus/meshes");
  for (const auto& entry : std::filesystem::directory_iterator(*sharedData("robots/klampt/huboplus/meshes"))) {
    if (entry.path().extension() != ".stl") continue;
    const Mended mended(contact::readStlSoup(entry.path().string()));
    EXPECT_EQ(mended.what.cracks + mended.what.split_edges, 0) << entry.path();
    EXPECT_EQ(mended.mesh.elements, mended.cleaned.elements);
    EXPECT_LE(mended.what.farthest, 2 * PLANE_DEVIATION);
  }
}

TEST(MeshMending, bordersAllAcrossEachOtherAreLeftAlone) {
  RandomShapes random(7);
  TriangleMesh soup;
  for (int i = 0; i < 6000; ++i) {
    for (int corner = 0; corner < 3; ++corner) soup.vertices.push_back(random.point(1).cwiseProduct(Vector3(1, 1, 0)));
    soup.elements.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  const Mended mended(soup);
  EXPECT_TRUE(mended.what.given_up) << "it would take time as the square of their number";
  EXPECT_TRUE(mended.same());
}

}  // namespace
}  // namespace blem_sim::geometry
