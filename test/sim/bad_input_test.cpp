// Numbers that are none, or out of their range, in a configuration made by hand: one line that names the field.
#include <functional>

#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/** A pendulum with a sensor, a cube, a ground: sound. */
SimulationConfig soundScene() {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {2, 0, 0.06})};
  config.robots = {robot("arm", pendulumUrdf(), true)};
  config.robots[0].gains["hinge"] = {100, 0, 5, 50};
  SensorConfig imu;
  imu.name = "imu";
  imu.link = "arm";
  config.robots[0].sensors = {imu};
  return config;
}

struct BadField {
  const char* words;  ///< that the refusal holds
  std::function<void(SimulationConfig*, double)> set;
  std::vector<double> values;
};

const std::vector<double> NO_NUMBER = {NAN, INFINITE, -INFINITE};
const std::vector<double> NO_PLACE = {NAN, INFINITE, -INFINITE, 1e8, -1e8};
const std::vector<double> NOT_POSITIVE = {NAN, INFINITE, -INFINITE, 0, -1};
const std::vector<double> NEGATIVE = {NAN, INFINITE, -1};
const std::vector<double> NEGATIVE_OR_NAN = {NAN, -1};

std::vector<BadField> badFields() {
  using C = SimulationConfig*;
  return {
      {"time_step", [](C c, double x) { c->time_step = x; }, NOT_POSITIVE},
      {"gravity", [](C c, double x) { c->gravity.z() = x; }, {NAN, INFINITE, -INFINITE, 1e5, -1e300}},
      {"solver.cfm", [](C c, double x) { c->solver.cfm = x; }, NEGATIVE},
      {"solver.correction_fraction", [](C c, double x) { c->solver.correction_fraction = x; }, {NAN, -1, 1.5}},
      {"solver.max_correction_speed", [](C c, double x) { c->solver.max_correction_speed = x; }, NEGATIVE},
      {"solver.threads", [](C c, double x) { c->solver.threads = static_cast<int>(x); }, {0, -3}},
      {"contact.friction", [](C c, double x) { c->contact.surface.friction = x; }, NEGATIVE},
      {"contact.impact_friction_factor", [](C c, double x) { c->contact.surface.impact_friction_factor = x; }, {NAN, -0.1, 1.1}},
      {"contact.impact_friction_speed", [](C c, double x) { c->contact.surface.impact_friction_speed = x; }, NEGATIVE},
      {"contact.restitution", [](C c, double x) { c->contact.surface.restitution = x; }, {NAN, -0.1, 1.1}},
      {"contact.stiffness", [](C c, double x) { c->contact.surface.stiffness = x; }, {NAN, 0, -1e5}},
      {"contact.damping", [](C c, double x) { c->contact.surface.damping = x; }, NEGATIVE_OR_NAN},
      {"contact.boundary_width", [](C c, double x) { c->contact.boundary_width = x; }, {NAN, INFINITE, -1, 1e4, 1e300}},
      {"contact.max_contacts_per_object", [](C c, double x) { c->contact.max_contacts_per_object = static_cast<int>(x); }, {0, -1}},
      {"environments: ground: friction", [](C c, double x) { c->environments[0].contact.friction = x; }, NEGATIVE},
      {"environments: ground: pose", [](C c, double x) { c->environments[0].X_WE.translation().x() = x; }, NO_PLACE},
      {"environments: ground: pose", [](C c, double x) { c->environments[0].X_WE.linear() *= x; }, {NAN, 0, -1, 2}},
      {"environments: ground: scale", [](C c, double x) { c->environments[0].scale.y() = x; }, {NAN, INFINITE, 0}},
      {"objects: cube: mass", [](C c, double x) { c->objects[0].mass = x; }, NOT_POSITIVE},
      {"objects: cube: stiffness", [](C c, double x) { c->objects[0].contact.stiffness = x; }, {NAN, 0, -1e5}},
      {"objects: cube: pose", [](C c, double x) { c->objects[0].X_WO.translation().z() = x; }, NO_PLACE},
      {"objects: cube: mesh_pose", [](C c, double x) { c->objects[0].X_OM.linear()(0, 0) = x; }, {NAN, 3}},
      {"objects: cube: velocity", [](C c, double x) { c->objects[0].angular_velocity.x() = x; }, {NAN, INFINITE, -INFINITE, 1e6, 1e300}},
      {"objects: cube: inertia", [](C c, double x) { c->objects[0].inertia = Matrix3(x * Matrix3::Identity()); }, {NAN, INFINITE, 0, -1}},
      {"objects: cube: max_contacts", [](C c, double x) { c->objects[0].max_contacts = static_cast<int>(x); }, {0, -7}},
      {"objects: cube: com", [](C c, double x) { c->objects[0].com = Vector3(0, x, 0); }, NO_NUMBER},
      {"robots: arm: pose", [](C c, double x) { c->robots[0].X_WR.translation().z() = x; }, NO_PLACE},
      {"robots: arm: gains", [](C c, double x) { c->robots[0].gains["hinge"].p = x; }, NEGATIVE},
      {"robots: arm: gains", [](C c, double x) { c->robots[0].gains["hinge"].i_clamp = x; }, NEGATIVE_OR_NAN},
      {"robots: arm: joint_friction", [](C c, double x) { c->robots[0].joint_friction["hinge"].dry = x; }, NEGATIVE},
      {"robots: arm: effort_limits", [](C c, double x) { c->robots[0].effort_limits["hinge"] = x; }, NEGATIVE_OR_NAN},
      {"robots: arm: armature", [](C c, double x) { c->robots[0].armature["hinge"] = x; }, NEGATIVE},
      {"robots: arm: initial_positions", [](C c, double x) { c->robots[0].initial_positions["hinge"] = x; }, NO_NUMBER},
      {"links.arm: friction", [](C c, double x) { c->robots[0].links["arm"].friction = x; }, NEGATIVE},
      {"sensors: imu: rate", [](C c, double x) { c->robots[0].sensors[0].rate = x; }, NEGATIVE},
      {"sensors: imu: noise", [](C c, double x) { c->robots[0].sensors[0].noise[0].stddev = x; }, NEGATIVE},
  };
}

