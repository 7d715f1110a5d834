// Inputs that a simulation told, given to a fresh one.
#include "blem_sim/sim/simulator_input.h"

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "sim/state/saved_scene.h"
#include "support/input_notes.h"

namespace blem_sim::sim {
namespace {

SimulationConfig sceneWithCloud() {
  SimulationConfig config = sceneOfAllKinds();
  EnvironmentConfig live;
  live.name = "live";
  live.live.topic = "/points";
  live.X_WE = makePose({0, 0, 0});
  config.environments.push_back(live);
  config.robots.push_back(robot("sled",
                                R"(<robot name="sled"><link name="hull"><inertial><mass value="1"/>
                                  <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)",
                                false));
  config.robots.back().X_WR = makePose({3, 0, 1});
  return config;
}

constexpr int SLED = 1, SECOND = 2;  // robots; the latter is spawned

CloudSurface cloudBelowCube() {
  std::vector<Vector3> points;
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j) points.emplace_back(0.0101 * i, 0.0099 * j, 1e-4 * (i % 3));
  return makeCloudSurface(points, model::CloudOptions(), "live");
}

RobotConfig spawned() {
  RobotConfig second = robot("second", pendulumUrdf(), true);
  second.motor.clear();
  second.motors = MotorDefault::TRANSMISSIONS;
  second.X_WR = makePose({2, 0.1, 0}, {0, 0, 0.3});
  second.pid_gains["hinge"] = {30, 1, 2, std::numeric_limits<double>::infinity()};
  return second;
}

EnvironmentConfig tilted() {
  EnvironmentConfig plane;
  plane.name = "tilted";
  plane.plane = Eigen::Vector4d(0.1, 0, 1, -0.3);
  plane.contact.friction = 0.123456789;
  return plane;
}

/** Every call that changes a simulation. */
std::vector<std::function<void(Simulator&)>> allCalls(const SimulationState& earlier) {
  CloudSurface cloud = cloudBelowCube();
  dynamics::BodyState thrown;
  thrown.X_WB = makePose({0, 1, 0.5}, {0.3, 0.2, 0.1});
  thrown.v_WCom = {1, 0, 2};
  geometry::MassProperties heavier;
  heavier.mass = 2;
  heavier.inertia = 0.01 * Matrix3::Identity();
  return {
      [=](Simulator& s) { s.restore(earlier); },
      [](Simulator& s) { setOut(&s); },
      [](Simulator& s) {
        s.commandJoints(0, {{"hinge"}, {0.2}, {0.1}, {1}});
      },
      [](Simulator& s) {
        s.driveJoints(0, {{"hinge"}, {0.3}, 1.7, 0.4});
      },
      [](Simulator& s) {
        s.driveBase(SLED, 0, {0.2, 0.1, 0.3, 0, 0});
      },
      [](Simulator& s) { s.releaseBase(SLED); },
      [cloud](Simulator& s) mutable { s.updateCloud("live", &cloud); },
      [](Simulator& s) { s.spawn(spawned()); },
      [](Simulator& s) { s.holdJoints(SECOND, {0}); },
      [](Simulator& s) { s.loadEnvironment(tilted()); },
      [=](Simulator& s) { s.moveModel(s.models()[s.modelIndex("ball")].bodies[0], thrown); },
      [](Simulator& s) {
        s.applyLoad({s.models()[s.modelIndex("cube")].bodies[0], {{5, 0, 1}, {0, 0.1, 0}}, {0, 0, 0.02}}, {0, 0.02});
      },
      [](Simulator& s) {
        s.applyEffort(s.robots()[0].joints[0], 2.5, {0, -1});
      },
      [](Simulator& s) { s.setJointPositions(SECOND, {"hinge"}, {0.7}); },
      [](Simulator& s) { s.setJointDamping(SECOND, 0, 0.7); },
      [](Simulator& s) {
        s.setMotorGains(SECOND, 0, {90, 4, 3, 50});
      },
      [](Simulator& s) { s.setFriction(s.modelIndex("cube"), 0.11); },
      [](Simulator& s) { s.setJointLimits(SECOND, 0, -2, 2); },
      [=](Simulator& s) { s.setLinkInertial(s.robots()[SECOND].bodies[1], 1, heavier); },
      [](Simulator& s) { s.setLinkGravity(s.robots()[SECOND].bodies[1], 1, false); },
      [](Simulator& s) {
        s.setPhysics({0.1, 0, -9}, 0.0005, 1);
      },
      [](Simulator& s) { s.tareSensor(1); },
      [](Simulator& s) { s.attach("ball", findLink(s, "cube::link", ""), 1e3, std::numeric_limits<double>::infinity()); },
      [](Simulator& s) { s.detach("ball"); },
      [](Simulator& s) { s.clearLoads(s.models()[s.modelIndex("cube")].bodies[0]); },
      [](Simulator& s) { s.clearEfforts(s.robots()[0].joints[0]); },
      [](Simulator& s) { s.resetModel(s.modelIndex("plate")); },
      [](Simulator& s) { s.unloadEnvironment("tilted"); },
      [](Simulator& s) { s.removeModel("second"); },
      [](Simulator& s) { s.resetWorld(); },
      [](Simulator& s) { s.resetSimulation(); },
  };
}

