// A mesh cube on a slope in eight directions, on two triangles and on triangles of 1 mm: both must be Coulomb's law.
#include <gtest/gtest.h>

#include "sim/simulation_scene.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

struct Slope {
  const char* name;
  double cell;  ///< [m] of the ground's grid, 0 = two triangles
  double seconds;
};

/** The ground stays level; gravity is tilted. Friction 0.5 slips at 26.565 degrees. */
class SlidingCube {
 public:
  SlidingCube(const Slope& slope, double degrees, int direction) : angle_(degrees * M_PI / 180), heading_(direction * M_PI / 8) {
    sim::SimulationConfig config;
    config.solver = soakSettings();
    const double size = slope.cell > 0 ? 0.5 : 40;
    sim::EnvironmentConfig plane;
    plane.name = "plane";
    const int cells = slope.cell > 0 ? static_cast<int>(size / slope.cell) : 1;
    plane.uri = sim::meshFile(std::string("slope_") + slope.name, geometry::gridMesh(size, size, cells, cells));
    config.environments = {plane};
    config.gravity = sim::G * (std::sin(angle_) * down() - std::cos(angle_) * Vector3::UnitZ());
    config.objects = {sim::box("cube", Vector3::Constant(0.1), 1, {-0.1 * down().x(), -0.1 * down().y(), 0.0525})};
    simulator_ = std::make_unique<sim::Simulator>(config, model::UriResolver());
  }
  void run(double seconds) { sim::stepFor(simulator_.get(), seconds); }
  Vector3 down() const { return {std::cos(heading_), std::sin(heading_), 0}; }
  Vector3 velocity() const { return sim::bodyOf(*simulator_, "cube").v_WCom; }
  double theory() const { return sim::G * (std::sin(angle_) - 0.5 * std::cos(angle_)); }

 private:
  double angle_, heading_;  // [rad]
  std::unique_ptr<sim::Simulator> simulator_;
};

class SoakMeshSlope : public ::testing::TestWithParam<Slope> {};

TEST_P(SoakMeshSlope, HoldsBelowTheFrictionAngle) {
  double creep = 0;
  for (int direction = 0; direction < 8; ++direction) {
    SlidingCube cube(GetParam(), 26.4, direction);
    cube.run(GetParam().seconds);
    creep = std::max(creep, cube.velocity().norm());
  }
  figure(std::string(GetParam().name) + " 26.4 deg: creep", creep, "m/s");
  EXPECT_LT(creep, 1e-9);
}

TEST_P(SoakMeshSlope, SlidesStraightDownAboveIt) {
  for (const double degrees : {26.7, 27.0, 28.0, 30.0, 35.0}) {
    double worst = 0, sideways = 0;
    for (int direction = 0; direction < 8; ++direction) {
      SlidingCube cube(GetParam(), degrees, direction);
      cube.run(0.05);
      const Vector3 before = cube.velocity();
      const double seconds = std::min(GetParam().seconds, std::sqrt(0.2 / cube.theory()));
      const double steps = std::round(1000 * seconds);
      cube.run(1e-3 * steps);
      const Vector3 acceleration = (cube.velocity() - before) / (1e-3 * steps);
      worst = std::max(worst, std::abs(acceleration.dot(cube.down()) / cube.theory() - 1));
      sideways = std::max(sideways, acceleration.cross(cube.down()).norm() / cube.theory());
    }
    const std::string name = std::string(GetParam().name) + " " + std::to_string(degrees).substr(0, 4) + " deg";
    figure(name + ": acceleration off", worst, "");
    figure(name + ": sideways", sideways, "");
    EXPECT_LT(worst, 1e-4);
    EXPECT_LT(sideways, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Grounds, SoakMeshSlope, ::testing::Values(Slope{"coarse", 0, 5}, Slope{"fine", 0.001, 0.5}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace blem_sim
