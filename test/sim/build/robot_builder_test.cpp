#include <algorithm>
#include <cmath>
#include <functional>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

/** A torso with an arm of two links, a gripper whose second finger mimics the first, a rigid camera, and a ball that floats off. */
const char* const ROBOT = R"(<robot name="worker">
  <link name="torso"><inertial><mass value="10"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.2 0.2 0.4"/></geometry></collision></link>
  <link name="camera"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.03"/></geometry></collision></link>
  <link name="upper"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 -0.15"/><geometry><box size="0.05 0.05 0.3"/></geometry></collision></link>
  <link name="finger1"><inertial><mass value="0.2"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="finger2"><inertial><mass value="0.2"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="balloon"><inertial><mass value="0.3"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="mount" type="fixed"><parent link="torso"/><child link="camera"/><origin xyz="0.1 0 0.3"/></joint>
  <joint name="finger_b" type="prismatic"><parent link="upper"/><child link="finger2"/><origin xyz="0 -0.02 -0.3"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="1"/><mimic joint="finger_a" multiplier="0.5" offset="0.01"/></joint>
  <joint name="shoulder" type="revolute"><parent link="torso"/><child link="upper"/><origin xyz="0 0.2 0.1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="50" velocity="5"/><dynamics friction="0.1" damping="0.2"/></joint>
  <joint name="finger_a" type="prismatic"><parent link="upper"/><child link="finger1"/><origin xyz="0 0.02 -0.3"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="1"/></joint>
  <joint name="string" type="floating"><parent link="torso"/><child link="balloon"/><origin xyz="0 0 1"/></joint>
</robot>)";

SimulationConfig scene(bool fixed_base = true) {
  SimulationConfig config;
  config.robots = {robot("worker", ROBOT, fixed_base)};
  config.robots[0].X_WR = makePose({1, 2, 3}, {0, 0, M_PI / 2});
  config.robots[0].gains["default"] = {500, 0, 20};
  return config;
}

int link(const Simulator& simulator, const std::string& name) { return simulator.robots()[0].description->linkIndex(name); }

bool mentions(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(RobotBuilder, TellsOfARootLinkWorldThatIsNotTheWorld) {
  const char* const post = R"(<robot name="post"><link name="world"/><link name="bar"><inertial><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
    <joint name="swing" type="continuous"><parent link="world"/><child link="bar"/><axis xyz="0 1 0"/></joint></robot>)";
  SimulationConfig config;
  config.robots = {robot("post", post, false)};
  const auto tells = [&](const std::string& words) { return mentions(Simulator(config, model::UriResolver()).notes(), words); };
  EXPECT_TRUE(tells("post: its root link 'world' moves freely"));
  config.robots[0].fixed_base = true;
  EXPECT_FALSE(tells("root link")) << "it is the world";
  config.robots[0].X_WR = makePose({0, 0, 0.2});
  EXPECT_TRUE(tells("post: its root link 'world' is the frame 'world'"));
  config.robots[0].tf_prefix = "left";
  EXPECT_FALSE(tells("root link")) << "a frame of its own";
}

