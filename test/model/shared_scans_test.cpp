// The scans and world meshes of the shared data load with the counts of its README.
#include <gtest/gtest.h>

#include "blem_sim/model/loaders.h"
#include "support/shared_data.h"

namespace blem_sim::model {
namespace {

struct ScanRow {
  const char* file;
  int triangles;  ///< as the file holds them
  int dropped;    ///< without area or repeated
  int vertices, open;
};

class SharedScans : public testing::TestWithParam<ScanRow> {};

TEST_P(SharedScans, loadWithTheirCounts) {
  const ScanRow& row = GetParam();
  SKIP_WITHOUT_SHARED_DATA(row.file);
  const geometry::MeshReport report = loadSurface(*sharedData(row.file), Vector3::Ones(), {}, Mending::OFF).report;
  EXPECT_EQ(report.triangles, row.triangles - row.dropped);
  EXPECT_EQ(report.degenerate + report.duplicate, row.dropped);
  EXPECT_EQ(report.vertices, row.vertices);
  EXPECT_EQ(report.nonfinite + report.invalid, 0);
  if (row.dropped == 0) {
    EXPECT_EQ(report.open_edges, row.open);
  }
}

INSTANTIATE_TEST_SUITE_P(Readme, SharedScans,
                         testing::Values(ScanRow{"scans/objects/ycb_mustard_bottle.stl", 16384, 3, 8193, 0},
                                         ScanRow{"scans/objects/ycb_power_drill.stl", 15728, 0, 7866, 0},
                                         ScanRow{"scans/objects/ycb_sugar_box.stl", 16384, 0, 8194, 0},
                                         ScanRow{"scans/real/floor3_bleach.ply", 24252, 0, 12435, 616},
                                         ScanRow{"scans/real/floor3_carton.ply", 26125, 0, 13377, 629},
                                         ScanRow{"scans/real/floor3_detergent.ply", 20219, 0, 10474, 737},
                                         ScanRow{"scans/real/floor3_scene.ply", 117436, 0, 60350, 3380},
                                         ScanRow{"scans/real/stairroom_scene.ply", 114957, 0, 62339, 9851},
                                         ScanRow{"scans/real/stereomug_mug.ply", 28628, 0, 15065, 1510},
                                         ScanRow{"scans/real/stereomug_scene.ply", 66936, 0, 34874, 2998},
                                         ScanRow{"scans/synthetic_kinect/chair_150k.ply", 135233, 0, 71728, 8513},
                                         ScanRow{"scans/synthetic_kinect/chair_raw_60k.ply", 61791, 0, 32849, 4071},
                                         ScanRow{"scans/synthetic_kinect/stepladder_150k.ply", 137800, 0, 74064, 10500},
                                         ScanRow{"scans/synthetic_kinect/stepladder_1m.ply", 1021436, 0, 526975, 34376},
                                         ScanRow{"meshes/klampt/object_srimugsmooth.stl", 22300, 0, 11277, 258},
                                         ScanRow{"meshes/klampt/terrain_fractal_terrain_1.stl", 32768, 0, 16641, 512},
                                         ScanRow{"meshes/klampt/terrain_drc_rough_terrain.stl", 18344, 1176, 5773, 0}));

struct CloudRow {
  const char* file;
  int points, not_measured, pixels;
};

class SharedClouds : public testing::TestWithParam<CloudRow> {};

TEST_P(SharedClouds, loadWithTheirCounts) {
  const CloudRow& row = GetParam();
  SKIP_WITHOUT_SHARED_DATA(row.file);
  const geometry::MeshReport report = loadSurface(*sharedData(row.file)).report;
  EXPECT_EQ(report.points + report.welded, row.points);
  EXPECT_EQ(report.nonfinite, row.not_measured);
  EXPECT_EQ(report.points + report.welded + report.nonfinite, row.pixels);
  EXPECT_EQ(report.triangles + report.segments, 0);
}

INSTANTIATE_TEST_SUITE_P(Readme, SharedClouds,
                         testing::Values(CloudRow{"scans/real/capture0001.pcd", 249647, 57553, 640 * 480},
                                         CloudRow{"scans/real/milk_cartoon_all_small_clorox.pcd", 241407, 65793, 640 * 480},
                                         CloudRow{"scans/real/room_scan1.pcd", 112586, 0, 112586},
                                         CloudRow{"scans/real/table_scene_mug_stereo_textured.pcd", 209280, 97920, 640 * 480}));

TEST(SharedClouds, aKinectFrameIsJoinedOnItsGrid) {
  SKIP_WITHOUT_SHARED_DATA("scans/real/capture0001.pcd");
  CloudOptions options;
  options.as = CloudOptions::As::MESH;
  const LoadedSurface surface = loadSurface(*sharedData("scans/real/capture0001.pcd"), Vector3::Ones(), options);
  EXPECT_EQ(surface.report.nonfinite, 57553);
  EXPECT_GT(surface.report.triangles, 400000);
  EXPECT_EQ(surface.report.nonmanifold_edges, 0);
  for (const Vector3i& e : surface.mesh->elements)
    for (int k = 0; k < 3; ++k) ASSERT_LE((surface.mesh->vertices[e[k]] - surface.mesh->vertices[e[(k + 1) % 3]]).norm(), options.max_edge);
}

}  // namespace
}  // namespace blem_sim::model
