// The Hubo on its soles: forces, joints and rest of a long stand, its step against world_step's, and the sway.
#include <gtest/gtest.h>

#include "soak/figures.h"
#include "soak/hubo_stand.h"
#include "soak/world_figures.h"

namespace blem_sim {
namespace {

HuboOptions standing(bool compliant) {
  HuboOptions options;
  options.settings = soakSettings();
  options.compliant = compliant;
  return options;
}

class Standing : public ::testing::TestWithParam<bool> {
 protected:
  std::string name(const std::string& what) const { return std::string(GetParam() ? "stand compliant: " : "stand rigid: ") + what; }
};

TEST_P(Standing, SixtySeconds) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboStand hubo(standing(GetParam()));
  ASSERT_EQ(hubo.world().jointCount(), 57);
  const int steps = soakSteps(60, 5), watched = steps / 4;
  Range force, foot;
  double squares = 0, gap = 0, tilt = 0;
  int lcp_errors = 0;
  StepTimes times;
  for (int i = 0; i < steps; ++i) {
    hubo.prepare();
    times.start();
    const dynamics::SolveResult& result = hubo.solve();
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    lcp_errors += result.lcp_errors;
    gap = std::max(gap, worstJointGap(hubo.world()));
    tilt = std::max(tilt, worstJointTilt(hubo.world()));
    if (i < steps - watched) continue;
    ASSERT_EQ(hubo.contacts().size(), 50u) << i;
    force.add(hubo.groundForce(result));
    foot.add(hubo.groundForce(result, hubo.leftFoot()));
    squares += std::pow(rmsJointSpeed(hubo.world()), 2);
  }
  const double off = std::max(force.high / hubo.weight() - 1, 1 - force.low / hubo.weight()), speed = std::sqrt(squares / watched);
  figure(name("ground force over m g, less 1"), off, "");
  figure(name("ripple"), force.width(), "N");
  figure(name("ripple of one foot"), foot.width(), "N");
  figure(name("rms joint speed"), speed, "rad/s");
  figure(name("joint gap"), gap, "m");
  figure(name("joint axes"), tilt, "rad");
  figure(name("lcp errors"), lcp_errors, "");
  times.print(name("50 contacts"));
  EXPECT_LE(off, 1e-8);
  EXPECT_LT(force.width(), 1e-5);
  EXPECT_LT(foot.width(), 1e-5);
  EXPECT_LT(speed, 1e-9);
  EXPECT_LE(gap, 1e-12);
  EXPECT_LE(tilt, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Feet, Standing, ::testing::Bool(), [](const auto& info) { return info.param ? "Compliant" : "Rigid"; });

// One step from the same state, every contact sticking; world_step as hard as it can be made.
TEST(StandingAgainstWorldStep, OneStep) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboOptions options = standing(true);
  HuboStand tested(options);
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(tested.step().finite);
  options.settings.stepper = "world_step";
  options.settings.cfm = 1e-10;
  HuboStand reference(options);
  reference.copyState(tested);
  const dynamics::SolveResult result = tested.step(), reference_result = reference.step();
  ASSERT_TRUE(result.finite && reference_result.finite);
  ASSERT_EQ(tested.contacts().size(), reference.contacts().size());
  Vector3 force = Vector3::Zero(), reference_force = Vector3::Zero();
  for (const Vector3& f : result.contact_forces) force += f;
  for (const Vector3& f : reference_result.contact_forces) reference_force += f;
  double speed = 0;
  std::string worst;
  for (int j = 0; j < 57; ++j) {
    const double off = std::abs(tested.world().jointState(j).velocity - reference.world().jointState(j).velocity);
    if (off > speed) worst = tested.world().jointSpec(j).name;
    speed = std::max(speed, off);
  }
  figure("against world_step: joint speeds", speed, "rad/s");
  figure("against world_step: force sum, relative", (force - reference_force).norm() / reference_force.norm(), "");
  EXPECT_LE(speed, 1e-6) << worst;
  EXPECT_LE((force - reference_force).norm(), 1e-3 * reference_force.norm());
}

TEST(Sway, StaysFiniteWithItsJointsClosed) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_SWAY);
  HuboOptions options = standing(false);
  options.start_at = HUBO_SWAY;
  HuboStand hubo(options);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(hubo.step().finite);
  const int steps = soakShort() ? 1000 : static_cast<int>(1000 * (hubo.follow(HUBO_SWAY) + 1.5));
  if (soakShort()) hubo.follow(HUBO_SWAY);
  StepTimes times;
  double gap = 0;
  for (int i = 0; i < steps; ++i) {
    hubo.prepare();
    times.start();
    const dynamics::SolveResult& result = hubo.solve();
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    gap = std::max(gap, worstJointGap(hubo.world()));
  }
  figure("sway: joint gap", gap, "m");
  figure("sway: torso height at the end", hubo.world().bodyState(hubo.bodies()[0]).X_WB.translation().z(), "m");
  times.print("sway");
  EXPECT_LE(gap, 1e-12);
}

}  // namespace
}  // namespace blem_sim
