// Things that are wider than the gap between jaws which cannot open: the jaws push as their motor does, not as their stops could.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"
#include "support/shared_packages.h"

namespace blem_sim::sim {
namespace {

constexpr double PUSH = 10;       // [N] of the motor that closes both jaws, one of which mimics the other
constexpr double BETWEEN = 0.01;  // [m] between the layers of the jaws, which are 2.5 mm thick as the plate's are

/** Two jaws on sliders that stand at their stops, 0.02 m apart. */
std::string jawsUrdf() {
  const auto jaw = [](const char* name, double x) {
    return fmt::format(
        R"(<link name="{0}"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/>)"
        R"(</inertial><collision><origin xyz="{1} 0 0"/><geometry><box size="0.02 0.06 0.06"/></geometry></collision></link>)",
        name, x);
  };
  const auto slider = [](const char* name, const char* jaw, int axis, const char* mimic) {
    return fmt::format(R"(<joint name="{}" type="prismatic"><parent link="base"/><child link="{}"/><axis xyz="{} 0 0"/>)"
                       R"(<limit lower="0" upper="0.05" effort="50" velocity="1"/>{}</joint>)",
                       name, jaw, axis, mimic);
  };
  return R"(<robot name="jaws"><link name="base"/>)" + jaw("left", -0.02) + jaw("right", 0.02) + slider("close", "left", 1, "") +
         slider("follow", "right", -1, R"(<mimic joint="close"/>)") + "</robot>";
}

/** A plate between the jaws. @param turn [rad] by which it stands askew about two axes */
SimulationConfig heldPlate(double too_wide, const Vector3& turn) {
  SimulationConfig config;
  config.gravity.setZero();
  config.robots = {robot("jaws", jawsUrdf(), true)};
  config.robots[0].gains["default"] = {PUSH / 0.05, 0, 5, 0};
  ObjectConfig plate = box("plate", Vector3(BETWEEN + too_wide, 0.1, 0.1), 0.2, Vector3::Zero());
  plate.X_WO = makePose(Vector3::Zero(), turn);
  config.objects = {plate};
  return config;
}

double pushOf(const Simulator& simulator, const std::string& jaw) {
  double push = 0;
  for (const ContactReport& contact : simulator.report().contacts)
    if (simulator.bodyName(contact.body_a) == jaw || simulator.bodyName(contact.body_b) == jaw) push += std::abs(contact.force.x());
  return push;
}

// Contacts that correct their depth meet the stops, which let nothing give way.
TEST(Squeeze, JawsAtTheirStopsPushAsTheirMotorDoes) {
  for (const Vector3& turn : {Vector3(0, 0, 0), Vector3(0, 0.001, 0.002), Vector3(0, 0.003, 0.005)}) {
    for (const double too_wide : {2e-4, 4e-4}) {
      Simulator simulator(heldPlate(too_wide, turn), model::UriResolver());
      simulator.commandJoints(0, {{"close"}, {0.05}, {}, {}});
      stepFor(&simulator, 0.05);
      for (int i = 0; i < (SANITIZED ? 50 : 200); ++i) {
        const StepReport& report = simulator.step();
        EXPECT_EQ(report.status & ~static_cast<std::uint32_t>(JOINT_LIMIT_HIT), STEP_OK);
        for (const char* jaw : {"jaws::left", "jaws::right"})
          ASSERT_NEAR(pushOf(simulator, jaw), 0.5 * PUSH, 1e-3 * PUSH) << too_wide << " m too wide, turned by " << turn.transpose();
      }
    }
  }
}

// Contacts of many depths: those that had let others push in their place give up as well. Whether the plate leaves while the motor pushes
// depends on nanometres; once it lets go, nothing holds the plate.
TEST(Squeeze, ARobotiqGripperLetsGoOfAPlateInItsKnuckles) {
  const auto file = sharedData("robots/robotiq_arg85_description/robots/robotiq_arg85_description.urdf");
  if (!file) GTEST_SKIP() << "shared data not found";
  SimulationConfig config;
  config.gravity.setZero();
  config.robots = {robot("gripper", "", true)};
  config.robots[0].urdf = *file;
  config.robots[0].gains["default"] = {20, 0, 1, 0};
  ObjectConfig plate = box("plate", Vector3(0.004, 0.1, 0.15), 0.2, Vector3(0, 0, 0.145));
  config.objects = {plate};
  config.contact.surface.friction = 0.5;
  Simulator simulator(config, model::UriResolver(sharedPackages()));
  simulator.commandJoints(0, {{"finger_joint"}, {0.7}, {}, {}});
  double hardest = 0;
  // Nearly as hard after 40 steps: 849 N, 874 N after 150.
  for (int i = 0; i < (SANITIZED ? 40 : 150); ++i) {
    for (const ContactReport& contact : simulator.step().contacts) hardest = std::max(hardest, contact.force.norm());
  }
  // 14 N m at a lever of 1 mm between a knuckle's hinge and the plate.
  EXPECT_LT(hardest, 14 / 0.001);
  simulator.commandJoints(0, {{"finger_joint"}, {0}, {}, {}});
  stepFor(&simulator, 0.4);
  for (const ContactReport& contact : simulator.report().contacts) EXPECT_LT(contact.of_layer, 1) << "the plate has left";
}

}  // namespace
}  // namespace blem_sim::sim
