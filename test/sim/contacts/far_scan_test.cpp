// Scans in a surveyor's coordinates, millions of metres from their origin.
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim {
namespace {

const Vector3 EASTING_NORTHING(400000, 5000000, 300);

/** Rolling ground of points 5 cm apart, as doubles. */
EnvironmentConfig scan(const std::string& name, const Vector3& offset) {
  constexpr int HALF = 30;
  EnvironmentConfig environment;
  environment.name = "scan";
  environment.cloud.as = CloudOptions::As::MESH;
  environment.cloud.max_edge = 0.2;
  environment.X_WE = makePose(-offset);
  environment.uri = sceneFile(name + ".pcd", [&](std::ofstream& out) {
    constexpr int SIDE = 2 * HALF + 1;
    out << std::setprecision(17) << "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << SIDE << "\nHEIGHT " << SIDE
        << "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << SIDE * SIDE << "\nDATA ascii\n";
    for (int i = -HALF; i <= HALF; ++i) {
      for (int j = -HALF; j <= HALF; ++j) {
        const Vector3 p = Vector3(0.0625 * j, 0.0625 * i, std::round(1024 * 0.05 * std::sin(0.4 * i) * std::cos(0.3 * j)) / 1024) + offset;
        out << p.x() << " " << p.y() << " " << p.z() << "\n";
      }
    }
  });
  return environment;
}

SimulationConfig scanScene(const std::string& name, const Vector3& offset) {
  SimulationConfig config;
  config.environments = {scan(name, offset)};
  config.objects = {box("cube", Vector3::Constant(0.2), 1, {0.03, 0.04, 0.2})};
  config.objects[0].linear_velocity = {0.5, 0.2, 0};
  return config;
}

// Places in the files are multiples of 2^-10 m, which doubles hold there as here.
TEST(FarScan, IsSimulatedAsOneAtTheOrigin) {
  Simulator near(scanScene("near", Vector3::Zero()), UriResolver()), far(scanScene("far", EASTING_NORTHING), UriResolver());
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
  SimulationConfig config = scanScene("far", EASTING_NORTHING);
  config.environments[0].X_WE = Pose::Identity();
  config.objects[0].X_WO = makePose(EASTING_NORTHING + config.objects[0].X_WO.translation());
  config.objects[0].linear_velocity = Vector3::Zero();
  Simulator simulator(config, UriResolver());
  Simulator near(
      [] {
        SimulationConfig here = scanScene("near", Vector3::Zero());
        here.objects[0].linear_velocity = Vector3::Zero();
        return here;
      }(),
      UriResolver());
  stepFor(&simulator, 0.5);
  stepFor(&near, 0.5);
  EXPECT_LT((bodyOf(simulator, "cube").X_WB.translation() - EASTING_NORTHING - bodyOf(near, "cube").X_WB.translation()).norm(), 1e-4);
}

}  // namespace
}  // namespace blem_sim