TEST(BadInput, AConfigurationByHandIsRefusedInOneLine) {
  EXPECT_EQ(refusal([] { Simulator(soundScene(), model::UriResolver()).step(); }), "");
  for (const BadField& field : badFields()) {
    for (const double value : field.values) {
      SimulationConfig config = soundScene();
      field.set(&config, value);
      const std::string text = refusal([&] { Simulator simulator(config, model::UriResolver()); });
      EXPECT_TRUE(isOneLineWith(text, {field.words})) << field.words << " = " << value << ": '" << text << "'";
    }
  }
}

TEST(BadInput, AnEnvironmentThatIsLoadedLaterToo) {
  Simulator simulator(soundScene(), model::UriResolver());
  EnvironmentConfig more = ground();
  more.name = "more";
  more.contact.restitution = 2;
  EXPECT_TRUE(isOneLineWith(refusal([&] { simulator.loadEnvironment(more); }), {"environments: more: restitution"}));
  more.contact.restitution = 0.5;
  EXPECT_EQ(refusal([&] { simulator.loadEnvironment(more); }), "");
}

/** A link of a robot, with this inertial and this in its joint. */
std::string badArm(const std::string& inertial, const std::string& joint) {
  return R"(<robot name="arm"><link name="base"/><link name="link">)" + inertial +
         R"(</link><joint name="hinge" type="revolute"><parent link="base"/><child link="link"/>)" + joint + "</joint></robot>";
}

TEST(BadInput, AUrdfIsRefusedInOneLine) {
  const std::string limit = R"(<limit lower="-1" upper="1" effort="10" velocity="10"/>)";
  const auto inertial = [](const std::string& mass, const std::string& ixx) {
    return R"(<inertial><mass value=")" + mass + R"("/><inertia ixx=")" + ixx + R"(" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)";
  };
  struct Row {
    std::string inertial, joint, word;
  };
  std::vector<Row> rows;
  for (const char* mass : {"nan", "-1", "0", "inf", "heavy", "1e999"}) rows.push_back({inertial(mass, "1"), limit, "mass"});
  for (const char* ixx : {"nan", "inf", "-1"}) rows.push_back({inertial("1", ixx), limit, "inertia"});
  for (const char* damping : {"nan", "-1", "inf"})
    rows.push_back({inertial("1", "1"), limit + R"(<dynamics damping=")" + damping + R"("/>)", "damping"});
  rows.push_back({inertial("1", "1"), R"(<limit lower="nan" upper="1" effort="10" velocity="10"/>)", "lower"});
  rows.push_back({inertial("1", "1"), R"(<limit lower="2" upper="1" effort="10" velocity="10"/>)", "lower"});
  rows.push_back({inertial("1", "1"), R"(<limit lower="0" upper="1" effort="-10" velocity="10"/>)", "effort"});
  rows.push_back({inertial("1", "1"), limit + R"(<axis xyz="0 0 0"/>)", "axis"});
  rows.push_back({inertial("1", "1"), limit + R"(<axis xyz="0 nan 0"/>)", "axis"});
  rows.push_back({inertial("1", "1"), limit + R"(<origin xyz="0 0 nan"/>)", "origin"});
  for (const Row& row : rows) {
    SimulationConfig config;
    config.robots = {robot("arm", badArm(row.inertial, row.joint), true)};
    const std::string text = refusal([&] { Simulator simulator(config, model::UriResolver()); });
    EXPECT_TRUE(isOneLineWith(text, {"arm", row.word})) << row.inertial << row.joint << ": '" << text << "'";
  }
}

