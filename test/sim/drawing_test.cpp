#include "blem_sim/sim/drawing.h"

#include <gtest/gtest.h>

namespace blem_sim {
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

}  // namespace
}  // namespace blem_sim
