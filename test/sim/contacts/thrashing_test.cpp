// A quadruped whose motors throw its legs about: every step is solved, and its feet push as much as it moves.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "geometry/random_shapes.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double QUADRUPED_MASS = 34, THRASHING_STEP = 0.005;  // [kg], [s]

std::string linkText(const std::string& name, double mass, double inertia, double middle, const std::string& more = "") {
  return fmt::format(R"(<link name="{0}"><inertial><origin xyz="0 0 {3}"/><mass value="{1}"/>)"
                     R"(<inertia ixx="{2}" iyy="{2}" izz="{2}" ixy="0" ixz="0" iyz="0"/></inertial>{4}</link>)",
                     name, mass, inertia, middle, more);
}

std::string hingeText(const std::string& parent, const std::string& child, const std::string& place, const std::string& axis) {
  return fmt::format(R"(<joint name="of_{1}" type="revolute"><parent link="{0}"/><child link="{1}"/><origin xyz="{2}"/>)"
                     R"(<axis xyz="{3}"/><limit lower="-2.5" upper="2.5" effort="40" velocity="7.5"/></joint>)",
                     parent, child, place, axis);
}

/** A torso of 20 kg on four legs of three hinges and 3.5 kg, their feet balls. */
std::string quadrupedUrdf() {
  std::string urdf = "<robot name=\"quadruped\">" + linkText("torso", 20, 0.4, 0);
  for (int leg = 0; leg < 4; ++leg) {
    const std::string n = std::to_string(leg);
    urdf += linkText("hip" + n, 1, 0.003, 0) + linkText("thigh" + n, 2, 0.02, -0.13) +
            linkText("shank" + n, 0.5, 0.005, -0.13,
                     R"(<collision><origin xyz="0 0 -0.3"/><geometry><sphere radius="0.03"/></geometry></collision>)") +
            hingeText("torso", "hip" + n, fmt::format("{} {} 0", leg % 2 ? 0.3 : -0.3, leg < 2 ? 0.15 : -0.15), "1 0 0") +
            hingeText("hip" + n, "thigh" + n, "0 0 0", "0 1 0") + hingeText("thigh" + n, "shank" + n, "0 0 -0.3", "0 1 0");
  }
  return urdf + "</robot>";
}

SimulationConfig thrown() {
  SimulationConfig config;
  config.time_step = THRASHING_STEP;
  config.contact.surface.friction = 0.8;
  config.environments.resize(1);
  config.environments[0].name = "ground";
  config.environments[0].plane = Eigen::Vector4d(0, 0, 1, 0);
  config.robots = {robot("quadruped", quadrupedUrdf(), false)};
  config.robots[0].motors = MotorDefault::COMPUTED;
  config.robots[0].X_WR = makePose({0, 0, 0.6});
  for (int leg = 0; leg < 4; ++leg) {
    config.robots[0].initial_positions["of_thigh" + std::to_string(leg)] = 0.5;
    config.robots[0].initial_positions["of_shank" + std::to_string(leg)] = -1;
  }
  return config;
}

/** [N s] */
Vector3 momentum(const Simulator& simulator) {
  Vector3 sum = Vector3::Zero();
  for (const int body : simulator.models()[simulator.modelIndex("quadruped")].bodies)
    sum += simulator.world().bodySpec(body).inertial.mass * simulator.report().bodies[body].v_WCom;
  return sum;
}

/** Motors are led to places at random about those where the robot stands. */
void throwLegs(geometry::RandomShapes* numbers, Simulator* simulator) {
  JointCommandMessage command;
  command.joints = simulator->robots()[0].joint_names;
  const std::map<std::string, double>& stands = simulator->config().robots[0].initial_positions;
  for (const std::string& joint : command.joints) {
    const auto place = stands.find(joint);
    command.positions.push_back((place == stands.end() ? 0 : place->second) + numbers->uniform(-0.6, 0.6));
  }
  simulator->commandJoints(0, command);
}

TEST(Thrashing, AQuadrupedIsSolvedInEveryStep) {
  for (std::uint64_t seed = 0; seed < (SANITIZED ? 2 : 10); ++seed) {
    Simulator simulator(thrown(), model::UriResolver());
    geometry::RandomShapes numbers(seed);
    Vector3 before = Vector3::Zero();
    for (int i = 0; i < 200; ++i) {
      if (i % 20 == 0) throwLegs(&numbers, &simulator);
      const StepReport& report = simulator.step();
      EXPECT_EQ(report.status & SOLVER_TROUBLE, 0u) << seed << " " << i;
      const Vector3 after = momentum(simulator), impulse = THRASHING_STEP * (forceOfWorld(report) - QUADRUPED_MASS * G * Vector3::UnitZ());
      ASSERT_NEAR((after - before - impulse).norm(), 0, 1e-6) << seed << " " << i;
      before = after;
    }
  }
}

}  // namespace
}  // namespace blem_sim::sim