TEST(BadInput, NumbersAtTheirEndsRunOrStopButNeverHang) {
  for (const double mass : {1e-300, 1e-30, 1e30, 1e300}) {
    for (const double speed : {0.0, 1e11, 1e200}) {
      SimulationConfig config = soundScene();
      config.objects[0].mass = mass;
      config.objects[0].linear_velocity = {speed, 0, -1};
      const std::string text = refusal([&] {
        Simulator simulator(config, model::UriResolver());
        for (int i = 0; i < 20; ++i)
          for (const dynamics::BodyState& body : simulator.step().bodies)
            EXPECT_TRUE(body.X_WB.matrix().allFinite()) << mass << " " << speed;
      });
      EXPECT_TRUE(text.empty() || isOneLineWith(text, {"cube"})) << text;
    }
  }
}

TEST(BadInput, ManyStartedInsideEachOtherSayThatContactsAreUnreliable) {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 30; ++i)
    config.objects.push_back(
        box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0.01 * (i % 3), 0.01 * (i / 3 % 3), 0.06 + 0.01 * i / 9}));
  Simulator simulator(config, model::UriResolver());
  for (int i = 0; i < 20; ++i) EXPECT_NE(simulator.step().status & CONTACT_UNRELIABLE, 0u) << i;
}

TEST(BadInput, NoComponentOfAVectorIsOverlooked) {
  Simulator simulator(soundScene(), model::UriResolver());
  const int cube = simulator.models()[simulator.modelIndex("cube")].bodies[0];
  const std::uint64_t before = simulator.stateHash();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), INFINITE, -INFINITE, 1e9}) {
    for (int i = 0; i < 3; ++i) {
      Vector3 spoiled = Vector3::Zero();
      spoiled[i] = bad;
      dynamics::BodyState moving = simulator.report().bodies[cube], turning = moving, away = moving;
      moving.v_WCom = spoiled;
      turning.w_WB = spoiled;
      away.X_WB.translation() = spoiled;
      EXPECT_THROW(simulator.setPhysics(spoiled, 0.001, 1), InputError) << i << ": " << bad;
      for (const dynamics::BodyState& state : {moving, turning, away})
        EXPECT_THROW(simulator.moveModel(cube, state), InputError) << i << ": " << bad;
    }
  }
  EXPECT_EQ(simulator.stateHash(), before);
}

TEST(BadInput, GainsAndFrictionAreChecked) {
  Simulator simulator(soundScene(), model::UriResolver());
  const std::uint64_t before = simulator.stateHash();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), INFINITE, -1.0, 1e9}) {
    EXPECT_THROW(simulator.setFriction(simulator.modelIndex("cube"), bad), InputError) << bad;
    for (const JointGains& gains : {JointGains{bad, 0, 0, 1}, JointGains{1, bad, 0, 1}, JointGains{1, 0, bad, 1}})
      EXPECT_THROW(simulator.setMotorGains(0, 0, gains), InputError) << bad;
  }
  EXPECT_THROW(simulator.setMotorGains(0, 0, {1, 0, 1, -1}), InputError);
  EXPECT_EQ(simulator.stateHash(), before);
  EXPECT_EQ(simulator.friction(simulator.modelIndex("cube")), 0.5);
  EXPECT_EQ(simulator.motorGains(0, 0).p, 100);
}

}  // namespace
}  // namespace blem_sim::sim
