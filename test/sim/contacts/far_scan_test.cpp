// Scans in a surveyor's coordinates, millions of metres from their origin.
#include <gtest/gtest.h>

#include "support/surveyed_scan.h"

namespace blem_sim::sim {
namespace {

SimulationConfig scanScene(const std::string& name, const Vector3& offset) { return cubesOnSurveyedScan(name, offset, 30, 1); }

TEST(FarScan, IsSimulatedAsOneAtTheOrigin) {
  Simulator near(scanScene("near", Vector3::Zero()), model::UriResolver()), far(scanScene("far", EASTING_NORTHING), model::UriResolver());
  for (int i = 0; i < 400; ++i) {
    near.step();
    far.step();
    ASSERT_EQ(near.report().raw_contacts, far.report().raw_contacts) << i;
  }
  EXPECT_GT(near.report().raw_contacts, 0);
  EXPECT_LT((bodyOf(near, "cube").X_WB.translation() - bodyOf(far, "cube").X_WB.translation()).norm(), 1e-9);
  EXPECT_LT(far.colliders()[0].geometry->bounds().center().norm(), 1);
  EXPECT_TRUE(far.loadReport()[0].extents.contains(EASTING_NORTHING));
  bool said = false;
  for (const std::string& note : far.loadReport()[0].notes) said = said || note.find("(400000, 5000000, 300) m") != std::string::npos;
  EXPECT_TRUE(said);
}

// Ground and robot both in those coordinates.
TEST(FarScan, CarriesWhatStandsThere) {
  SimulationConfig config = movedTo(EASTING_NORTHING, scanScene("far", EASTING_NORTHING));
  config.objects[0].linear_velocity = Vector3::Zero();
  Simulator simulator(config, model::UriResolver());
  Simulator near(
      [] {
        SimulationConfig here = scanScene("near", Vector3::Zero());
        here.objects[0].linear_velocity = Vector3::Zero();
        return here;
      }(),
      model::UriResolver());
  stepFor(&simulator, 0.5);
  stepFor(&near, 0.5);
  EXPECT_LT((bodyOf(simulator, "cube").X_WB.translation() - EASTING_NORTHING - bodyOf(near, "cube").X_WB.translation()).norm(), 1e-4);
}

}  // namespace
}  // namespace blem_sim::sim
