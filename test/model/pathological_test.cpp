// Each file of data/pathological: loaded with exact counts, or refused in one line. Counts follow from pathological.yaml and the README.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/shared_data.h"

namespace blem_sim::model {
namespace {

struct GoodRow {
  const char* name;
  int triangles, vertices, nonfinite, degenerate, duplicate, open, nonmanifold;
  bool closed;
};

const std::vector<GoodRow> GOOD = {
    {"cube_cracked_soup.ply", 192, 576, 0, 0, 0, 576, 0, false},
    {"cube_cracked_soup.stl", 192, 576, 0, 0, 0, 576, 0, false},
    {"cube_duplicate_faces.ply", 12, 8, 0, 0, 30, 0, 0, true},
    {"cube_flipped.ply", 12, 8, 0, 0, 0, 0, 0, true},
    {"cube_holes.ply", 138, 98, 0, 0, 0, 124, 0, false},
    {"cube_layers.ply", 60, 40, 0, 0, 0, 0, 0, true},
    {"cube_nan.ply", 192, 98, 24, 0, 0, 0, 0, true},
    {"cube_nan.stl", 192, 98, 24, 0, 0, 0, 0, true},
    {"cube_nested_self_intersecting.ply", 576, 293, 0, 0, 0, 0, 0, true},
    {"cube_nonmanifold_fins.ply", 24, 9, 0, 0, 0, 0, 17, false},
    {"cube_open_bottom.ply", 160, 89, 0, 0, 0, 16, 0, false},
    {"cube_slivers.ply", 392, 698, 0, 0, 0, 600, 0, false},
    // Two of its hundred collinear triangles have an area of float rounding (1e-9 of their size) and stay.
    {"cube_zero_area.ply", 194, 100, 0, 98, 0, 4, 2, false},
    {"huge_and_tiny.off", 2, 6, 0, 0, 0, 6, 0, false},
    {"nan_ascii.stl", 1, 3, 1, 0, 0, 3, 0, false},
    {"negative_index.obj", 1, 3, 0, 0, 0, 3, 0, false},
    {"one_triangle.stl", 1, 3, 0, 0, 0, 3, 0, false},
    {"quads_and_ngons.obj", 12, 8, 0, 0, 0, 0, 0, true},
    {"srimug_spoiled.ply", 21200, 63582, 9, 0, 583, 63600, 0, false},
};

const std::vector<std::pair<std::string, std::string>> REFUSED = {
    {"count_too_big.stl", "4000000000 triangles announced, 12 there"},
    {"truncated.stl", "12 triangles announced, 9 there"},
    {"empty.off", "no vertex"},
    {"index_out_of_range.off", "names vertex 7"},
};

TEST(Pathological, goodPartsAreLoadedAndTheRestIsCounted) {
  SKIP_WITHOUT_SHARED_DATA("pathological");
  for (const GoodRow& row : GOOD) {
    SCOPED_TRACE(row.name);
    const std::string file = *sharedData(std::string("pathological/") + row.name);
    const geometry::MeshReport report = loadSurface(file, Vector3::Ones(), {}, Mending::OFF).report;
    EXPECT_EQ(report.triangles, row.triangles);
    EXPECT_EQ(report.vertices, row.vertices);
    EXPECT_EQ(report.nonfinite, row.nonfinite);
    EXPECT_EQ(report.degenerate, row.degenerate);
    EXPECT_EQ(report.duplicate, row.duplicate);
    EXPECT_EQ(report.open_edges, row.open);
    EXPECT_EQ(report.nonmanifold_edges, row.nonmanifold);
    EXPECT_EQ(report.closed, row.closed);
    EXPECT_EQ(report.segments + report.points, 0);
    const int dropped = (row.nonfinite > 0) + (row.degenerate > 0) + (row.duplicate > 0);
    EXPECT_GE(static_cast<int>(report.notes.size()), dropped);  // each is said in words
  }
}

TEST(Pathological, pointsOnly) {
  SKIP_WITHOUT_SHARED_DATA("pathological/points_only.ply");
  const LoadedSurface surface = loadSurface(*sharedData("pathological/points_only.ply"));
  EXPECT_EQ(surface.report.points, 3);
  EXPECT_EQ(surface.report.triangles, 0);
  EXPECT_GT(surface.radius, 0);
}

TEST(Pathological, restIsRefusedInOneLine) {
  SKIP_WITHOUT_SHARED_DATA("pathological");
  for (const auto& [name, words] : REFUSED) {
    const std::string file = *sharedData("pathological/" + name);
    const std::string text = refusal([&] { loadSurface(file); });
    EXPECT_TRUE(isOneLineWith(text, {name, words})) << name << ": " << text;
  }
}

TEST(Pathological, noFileIsLeftOutOfTheTables) {
  SKIP_WITHOUT_SHARED_DATA("pathological");
  std::set<std::string> known = {"points_only.ply", "pathological.yaml"};
  for (const GoodRow& row : GOOD) known.insert(row.name);
  for (const auto& row : REFUSED) known.insert(row.first);
  for (const auto& entry : std::filesystem::directory_iterator(*sharedData("pathological")))
    EXPECT_EQ(known.count(entry.path().filename().string()), 1u) << entry.path();
}

}  // namespace
}  // namespace blem_sim::model
