#include "blem_sim/sim/drawing.h"

#include <gtest/gtest.h>

#include <vector>

namespace blem_sim::sim {
namespace {

Colour colourOf(double of_layer, bool pierced) {
  ContactReport contact{};
  contact.of_layer = of_layer;
  contact.pierced = pierced;
  return contactColour(contact);
}

bool isAlarm(const Colour& colour) { return colour.r == 1 && colour.g == 0; }

TEST(Drawing, BeyondTheLayerIsTheAlarmColourAndNothingElse) {
  for (const double of_layer : {0.0, 0.3, 0.999, 1.0}) EXPECT_FALSE(isAlarm(colourOf(of_layer, false))) << of_layer;
  for (const double of_layer : {1.001, 1.5, 20.0}) EXPECT_TRUE(isAlarm(colourOf(of_layer, false))) << of_layer;
  EXPECT_TRUE(isAlarm(colourOf(0, true)));
}

TEST(Drawing, GreenTurnsYellowAsTheLayerIsUsedUp) {
  float red = -1;
  for (const double of_layer : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Colour colour = colourOf(of_layer, false);
    EXPECT_GT(colour.r, red);
    EXPECT_GT(colour.g, 0.7F);
    red = colour.r;
  }
}

TEST(Drawing, PointsTurnFromBlueOverGreenToYellowAsTheyRise) {
  std::vector<Vector3> points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(0.3 * i, -2, 5 + 0.01 * i);
  points.emplace_back(0, 0, 1000);  // one outlier changes nothing
  const std::vector<Colour> colours = coloursByHeight(points, Vector3::UnitZ());
  ASSERT_EQ(colours.size(), points.size());
  EXPECT_GT(colours[0].b, 2 * colours[0].r);
  EXPECT_GT(colours[50].g, colours[50].r);
  EXPECT_GT(colours[50].g, colours[50].b);
  EXPECT_GT(colours[100].r, 2 * colours[100].b);
  for (int i = 0; i < 100; ++i) EXPECT_LE(colours[i].r, colours[i + 1].r) << i;
  EXPECT_EQ(colours[101].r, colours[100].r);
  // The other way up, the first are the highest.
  EXPECT_EQ(coloursByHeight(points, -Vector3::UnitZ())[0].r, colours[100].r);
}

TEST(Drawing, PointsOfOneHeightAndNoneHaveColoursToo) {
  EXPECT_EQ(coloursByHeight({Vector3(0, 0, 1), Vector3(5, 0, 1)}, Vector3::UnitZ()).size(), 2u);
  EXPECT_TRUE(coloursByHeight({}, Vector3::UnitZ()).empty());
}

}  // namespace
}  // namespace blem_sim::sim
