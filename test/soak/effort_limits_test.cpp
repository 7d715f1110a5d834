// Motors at the end of their strength: a robot that collapses, fingers of absurd stiffness, a light foot under a heavy body.
#include <gtest/gtest.h>

#include "soak/figures.h"
#include "soak/hubo_stand.h"
#include "soak/world_figures.h"

namespace blem_sim {
namespace {

/** Motor efforts against their caps. */
struct Saturation {
  void observe(const dynamics::World& world, const std::vector<dynamics::JointDrive>& drives, const dynamics::SolveResult& result) {
    for (int j = 0; j < world.jointCount(); ++j) {
      const dynamics::JointDrive& drive = drives[j];
      if (std::isinf(drive.max_effort)) continue;
      const double over = std::abs(result.motor_efforts[j]) - drive.max_effort;
      worst = std::max(worst, over / drive.max_effort);
      saturated += over > -1e-9 * drive.max_effort;
    }
  }
  double worst = -INFINITY;  ///< over the cap, of the cap
  long saturated = 0;        ///< joint-steps at the cap
};

void expectWithinCaps(const std::string& name, HuboStand* hubo, int steps) {
  Saturation saturation;
  StepTimes times;
  double gap = 0, fastest = 0;
  std::size_t contacts = 0;
  for (int i = 0; i < steps; ++i) {
    hubo->prepare();
    times.start();
    const dynamics::SolveResult& result = hubo->solve();
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    saturation.observe(hubo->world(), hubo->drives(), result);
    gap = std::max(gap, worstJointGap(hubo->world()));
    fastest = std::max(fastest, rmsJointSpeed(hubo->world()));
    contacts = std::max(contacts, hubo->contacts().size());
  }
  figure(name + ": effort over its cap, relative", saturation.worst, "");
  figure(name + ": joint-steps at the cap", static_cast<double>(saturation.saturated), "");
  figure(name + ": joint gap", gap, "m");
  figure(name + ": most contacts", static_cast<double>(contacts), "");
  figure(name + ": fastest rms joint speed", fastest, "rad/s");
  figure(name + ": rms joint speed at the end", rmsJointSpeed(hubo->world()), "rad/s");
  times.print(name);
  EXPECT_LE(saturation.worst, 1e-9);
}

HuboOptions collapsing(bool joint_friction) {
  HuboOptions options;
  options.settings = soakSettings();
  options.effort_scale = 0.1;
  options.link_corners = true;
  options.sole_contacts = 8;
  options.joint_friction = joint_friction;
  options.margin = 0.01;
  return options;
}

TEST(EffortLimits, HuboCollapsesAtATenth) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboStand hubo(collapsing(true));
  expectWithinCaps("collapse", &hubo, soakSteps(10, 2));
  EXPECT_LT(hubo.world().bodyState(hubo.bodies()[0]).X_WB.translation().z(), 0.6) << "it did not collapse";
}

TEST(EffortLimits, HuboWithoutJointFrictionCollapsesAtATenth) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboStand hubo(collapsing(false));
  expectWithinCaps("collapse without joint friction", &hubo, soakSteps(10, 2));
}

TEST(EffortLimits, FingersOfAMillion) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboOptions options;
  options.settings = soakSettings();
  options.finger_stiffness = 1e6;
  HuboStand hubo(options);
  // A third of a radian off in one step: every finger runs into its cap.
  for (int j = 0; j < hubo.world().jointCount(); ++j) {
    const dynamics::JointSpec& spec = hubo.world().jointSpec(j);
    if (spec.name.find("::left") == std::string::npos && spec.name.find("::right") == std::string::npos) continue;
    hubo.motors()[j].hold(spec.upper > 0.5 ? 0.3 : -0.3);
  }
  expectWithinCaps("finger kp 1e6", &hubo, soakSteps(10, 2));
}

