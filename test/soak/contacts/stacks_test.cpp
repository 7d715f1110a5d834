// Stacks of mesh cubes, of any triangles, that stand for ten minutes [Hauser 2013, Fig. 1].
#include <gtest/gtest.h>

#include "geometry/random_shapes.h"
#include "sim/simulation_scene.h"
#include "soak/contacts/cube_meshes.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

constexpr double SIZE = 0.1, GAP = 0.01, SETTLING = 5;  // [m], [m], [s]

struct Stack {
  const char* name;
  int cubes;
  geometry::TriangleMesh (*mesh)(geometry::RandomShapes&);
  double layer, offset;    ///< [m]
  double off_theory, rms;  ///< [m], [m/s] allowed
};

sim::SimulationConfig configOf(const Stack& stack) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  config.environments = {sim::ground()};
  config.contact.boundary_width = stack.layer;
  geometry::RandomShapes random(3);
  for (int i = 0; i < stack.cubes; ++i) {
    const std::string name = "cube" + std::to_string(i);
    sim::ObjectConfig cube;
    cube.name = name;
    cube.uri = sim::meshFile(std::string("stack_") + stack.name + std::to_string(i), stack.mesh(random));
    cube.mass = 1;
    cube.com = Vector3::Zero();
    cube.inertia = Matrix3(Matrix3::Identity() * SIZE * SIZE / 6);
    cube.X_WO = makePose({random.uniform(-stack.offset, stack.offset), random.uniform(-stack.offset, stack.offset),
                          0.5 * SIZE + stack.layer + GAP + i * (SIZE + 2 * stack.layer + GAP)});
    config.objects.push_back(cube);
  }
  return config;
}

struct StackFigures {
  double height = 0, sideways = 0;  ///< [m] worst cube against theory, after settling
  double square_sum = 0;            ///< [m^2/s^2]
  long speeds = 0;
  Range contacts;

  void add(const sim::Simulator& simulator, const Stack& stack) {
    for (int i = 0; i < stack.cubes; ++i) {
      const dynamics::BodyState state = sim::bodyOf(simulator, "cube" + std::to_string(i));
      const Vector3 start = simulator.config().objects[i].X_WO.translation();
      const double z = 0.5 * SIZE + stack.layer + i * (SIZE + 2 * stack.layer);
      height = std::max(height, std::abs(state.X_WB.translation().z() - z));
      sideways = std::max(sideways, (state.X_WB.translation() - start).head<2>().norm());
      square_sum += state.v_WCom.squaredNorm();
      ++speeds;
    }
    contacts.add(simulator.report().reduced_contacts);
  }
};

class SoakStack : public ::testing::TestWithParam<Stack> {};

TEST_P(SoakStack, StandsTenMinutes) {
  const Stack& stack = GetParam();
  sim::Simulator simulator(configOf(stack), model::UriResolver());
  sim::stepFor(&simulator, SETTLING);
  StackFigures figures;
  StepTimes times;
  for (int k = 0; k < soakSteps(600 - SETTLING, 5); ++k) {
    times.start();
    const sim::StepReport& report = simulator.step();
    times.stop(report);
    ASSERT_FALSE(report.status & (sim::STATE_NOT_FINITE | sim::CONTACT_UNRELIABLE)) << k;
    figures.add(simulator, stack);
  }
  const double rms = std::sqrt(figures.square_sum / figures.speeds);
  figure("height off theory", 1e6 * figures.height, "um");
  figure("sideways", 1e6 * figures.sideways, "um");
  figure("rms velocity", rms, "m/s");
  figure("contacts, least", figures.contacts.low, "");
  figure("contacts, most", figures.contacts.high, "");
  times.print("stack");
  EXPECT_LT(figures.height, stack.off_theory);
  EXPECT_LT(figures.sideways, stack.off_theory);
  EXPECT_LT(rms, stack.rms);
  EXPECT_EQ(figures.contacts.width(), 0);
}

INSTANTIATE_TEST_SUITE_P(Cubes, SoakStack,
                         ::testing::Values(Stack{"three", 3, coarseCube, 0.0025, 0, 1e-5, 1e-6},
                                           Stack{"ten", 10, coarseCube, 0.0025, 0, 1e-5, 1e-6},
                                           Stack{"offsets", 10, coarseCube, 0.0025, 0.002, 1e-5, 1e-6},
                                           Stack{"retessellated", 10, retessellatedCube, 0.0025, 0.002, 1e-5, 1e-6},
                                           Stack{"thin_layers", 10, coarseCube, 0.001, 0.002, 1e-5, 1e-6},
                                           Stack{"cracked", 10, crackedCube, 0.0025, 0.002, 1e-4, 1e-5},
                                           Stack{"t_junctions", 10, tJunctionCube, 0.0025, 0.002, 1e-4, 1e-5}),
                         [](const auto& info) { return std::string(info.param.name); });

/** The data's heavyblocktest: 100 kg fall 34 cm on 1 kg. */
TEST(SoakHeavyBlock, RestsOnTop) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  config.environments = {sim::ground()};
  config.contact.surface.restitution = 0.2;
  config.objects = {sim::box("light", Vector3::Constant(0.1), 1, {0, 0, 0.06}),
                    sim::box("heavy", Vector3::Constant(0.4), 100, {0, 0, 0.65})};
  sim::Simulator simulator(config, model::UriResolver());
  double of_layer = 0;
  for (int k = 0; k < soakSteps(60, 5); ++k) of_layer = std::max(of_layer, simulator.step().max_of_layer);
  const dynamics::BodyState light = sim::bodyOf(simulator, "light"), heavy = sim::bodyOf(simulator, "heavy");
  const Vector3 light_off = light.X_WB.translation() - Vector3(0, 0, 0.0525), heavy_off = heavy.X_WB.translation() - Vector3(0, 0, 0.3075);
  figure("light block off theory", 1e6 * light_off.norm(), "um");
  figure("heavy block off theory", 1e6 * heavy_off.norm(), "um");
  figure("most of the layer used", of_layer, "");
  EXPECT_LT(light_off.norm(), 1e-4);
  EXPECT_LT(heavy_off.norm(), 1e-4);
  EXPECT_LT(heavy.v_WCom.norm(), 1e-6);
}

}  // namespace
}  // namespace blem_sim
