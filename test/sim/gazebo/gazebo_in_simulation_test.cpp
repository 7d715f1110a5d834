// <gazebo> blocks in a simulation: surfaces of colliders, sensors of configured, spawned and deleted models, what notes say.
#include <algorithm>
#include <limits>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

/** Two links that each have a ball, with these blocks. */
std::string pairUrdf(const std::string& blocks, const std::string& joint = "fixed") {
  const auto link = [](const std::string& name) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" "
           "iyz=\"0\"/></inertial><collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>";
  };
  return "<robot name=\"pair\">" + link("a") + link("b") + "<joint name=\"j\" type=\"" + joint +
         "\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"0 0 1\" rpy=\"0 0 0.5\"/></joint>" + blocks + "</robot>";
}

const char* const SURFACES = R"(<gazebo reference="a"><mu1>0.9</mu1><kp>3e4</kp><kd>200</kd></gazebo>
  <gazebo reference="b"><mu1>0.8</mu1><kp>1e12</kp><kd>1</kd></gazebo>)";
const char* const IMU = R"(<gazebo reference="b"><sensor name="imu" type="imu"><update_rate>100</update_rate></sensor></gazebo>)";

contact::SurfaceProperties surfaceOf(const Simulator& simulator, const std::string& collider) {
  for (const contact::Collider& other : simulator.colliders())
    if (other.enabled && other.name == collider) return other.surface;
  ADD_FAILURE() << "no collider " << collider;
  return {};
}

bool isTold(const Simulator& simulator, const std::string& words) {
  const auto& notes = simulator.notes();
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != note.npos; });
}

SimulationConfig pairScene(const std::string& blocks) {
  SimulationConfig config;
  config.contact.surface.friction = 0.4;
  config.contact.surface.stiffness = 5e5;
  config.robots = {robot("pair", pairUrdf(blocks), true)};
  return config;
}

TEST(GazeboInSimulation, SurfacesBeatTheDefaultsAndTheConfigurationBeatsThem) {
  SimulationConfig config = pairScene(SURFACES);
  const Simulator described(config, model::UriResolver());
  EXPECT_EQ(surfaceOf(described, "pair::a").friction, 0.9);
  EXPECT_EQ(surfaceOf(described, "pair::a").stiffness, 3e4);
  EXPECT_EQ(surfaceOf(described, "pair::a").damping, 200);
  EXPECT_EQ(surfaceOf(described, "pair::b").friction, 0.8);
  EXPECT_EQ(surfaceOf(described, "pair::b").stiffness, std::numeric_limits<double>::infinity());
  config.robots[0].links["a"].friction = 0.1;
  const Simulator by_link(config, model::UriResolver());
  EXPECT_EQ(surfaceOf(by_link, "pair::a").friction, 0.1);
  EXPECT_EQ(surfaceOf(by_link, "pair::a").stiffness, 3e4);
  config.robots[0].contact.friction = 0.2;
  const Simulator by_robot(config, model::UriResolver());
  EXPECT_EQ(surfaceOf(by_robot, "pair::a").friction, 0.1);
  EXPECT_EQ(surfaceOf(by_robot, "pair::b").friction, 0.2);
}

TEST(GazeboInSimulation, ASingleBodyIsAnObjectWithSurfacesOrARobotWithSensors) {
  SimulationConfig config;
  Simulator simulator(config, model::UriResolver());
  RobotConfig spawned;
  spawned.name = "object";
  spawned.urdf_xml = pairUrdf(SURFACES);
  simulator.spawn(spawned);
  EXPECT_EQ(simulator.models()[simulator.modelIndex("object")].kind, ModelKind::OBJECT);
  EXPECT_EQ(surfaceOf(simulator, "object::a").friction, 0.9);
  EXPECT_EQ(surfaceOf(simulator, "object::b").friction, 0.8);
  spawned.name = "robot";
  spawned.urdf_xml = pairUrdf(IMU);
  spawned.X_WR = makePose({3, 0, 0});
  simulator.spawn(spawned);
  ASSERT_EQ(simulator.sensors().size(), 1u);
  EXPECT_TRUE(isTold(simulator, "robot: sensors of its <gazebo> blocks: imu"));
  for (int i = 0; i < 10; ++i) simulator.step();
  EXPECT_LT(reading<ImuReading>(simulator.report(), 0).linear_acceleration.norm(), 1e-9) << "free fall";
  simulator.removeModel("robot");
  EXPECT_TRUE(simulator.sensors().empty());
  EXPECT_FALSE(isTold(simulator, "robot: sensors"));
  simulator.step();
}

TEST(GazeboInSimulation, AnObjectSaysThatItHasNoSensors) {
  SimulationConfig config;
  ObjectConfig object;
  object.name = "ball";
  object.urdf_xml = pairUrdf(IMU);
  config.objects = {object};
  const Simulator simulator(config, model::UriResolver());
  EXPECT_TRUE(simulator.sensors().empty());
  EXPECT_TRUE(isTold(simulator, "ball: objects have no sensors"));
}

TEST(GazeboInSimulation, AFrameOfOtherAxesIsTold) {
  const auto told = [](const std::string& frame, const std::string& rpy, const std::string& joint = "fixed") {
    const std::string plugin = "<plugin name=\"p\" filename=\"libgazebo_ros_imu_sensor.so\"><frameName>" + frame + "</frameName></plugin>";
    SimulationConfig config;
    config.robots = {robot(
        "pair",
        pairUrdf("<gazebo reference=\"b\"><sensor name=\"imu\" type=\"imu\"><pose>0 0 0 " + rpy + "</pose>" + plugin + "</sensor></gazebo>",
                 joint),
        true)};
    const Simulator simulator(config, model::UriResolver());
    return isTold(simulator, "sensor 'imu': its frame_id says '" + frame + "'");
  };
  EXPECT_FALSE(told("b", "0 0 0"));
  EXPECT_TRUE(told("b", "0 0 0.1"));
  EXPECT_TRUE(told("a", "0 0 0"));
  EXPECT_FALSE(told("a", "0 0 -0.5"));
  EXPECT_TRUE(told("a", "0 0 0", "continuous"));
  EXPECT_FALSE(told("elsewhere", "0 0 0.1"));
}