TEST(SimulatorInput, EveryCallPlayedAgainGivesTheSameBits) {
  const SimulationConfig config = sceneWithCloud();
  Simulator simulator(config, model::UriResolver());
  setOut(&simulator);
  const SimulationState earlier = simulator.save();
  simulator.resetSimulation();
  InputNotes notes(&simulator);
  std::set<std::string> calls;
  for (const auto& call : allCalls(earlier)) {
    call(simulator);
    calls.insert(notes.inputs.back().second.call);
    stepFor(&simulator, 0.02);
  }
  EXPECT_EQ(calls.size(), allCalls(earlier).size()) << "a call that is told under another's name, or not at all";
  EXPECT_EQ(firstDifference(config, notes), 0u);
}

TEST(SimulatorInput, AnAlteredNumberShowsInTheNextStep) {
  const SimulationConfig config = sceneWithCloud();
  Simulator simulator(config, model::UriResolver());
  InputNotes notes(&simulator);
  stepFor(&simulator, 0.01);
  simulator.commandJoints(0, {{"hinge"}, {0.2}, {}, {}});
  stepFor(&simulator, 0.01);
  ASSERT_EQ(firstDifference(config, notes), 0u);
  double& position = notes.inputs[0].second.numbers[3];
  ASSERT_EQ(position, 0.2);
  position = std::nextafter(position, 1);
  EXPECT_EQ(firstDifference(config, notes), 11u);
}

TEST(SimulatorInput, ARefusedCallIsNotTold) {
  Simulator simulator(sceneWithCloud(), model::UriResolver());
  InputNotes notes(&simulator);
  EXPECT_THROW(simulator.commandJoints(0, {{"elbow"}, {0.2}, {}, {}}), InputError);
  EXPECT_THROW(simulator.removeModel("nobody"), InputError);
  EXPECT_TRUE(notes.inputs.empty());
}

TEST(SimulatorInput, WhatARecordCouldNotNameIsRefusedOrToldAsItIs) {
  Simulator simulator(sceneWithCloud(), model::UriResolver()), again(sceneWithCloud(), model::UriResolver());
  InputNotes notes(&simulator);
  const int cube = simulator.modelIndex("cube"), body = simulator.models()[cube].bodies[0], root = simulator.robots()[0].bodies.back();
  simulator.setLinkInertial(body, 0, {2, Vector3::Zero(), Matrix3::Identity()});
  applyInput(notes.inputs.back().second, &again);
  EXPECT_EQ(simulator.stateHash(), again.stateHash());
  EXPECT_THROW(simulator.setLinkInertial(root, -1, {2, Vector3::Zero(), Matrix3::Identity()}), InputError);
  simulator.removeModel("cube");
  EXPECT_THROW(simulator.resetModel(cube), InputError);
  EXPECT_THROW(simulator.setFriction(cube, 0.5), InputError);
}

TEST(SimulatorInput, ABoundaryWidthToBeChosenIsChosenAgain) {
  Simulator simulator(sceneWithCloud(), model::UriResolver()), again(sceneWithCloud(), model::UriResolver());
  InputNotes notes(&simulator);
  geometry::TriangleMesh rough = geometry::gridMesh(1, 1, 30, 30);
  for (std::size_t i = 0; i < rough.vertices.size(); ++i) rough.vertices[i].z() = 0.001 * std::sin(17.0 * static_cast<double>(i * i));
  EnvironmentConfig scan;
  scan.name = "scan";
  scan.uri = meshFile("rough_floor", rough);
  scan.contact.boundary_width = BoundaryWidth::chosen();
  simulator.loadEnvironment(scan);
  applyInput(notes.inputs.at(0).second, &again);
  EXPECT_GT(simulator.colliders().back().radius, 0.001);
  EXPECT_EQ(again.colliders().back().radius, simulator.colliders().back().radius);
}

/** All inputs of a run, one of their arguments being another. */
std::vector<SimulatorInput> altered(const SimulatorInput& input) {
  std::vector<SimulatorInput> others;
  for (std::size_t i = 0; i < input.numbers.size(); ++i)
    for (const double number : {std::nan(""), -1.0, 0.5, 1e9, 1e300}) {
      others.push_back(input);
      others.back().numbers[i] = number;
    }
  for (const std::size_t size : {std::size_t{0}, input.numbers.size() / 2, input.numbers.size() + 1}) {
    others.push_back(input);
    others.back().numbers.resize(size);
  }
  others.push_back(input);
  others.back().texts.emplace_back("too many");
  others.push_back(input);
  others.back().call += "s";
  return others;
}

TEST(SimulatorInput, LyingArgumentsAreRefusedInOneLine) {
  Simulator simulator(sceneWithCloud(), model::UriResolver());
  const SimulationState earlier = simulator.save();
  std::vector<SimulatorInput> inputs;
  {
    InputNotes notes(&simulator);
    for (const auto& call : allCalls(earlier))
      if (inputs.size() < 18) call(simulator), inputs.push_back(notes.inputs.back().second);
  }
  simulator.setPhysics({0, 0, -9.81}, 0.001, 1);
  int refused = 0;
  for (const SimulatorInput& input : inputs) {
    if (input.call == "updateCloud") continue;  // its points are numbers like any
    for (const SimulatorInput& other : altered(input)) {
      try {
        applyInput(other, &simulator);
      } catch (const InputError& error) {
        ++refused;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_GT(refused, 300);
  simulator.resetWorld();
  simulator.step();
}

}  // namespace
}  // namespace blem_sim::sim