/** 40 kg on a foot of 20 g, by an ankle and a knee of 20 g; the motors are too weak for the push that comes. */
struct HeavyOnLight {
  explicit HeavyOnLight(const dynamics::SolverSettings& settings) : world(Vector3(0, 0, -9.81), settings) {
    const int foot = world.addBody(dynamics::boxBody("foot", 0.02, FOOT, {0, 0, FOOT.z() / 2}));
    const int shin = addLink(foot, dynamics::boxBody("shin", 0.02, {0.05, 0.05, 0.4}, {0, 0, 0.04}), 0.2);
    body = addLink(shin, dynamics::boxBody("body", 40, TORSO, {0, 0, 0.44}), 0.2);
  }
  /** Adds a link whose frame is the joint's, its centre of mass above it. */
  int addLink(int parent, dynamics::BodySpec spec, double com_height) {
    spec.inertial.com = {0, 0, com_height};
    const int link = world.addBody(spec);
    dynamics::JointSpec joint;
    joint.name = spec.name;
    joint.parent = parent, joint.child = link;
    joint.X_PJ = world.bodySpec(parent).X_WB.inverse() * spec.X_WB;
    joint.axis = Vector3::UnitY();
    world.addJoint(joint);
    dynamics::JointDrive drive;
    drive.stiffness = 4000, drive.damping = 100, drive.max_effort = 60;
    drives.push_back(drive);
    return link;
  }
  const dynamics::SolveResult& step() {
    contacts.clear();
    dynamics::boxOnPlane(world, 0, FOOT, Vector3::UnitZ(), 0, {}, &contacts, 0.01);
    for (int i = 0; i < 8; ++i) {
      const Vector3 p = world.bodyState(body).X_WB * (dynamics::corner(TORSO, i) + Vector3(0, 0, 0.2));
      if (p.z() < 0.01) contacts.push_back(dynamics::contactOf(body, dynamics::WORLD_BODY, p, Vector3::UnitZ(), -p.z(), {}, 1000 + i));
    }
    return world.step(1e-3, contacts, drives);
  }
  const Vector3 FOOT{0.2, 0.15, 0.02}, TORSO{0.3, 0.3, 0.4};
  dynamics::World world;
  int body;
  std::vector<dynamics::JointDrive> drives;
  std::vector<dynamics::ContactConstraint> contacts;
};

TEST(EffortLimits, TwentyGramsUnderFortyKilograms) {
  HeavyOnLight robot(soakSettings());
  Saturation saturation;
  StepTimes times;
  double rest_speed = 0, rest_force = 0, gap = 0;
  const int steps = soakSteps(20, 4);
  for (int i = 0; i < steps; ++i) {
    if (i == steps / 2) {
      rest_speed = rmsJointSpeed(robot.world);
      robot.world.applyWrench(robot.body, {{60000, 0, 0}, Vector3::Zero()}, bodyCom(robot.world, robot.body));  // 60 N s in one step
    }
    times.start();
    const dynamics::SolveResult& result = robot.step();
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    saturation.observe(robot.world, robot.drives, result);
    gap = std::max(gap, worstJointGap(robot.world));
    if (i != steps / 2 - 1) continue;
    for (const Vector3& f : result.contact_forces) rest_force += f.z();
  }
  figure("20 g under 40 kg: effort over its cap, relative", saturation.worst, "");
  figure("20 g under 40 kg: joint-steps at the cap", static_cast<double>(saturation.saturated), "");
  figure("20 g under 40 kg: joint gap", gap, "m");
  figure("20 g under 40 kg: rms joint speed before the push", rest_speed, "rad/s");
  figure("20 g under 40 kg: ground force over m g before the push, less 1", rest_force / (40.04 * 9.81) - 1, "");
  times.print("20 g under 40 kg");
  EXPECT_LE(saturation.worst, 1e-9);
  EXPECT_GT(saturation.saturated, 0);
}

}  // namespace
}  // namespace blem_sim