TEST(RobotBuilder, StandsWhereItIsTold) {
  SimulationConfig config = scene();
  config.robots[0].initial_positions = {{"shoulder", 0.5}, {"finger_a", 0.02}};
  Simulator simulator(config, model::UriResolver());
  const RobotInfo& info = simulator.robots()[0];
  EXPECT_EQ(info.joint_names.size(), 3u);
  EXPECT_EQ(info.bodies[0], dynamics::WORLD_BODY);
  const Pose X_WT = config.robots[0].X_WR;
  EXPECT_TRUE(simulator.linkPose(0, link(simulator, "torso")).isApprox(X_WT, 1e-12));
  EXPECT_TRUE(simulator.linkPose(0, link(simulator, "camera")).isApprox(X_WT * makePose({0.1, 0, 0.3}), 1e-12));
  const Pose X_WU = X_WT * makePose({0, 0.2, 0.1}, {0, 0.5, 0});
  EXPECT_TRUE(simulator.linkPose(0, link(simulator, "upper")).isApprox(X_WU, 1e-12));
  EXPECT_TRUE(simulator.linkPose(0, link(simulator, "finger1")).isApprox(X_WU * makePose({0, 0.04, -0.3}), 1e-12));
  // Half of 0.02, and 0.01.
  EXPECT_TRUE(simulator.linkPose(0, link(simulator, "finger2")).isApprox(X_WU * makePose({0, -0.04, -0.3}), 1e-12));
  for (std::size_t j = 0; j < info.joints.size(); ++j)
    EXPECT_EQ(simulator.world().jointSpec(info.joints[j]).name, "worker::" + info.joint_names[j]);
}

TEST(RobotBuilder, HoldsAndTheMimicFollows) {
  Simulator simulator(scene(), model::UriResolver());
  simulator.commandJoints(0, {{"finger_a"}, {0.03}, {}, {}});
  stepFor(&simulator, 3);
  const RobotInfo& info = simulator.robots()[0];
  const auto position = [&](const std::string& joint) {
    const auto at = std::find(info.joint_names.begin(), info.joint_names.end(), joint) - info.joint_names.begin();
    return simulator.report().joints[info.joints[at]].position;
  };
  EXPECT_NEAR(position("finger_a"), 0.03, 1e-4);
  EXPECT_NEAR(position("finger_b"), 0.5 * position("finger_a") + 0.01, 1e-5);
  EXPECT_NEAR(position("shoulder"), 0, 1e-2);
  // The floating link is free: it falls.
  EXPECT_NEAR(simulator.linkPose(0, link(simulator, "balloon")).translation().z(), 3 + 1 - 0.5 * G * 9, 0.05);
}

TEST(RobotBuilder, MovesIntoLimitsWithANote) {
  SimulationConfig config = scene();
  config.robots[0].initial_positions = {{"shoulder", 2}};
  Simulator simulator(config, model::UriResolver());
  EXPECT_TRUE(mentions(simulator.notes(), "shoulder"));
  const RobotInfo& info = simulator.robots()[0];
  const auto shoulder = std::find(info.joint_names.begin(), info.joint_names.end(), "shoulder") - info.joint_names.begin();
  EXPECT_EQ(simulator.desiredState(0, static_cast<int>(shoulder)).position, 1);
  EXPECT_NEAR(simulator.report().joints[info.joints[shoulder]].position, 1, 1e-12);
}

TEST(RobotBuilder, ContactSettingsOfLinkBeatThoseOfRobotBeatTheDefault) {
  SimulationConfig config = scene();
  config.contact.surface.friction = 0.4;
  config.robots[0].contact.friction = 0.6;
  config.robots[0].contact.boundary_width = 0.004;
  config.robots[0].links["upper"].friction = 1.2;
  Simulator simulator(config, model::UriResolver());
  for (const contact::Collider& collider : simulator.colliders()) {
    EXPECT_EQ(collider.surface.friction, collider.name == "worker::upper" ? 1.2 : 0.6);
    EXPECT_EQ(collider.radius, collider.name == "worker::camera" ? 0.03 : 0.004) << collider.name;
  }
  ASSERT_EQ(simulator.loadReport().size(), 3u);
  EXPECT_EQ(simulator.loadReport()[0].name, "worker::torso");
  EXPECT_EQ(simulator.loadReport()[0].boundary_width, 0.004);
}