TEST(GazeboInSimulation, ACameraFrameIsOptical) {
  const auto told = [](bool turned) {
    SimulationConfig config = pairScene("");
    SensorConfig camera;
    camera.name = "eye";
    camera.type = SensorType::DEPTH_CAMERA;
    camera.link = camera.frame_id = "a";
    camera.X_LS = turned ? makePose({0, 0, 0}, {0, -M_PI / 2, M_PI / 2}) : Pose::Identity();
    config.robots[0].sensors = {camera};
    return isTold(Simulator(config, model::UriResolver()), "sensor 'eye': its frame_id says 'a'");
  };
  EXPECT_TRUE(told(false));
  EXPECT_FALSE(told(true));
}

const char* const WEIGHTLESS_B = "<gazebo reference=\"b\"><turnGravityOff>true</turnGravityOff></gazebo>";
const char* const WEIGHTLESS = R"(<gazebo reference="a"><gravity>false</gravity></gazebo>
  <gazebo reference="b"><turnGravityOff>1</turnGravityOff></gazebo>)";

class Weightless : public testing::TestWithParam<const char*> {};

TEST_P(Weightless, LinksDoNotFall) {
  SimulationConfig config;
  config.solver.stepper = GetParam();
  Simulator simulator(config, model::UriResolver());
  RobotConfig hinged = robot("hinged", pairUrdf(WEIGHTLESS, "continuous"), false), object = robot("object", pairUrdf(WEIGHTLESS), false);
  object.X_WR = makePose({3, 0, 0});
  simulator.spawn(hinged);
  simulator.spawn(object);
  stepFor(&simulator, 0.5);
  for (const char* model : {"hinged", "object"}) EXPECT_LT(bodyOf(simulator, model).v_WCom.norm(), 1e-9) << model;
  EXPECT_LT(simulator.report().energy_out_of_nothing, 1e-9);
}

TEST_P(Weightless, AreThoseThatSaySo) {
  for (const char* joint : {"fixed", "continuous"}) {
    SimulationConfig config;
    config.solver.stepper = GetParam();
    config.robots = {robot("pair", pairUrdf(WEIGHTLESS_B, joint), false)};
    Simulator simulator(config, model::UriResolver());
    simulator.step();
    double momentum = 0;  // [N s]
    for (const int body : simulator.models()[0].bodies)
      momentum += simulator.world().bodySpec(body).inertial.mass * simulator.report().bodies[body].v_WCom.z();
    EXPECT_NEAR(momentum, -1 * G * 0.001, 1e-9) << joint << ", only one link of 1 kg has weight";
  }
}

TEST_P(Weightless, FollowGravityAndMassesThatAreSet) {
  SimulationConfig config;
  config.solver.stepper = GetParam();
  config.robots = {robot("pair", pairUrdf(WEIGHTLESS, "continuous"), false)};
  Simulator simulator(config, model::UriResolver());
  simulator.setPhysics({0, 3, -5}, 0.001, 1);
  geometry::MassProperties heavier = simulator.linkInertial(simulator.robots()[0].bodies[1], 1);
  heavier.mass = 7;
  simulator.setLinkInertial(simulator.robots()[0].bodies[1], 1, heavier);
  stepFor(&simulator, 0.1);
  EXPECT_LT(bodyOf(simulator, "pair").v_WCom.norm(), 1e-9);
}

/** One link of two, then both, then one again, whichever of them. */
TEST_P(Weightless, AreThoseThatAreSwitched) {
  SimulationConfig config;
  config.solver.stepper = GetParam();
  config.robots = {robot("pair", pairUrdf(WEIGHTLESS_B, "continuous"), false)};
  Simulator simulator(config, model::UriResolver());
  const std::vector<int> bodies = simulator.models()[0].bodies;
  double momentum = 0;  // [N s]
  const auto stepWith = [&](double mass_that_falls) {
    const double before = momentum;
    simulator.step();
    momentum = 0;
    for (const int body : bodies) momentum += simulator.world().bodySpec(body).inertial.mass * simulator.report().bodies[body].v_WCom.z();
    EXPECT_NEAR(momentum - before, -mass_that_falls * G * 0.001, 1e-9);
    EXPECT_LT(simulator.report().energy_out_of_nothing, 1e-9);
  };
  stepWith(1);
  simulator.setLinkGravity(bodies[0], 0, false);
  stepWith(0);
  simulator.setLinkGravity(bodies[1], 1, true);
  stepWith(1);
  simulator.setLinkGravity(bodies[0], 0, true);
  stepWith(2);
  EXPECT_THROW(simulator.setLinkGravity(bodies[0], 7, true), InputError);
}

INSTANTIATE_TEST_SUITE_P(Steppers, Weightless, testing::Values("articulated", "world_step", "quick_step"));

TEST(GazeboInSimulation, GravityIsTurnedOffForAllOfAnObjectOrForNone) {
  SimulationConfig config;
  Simulator simulator(config, model::UriResolver());
  simulator.spawn(robot("object", pairUrdf(WEIGHTLESS_B), false));
  EXPECT_TRUE(isTold(simulator, "object: gravity acts on all links of an object or on none"));
}

}  // namespace
}  // namespace blem_sim::sim
