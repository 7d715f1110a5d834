// Environments that lie flush beside each other are as one.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

EnvironmentConfig piece(const std::string& name, const geometry::TriangleMesh& mesh, const Vector3& position = Vector3::Zero()) {
  EnvironmentConfig environment;
  environment.name = name;
  environment.uri = meshFile("piece_" + name, mesh);
  environment.X_WE = makePose(position);
  return environment;
}

/** A ground of 4 m x 1 m about the origin. */
std::vector<EnvironmentConfig> whole() { return {piece("whole", geometry::gridMesh(4, 1, 1, 1))}; }

struct Cut {
  const char* name;
  std::vector<EnvironmentConfig> pieces;
};

/** The same ground in pieces. */
std::vector<Cut> cuts() {
  const auto half = [](double x, double height) {
    return geometry::transformed(geometry::boxMesh({2, 1, height}), makePose({x, 0, -height / 2}));
  };
  // A seam along a line askew.
  geometry::TriangleMesh left, right;
  left.vertices = {{-2, -0.5, 0}, {-0.1, -0.5, 0}, {0.1, 0.5, 0}, {-2, 0.5, 0}};
  right.vertices = {{-0.1, -0.5, 0}, {2, -0.5, 0}, {2, 0.5, 0}, {0.1, 0.5, 0}};
  left.elements = right.elements = {{0, 1, 2}, {0, 2, 3}};
  geometry::TriangleMesh strip = geometry::gridMesh(0.03, 1, 1, 4);
  return {{"two sheets",
           {piece("sheet_a", geometry::gridMesh(2, 1, 1, 1), {-1, 0, 0}), piece("sheet_b", geometry::gridMesh(2, 1, 3, 4), {1, 0, 0})}},
          {"two boxes", {piece("box_a", half(-1, 0.1)), piece("box_b", half(1, 0.2))}},
          {"askew", {piece("left", left), piece("right", right)}},
          {"overlapping",
           {piece("sheet_c", geometry::gridMesh(2.02, 1, 1, 1), {-1, 0, 0}), piece("sheet_d", geometry::gridMesh(2, 1, 1, 1), {1, 0, 0})}},
          {"a strip between",
           {piece("sheet_e", geometry::gridMesh(1.985, 1, 1, 1), {-1.0075, 0, 0}), piece("strip", strip),
            piece("sheet_f", geometry::gridMesh(1.985, 1, 1, 1), {1.0075, 0, 0})}}};
}

struct Slide {
  double speed, yaw, friction, dt;
  bool soft;
};

std::vector<dynamics::BodyState> slide(const std::vector<EnvironmentConfig>& ground, const Slide& how) {
  SimulationConfig config;
  config.time_step = how.dt;
  config.environments = ground;
  config.contact.surface.friction = how.friction;
  if (how.soft) config.contact.surface.stiffness = 2e4, config.contact.surface.damping = 200;
  config.objects = {box("cube", Vector3::Constant(0.1), 1, Vector3::Zero())};
  config.objects[0].X_WO = makePose({-0.15, 0.013, 0.0525}, {0, 0, how.yaw});
  config.objects[0].linear_velocity = {how.speed, 0, 0};
  Simulator simulator(config, model::UriResolver());
  std::vector<dynamics::BodyState> states;
  for (double t = 0; t < std::min(0.3, 0.4 / how.speed); t += how.dt) {
    simulator.step();
    states.push_back(bodyOf(simulator, "cube"));
  }
  return states;
}

TEST(Seams, CubeSlidesAsOverOneMesh) {
  const std::vector<Slide> slides = {{1, 0, 0.5, 0.001, false},   {1, 0, 0, 0.001, false},   {3, 0, 0.5, 0.001, false},
                                     {3, 0.3, 0.5, 0.001, false}, {3, 0.3, 0, 0.005, false}, {10, 0, 0.2, 0.001, false},
                                     {10, 0.5, 0, 0.001, false},  {3, 0, 0, 0.001, true},    {3, 0.3, 0.5, 0.001, true}};
  for (std::size_t k = SANITIZED ? 2 : 0; k < slides.size(); k += SANITIZED ? 3 : 1) {
    const Slide& how = slides[k];
    const std::vector<dynamics::BodyState> expected = slide(whole(), how);
    for (const Cut& cut : cuts()) {
      const std::vector<dynamics::BodyState> states = slide(cut.pieces, how);
      double place = 0, velocity = 0;
      for (std::size_t i = 0; i < states.size(); ++i) {
        place = std::max(place, (states[i].X_WB.translation() - expected[i].X_WB.translation()).norm());
        velocity = std::max(velocity, (states[i].v_WCom - expected[i].v_WCom).norm());
        velocity = std::max(velocity, 0.1 * (states[i].w_WB - expected[i].w_WB).norm());
      }
      EXPECT_LT(place, 1e-6) << cut.name << ", " << how.speed << " m/s, yaw " << how.yaw << ", mu " << how.friction << ", soft "
                             << how.soft;
      EXPECT_LT(velocity, 1e-6) << cut.name << ", " << how.speed << " m/s, yaw " << how.yaw << ", mu " << how.friction << ", soft "
                                << how.soft;
    }
  }
}

}  // namespace
}  // namespace blem_sim::sim