TEST(RobotBuilder, RefusesUnknownNamesWithTheNearest) {
  const auto refusal = [](const std::function<void(RobotConfig*)>& spoil) {
    SimulationConfig config = scene();
    spoil(&config.robots[0]);
    try {
      Simulator simulator(config, model::UriResolver());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  SensorConfig at_joint, at_link;
  at_joint.type = SensorType::FORCE_TORQUE;
  at_joint.joint = "sholder";
  at_link.type = SensorType::CONTACT;
  at_link.link = "upperr";
  const std::vector<std::pair<std::string, std::function<void(RobotConfig*)>>> cases = {
      {"'shoulder'", [](RobotConfig* r) { r->gains["shouldr"] = {}; }},
      {"'shoulder'", [](RobotConfig* r) { r->initial_positions["sshoulder"] = 0; }},
      {"'finger_a'", [](RobotConfig* r) { r->motor["finger_aa"] = MotorLaw::PID; }},
      {"'finger_a'", [](RobotConfig* r) { r->joint_friction["finger_a "] = {}; }},
      {"'finger_b'", [](RobotConfig* r) { r->effort_limits["finger_bb"] = 1; }},
      {"'finger_b'", [](RobotConfig* r) { r->armature["finger_bb"] = 1; }},
      {"'upper'", [](RobotConfig* r) { r->links["uper"] = {}; }},
      {"'camera'",
       [](RobotConfig* r) {
         r->disable_collisions = {{"torso", "camra"}};
       }},
      {"'shoulder'", [&](RobotConfig* r) { r->sensors = {at_joint}; }},
      {"'upper'", [&](RobotConfig* r) { r->sensors = {at_link}; }},
  };
  for (const auto& [nearest, spoil] : cases) {
    const std::string message = refusal(spoil);
    EXPECT_NE(message.find("worker"), std::string::npos) << message;
    EXPECT_NE(message.find(nearest), std::string::npos) << message;
  }
}

/** Colliders of the upper arm and the torso that touch when the shoulder is swung through it. */
std::size_t selfContacts(const std::function<void(RobotConfig*)>& change) {
  SimulationConfig config = scene();
  config.gravity = Vector3::Zero();
  // The camera's ball, grown, reaches the arm.
  change(&config.robots[0]);
  std::string& urdf = config.robots[0].urdf_xml;
  urdf.replace(urdf.find("radius=\"0.03\""), 13, "radius=\"0.30\"");
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  return simulator.report().contacts.size();
}

TEST(RobotBuilder, SelfCollisionOnlyWhereItIsAllowed) {
  EXPECT_EQ(selfContacts([](RobotConfig*) {}), 0u);
  // Torso and camera are one body with the arm's parent: neighbours.
  EXPECT_EQ(selfContacts([](RobotConfig* r) { r->self_collision = true; }), 0u);
  const auto free = [](RobotConfig* r) {
    r->self_collision = true;
    r->fixed_base = false;
  };
  EXPECT_EQ(selfContacts(free), 0u);
  // A mount that turns makes the camera two joints away from the arm.
  const auto apart = [](RobotConfig* r) {
    r->self_collision = true;
    std::string& urdf = r->urdf_xml;
    urdf.replace(urdf.find("\"mount\" type=\"fixed\""), 20, "\"mount\" type=\"continuous\"");
  };
  EXPECT_GT(selfContacts(apart), 0u);
  for (const char* link : {"upper", "camera"}) {
    EXPECT_GT(selfContacts([&](RobotConfig* r) {
                apart(r);
                r->self_collision = std::nullopt;
                r->self_colliding_links = {link};
              }),
              0u)
        << link;
  }
  EXPECT_EQ(selfContacts([&](RobotConfig* r) {
              apart(r);
              r->self_collision = std::nullopt;
              r->self_colliding_links = {"finger1"};
            }),
            0u);
  EXPECT_EQ(selfContacts([&](RobotConfig* r) {
              apart(r);
              r->disable_collisions = {{"upper", "camera"}};
            }),
            0u);
}

TEST(RobotBuilder, AForceTorqueSensorAtAFixedJointMakesNoSelfCollisions) {
  for (const bool fixed_base : {true, false}) {
    EXPECT_EQ(selfContacts([&](RobotConfig* r) {
                r->self_collision = true;
                r->fixed_base = fixed_base;
                SensorConfig sensor;
                sensor.name = "mount";
                sensor.type = SensorType::FORCE_TORQUE;
                sensor.joint = "mount";
                r->sensors = {sensor};
              }),
              0u)
        << fixed_base;
  }
}

/** A wrist: the arm's end is these boxes, the hand, two joints away, a cube of 0.1 m this far [m] above its origin. @return contacts
 * between them, notes */
std::pair<std::size_t, std::vector<std::string>> wristContacts(double height, const std::string& arm) {
  const std::string inertial = R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)";
  SimulationConfig config;
  config.robots = {robot("wrist",
                         R"(<robot name="wrist"><link name="arm">)" + inertial + arm + R"(</link><link name="cross">)" + inertial +
                             R"(</link><link name="hand">)" + inertial +
                             R"(<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="bend" type="continuous"><parent link="arm"/><child link="cross"/><axis xyz="0 1 0"/></joint>
    <joint name="twist" type="continuous"><parent link="cross"/><child link="hand"/><origin xyz="0 0 )" +
                             std::to_string(height) + R"("/><axis xyz="0 0 1"/></joint></robot>)",
                         true)};
  config.robots[0].self_collision = true;
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  return {simulator.report().contacts.size(), simulator.notes()};
}

/** The hand starts this far [m] above the arm's end: below 0 it crosses. */
std::pair<std::size_t, std::vector<std::string>> wristContacts(double gap) {
  return wristContacts(0.1 + gap, R"(<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>)");
}

TEST(RobotBuilder, LinksThatCrossFromTheStartNeverTouch) {
  const auto [crossed, notes] = wristContacts(-0.01);
  EXPECT_EQ(crossed, 0u);
  EXPECT_TRUE(mentions(notes, "never touch each other: arm and hand")) << ::testing::PrintToString(notes);
  const auto [touching, none] = wristContacts(-0.0001);
  EXPECT_GT(touching, 0u);
  EXPECT_FALSE(mentions(none, "never touch"));
}

TEST(RobotBuilder, LayersOfLinksThatStartNearEachOtherAreNarrowed) {
  const auto [contacts, notes] = wristContacts(0.002);  // in layers of 2.5 mm each
  EXPECT_EQ(contacts, 0u);
  EXPECT_TRUE(mentions(notes, "arm 0.9 mm, hand 0.9 mm")) << ::testing::PrintToString(notes);
  EXPECT_FALSE(mentions(wristContacts(0.006).second, "narrower"));
  EXPECT_GT(wristContacts(0.0001).first, 0u);  // closed fingers touch
}

TEST(RobotBuilder, ALinkThatStartsInARecessNeverTouchesItsSides) {
  std::string recess;  // 0.1 mm wider than the hand on either side
  for (const double x : {-0.0751, 0.0751})
    recess += R"(<collision><origin xyz=")" + std::to_string(x) + R"( 0 0"/><geometry><box size="0.05 0.1 0.1"/></geometry></collision>)";
  const auto [contacts, notes] = wristContacts(0, recess);
  EXPECT_EQ(contacts, 0u);
  EXPECT_TRUE(mentions(notes, "caught in each other, never touch each other: arm and hand")) << ::testing::PrintToString(notes);
}

TEST(RobotBuilder, AFixedBaseStillMeetsTheWorld) {
  SimulationConfig config;
  config.robots = {robot("worker", ROBOT, true)};
  config.robots[0].X_WR = makePose({0, 0, 1});
  config.robots[0].self_collision = true;
  config.objects = {box("cube", Vector3::Constant(0.05), 0.5, {0, 0, 1.2 + 0.025 + 0.006})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.3);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 1.2 + 0.025 + 0.005, 1e-4);
}

}  // namespace
}  // namespace blem_sim::sim
