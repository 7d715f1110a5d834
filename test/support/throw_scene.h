// One 64-bit seed makes one scene of things thrown at walls, at bodies at rest before them, and driven into them; and its outcome.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"
#include "support/bare_meshes.h"
#include "support/random/scene_numbers.h"

namespace blem_sim {

/** A scene of thrown bodies, 0.1 to 100 m/s, time steps of 0.1 to 10 ms. */
struct ThrownScene {
  sim::SimulationConfig config;
  sim::JointCommandMessage command;  ///< to the robot, if there is one
  double floor = 0;                  ///< [m] height of the wall's upper face, or
  bool room = false;                 ///< bodies are inside of it
  bool default_widths = true;
  int steps = 40;
  std::string description;  ///< one line
};

struct ThrownOutcome {
  bool passed = false;   ///< a body was behind the wall altogether
  bool crossed = false;  ///< some of a body was
  bool unsaid = false;   ///< one of both, and no CONTACT_UNRELIABLE up to the next step
  bool untold = false;   ///< no layer event either
  bool said = false;     ///< CONTACT_UNRELIABLE at any time
  double fastest = 0;    ///< [m/s] of a centre or of a far corner, until then
  int most_solves = 0, steps = 0;
};

namespace thrown_scene {

/** Body of that diagonal [m], turned any way. */
inline sim::ObjectConfig bodyOf(SceneNumbers* n, const std::string& name, double diagonal, std::string* kind) {
  sim::ObjectConfig object;
  object.name = name;
  const int shape = n->count(0, 5);
  *kind = std::vector<std::string>{"cube", "plate", "rod", "ball", "round mesh", "thin box"}[shape];
  Vector3 size = Vector3::Ones();
  if (shape == 0) object.uri = sim::meshFile("unit_cube", geometry::boxMesh(size));
  if (shape == 1) object.uri = sim::meshFile("unit_plate", geometry::gridMesh(1, 1, 1, 1));
  if (shape == 2) object.uri = sim::meshFile("unit_cube", geometry::boxMesh(size)), size = {0.1, 0.1, 1};
  if (shape == 5) object.uri = sim::meshFile("unit_cube", geometry::boxMesh(size)), size = {1, 1, 0.05};
  if (shape == 4) object.uri = sim::meshFile("coarse_ball", geometry::icosphereMesh(0.5, 1)), size *= std::sqrt(3.0);
  if (shape == 3) {
    const double radius = std::pow(10, std::round(10 * std::log10(diagonal / 2)) / 10);
    object.urdf = sim::sceneFile(fmt::format("thrown_ball_{:.4g}.urdf", radius), [&](std::ofstream& out) {
      const double inertia = 0.4 * radius * radius;
      out << fmt::format(
          R"(<robot name="ball"><link name="link"><inertial><mass value="1"/><inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/></inertial>)"
          R"(<collision><geometry><sphere radius="{1}"/></geometry></collision></link></robot>)",
          inertia, radius);
    });
  } else {
    object.scale = size * (diagonal / (shape == 1 ? std::sqrt(2.0) : size.norm()));
  }
  object.mass = n->spread(0.01, 10);
  return object;
}

/** Static or free; @return its word */
inline std::string addWall(SceneNumbers* n, double size, ThrownScene* scene) {
  const int kind = n->count(0, 7);
  scene->room = kind >= 4;
  geometry::TriangleMesh mesh;
  std::string word;
  if (kind == 0) mesh = geometry::gridMesh(40, 40, 1, 1), word = "sheet";
  if (kind == 1) mesh = geometry::gridMesh(3, 3, 60, 60), word = "fine_sheet";
  if (kind == 2) {
    mesh = geometry::gridMesh(4, 4, 9, 9), word = "soup";
    const geometry::TriangleMesh other = geometry::gridMesh(4.4, 4.1, 7, 11);
    const int offset = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Vector3i& e : other.elements) mesh.elements.push_back(Vector3i(e[0], e[2], e[1]) + Vector3i::Constant(offset));
  }
  if (kind == 3) mesh = geometry::transformed(geometry::boxMesh({10, 10, 0.002}), makePose({0, 0, -0.001})), word = "thin_floor";
  if (kind == 4 || kind == 7) mesh = geometry::boxMesh(Vector3::Ones()), word = "box_room";
  if (kind == 5) mesh = geometry::icosphereMesh(0.7, 2), word = "round_room";
  if (kind == 6) mesh = geometry::cylinderMesh(0.6, 1, 24), word = "cylinder_room";
  const Vector3 scale = scene->room ? Vector3(Vector3::Constant(size)) : Vector3(Vector3::Ones());
  if (kind == 7) {
    sim::ObjectConfig wall;
    wall.name = "wall";
    wall.uri = sim::meshFile(word, mesh);
    wall.scale = scale;
    wall.mass = n->spread(0.1, 100);
    scene->config.objects.push_back(wall);
    scene->config.gravity = Vector3::Zero();
    return "free " + word;
  }
  sim::EnvironmentConfig wall;
  wall.name = "wall";
  wall.uri = sim::meshFile(word, mesh);
  wall.scale = scale;
  scene->config.environments.push_back(wall);
  return word;
}

/** A paddle on a slider, which its motor drives down by `step` [m]. */
inline void addPaddle(SceneNumbers* n, double height, double width, double step, ThrownScene* scene) {
  const double mass = n->spread(0.05, 3), thickness = n->chance(0.5) ? 0.01 : 0.002;
  const double i = mass / 12 * width * width, effort = n->chance(0.5) ? 300 : 1e6;
  sim::RobotConfig robot = blem_sim::sim::robot(
      "driver",
      fmt::format(R"(<robot name="driver"><link name="base"/><link name="paddle"><inertial><mass value="{}"/>)"
                  R"(<inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>)"
                  R"(<collision><geometry><box size="{} {} {}"/></geometry></collision></link>)"
                  R"(<joint name="slide" type="prismatic"><parent link="base"/><child link="paddle"/><axis xyz="0 0 -1"/>)"
                  R"(<limit lower="-1" upper="1" effort="{}" velocity="1e3"/></joint></robot>)",
                  mass, i, i, 2 * i, width, width, thickness, effort),
      true);
  robot.X_WR = makePose({0, 0, height});
  const int gains = n->count(0, 3);
  if (gains == 0) robot.gains["slide"] = {1e5, 0, 2000};
  if (gains == 1) robot.gains["slide"] = {2000, 0, 60};
  if (gains == 2) robot.gains["slide"] = {1e5, 0, 200};
  if (gains == 3) robot.gains["slide"] = {n->spread(1e2, 1e6), 0, n->spread(1, 1e4)};
  robot.motor["slide"] = sim::MotorLaw::IMPLICIT_PD;
  scene->config.robots.push_back(robot);
  scene->command.joints = {"slide"};
  scene->command.positions = {step};
  scene->description +=
      fmt::format(", paddle {:.2g} kg p {:.2g} d {:.2g} by {:.2g} m", mass, robot.gains["slide"].p, robot.gains["slide"].d, step);
}

/** 10 kg hit a plate of 10 g at rest over a sheet. */
inline ThrownScene hitPlateScene(SceneNumbers* n) {
  ThrownScene scene;
  sim::SimulationConfig& config = scene.config;
  config.environments = {sim::ground()};
  config.environments[0].name = "wall";
  if (n->chance(0.3)) config.gravity.setZero();
  if (n->chance(0.5)) config.contact.surface.restitution = n->uniform(0, 1);
  const double width = n->spread(0.03, 0.4), size = n->spread(0.02, 0.2), over = n->uniform(0.0026, 0.02), gap = n->spread(0.0005, 0.1),
               speed = n->uniform(2, 20), thickness = n->chance(0.3) ? 0 : n->uniform(0.001, 0.006);
  sim::ObjectConfig plate, hitter;
  plate.name = "plate";
  plate.uri = thickness > 0 ? sim::meshFile("unit_cube", geometry::boxMesh(Vector3::Ones()))
                            : sim::meshFile("unit_plate", geometry::gridMesh(1, 1, 1, 1));
  plate.scale = {width, width, thickness > 0 ? thickness : 1};
  plate.mass = 0.01;
  plate.X_WO = makePose({0, 0, over + 0.5 * thickness});
  hitter.name = "hitter";
  const int shape = n->count(0, 2);
  const bool turned = n->chance(0.5);
  if (shape == 0) hitter.uri = sim::meshFile("unit_cube", geometry::boxMesh(Vector3::Ones()));
  if (shape == 1) hitter.uri = sim::meshFile("coarse_ball", geometry::icosphereMesh(0.5, 1));
  if (shape == 2) hitter.uri = sim::meshFile("unit_cylinder", geometry::cylinderMesh(0.5, 1, 16));
  hitter.scale = Vector3::Constant(size);
  hitter.mass = 10;
  const double aside = n->chance(0.5) ? 0.3 * width : 0;
  hitter.X_WO =
      makePose({n->uniform(-aside, aside), n->uniform(-aside, aside), over + thickness + 0.005 + gap + (turned ? 0.87 : 0.5) * size},
               turned ? n->within(M_PI) : Vector3(Vector3::Zero()));
  hitter.linear_velocity = {0, 0, -speed};
  config.objects = {plate, hitter};
  scene.steps = std::clamp(static_cast<int>(std::ceil((gap + 0.05) / (speed * config.time_step))), 10, 60);
  scene.description =
      fmt::format("plate {:.3g} m, {:.3g} m thick, {:.3g} m over a sheet, hit by {} of {:.3g} m from {:.3g} m, {:.3g} m/s, e {:.2g}", width,
                  thickness, over, std::array{"cube", "ball", "cylinder"}[shape], size, gap, speed, config.contact.surface.restitution);
  return scene;
}

}  // namespace thrown_scene

/** Bodies one above the other over the wall's place below; the uppermost is thrown down, or a paddle is driven down; the others rest or
 * not. */
inline ThrownScene thrownScene(std::uint64_t seed) {
  using namespace thrown_scene;
  SceneNumbers n(seed);
  if (n.chance(0.25)) return hitPlateScene(&n);
  ThrownScene scene;
  sim::SimulationConfig& config = scene.config;
  config.time_step = n.chance(0.4) ? 0.001 : n.spread(1e-4, 1e-2);
  const double speed = n.spread(0.1, 100), dt = config.time_step;
  if (n.chance(0.3)) config.contact.surface.restitution = n.uniform(0, 1);
  config.contact.surface.friction = n.uniform(0, 1);
  if (n.chance(0.3)) {
    scene.default_widths = false;
    config.contact.boundary_width = n.spread(0.0005, 0.005);
  }
  const int bodies = n.count(1, 3);
  const bool driven = n.chance(0.25);
  std::vector<double> diagonals;
  double height = 0, gaps = 0;
  std::vector<double> heights;
  const auto gap = [&] { return n.spread(0.003, std::clamp(20 * speed * dt, 0.006, 0.1)); };
  for (int i = 0; i < bodies; ++i) {
    const double diagonal = n.spread(0.008, 0.15), layers = i == 0 ? 0.005 : 0.01;
    diagonals.push_back(diagonal);
    gaps += gap();
    heights.push_back(height + gaps + layers + 0.5 * diagonal);
    height += diagonal + layers;
  }
  const double top = height + gaps, room = 2 * (top + 0.3), bottom = -0.5 * room;
  scene.description = fmt::format("{:.3g} m/s, {:.3g} ms, ", speed, 1e3 * dt) + addWall(&n, room, &scene);
  const bool round = scene.room && !config.environments.empty() && config.environments[0].uri.find("round") != std::string::npos;
  const double from = round ? 1.2 * bottom : scene.room ? bottom : 0;
  for (int i = 0; i < bodies; ++i) {
    std::string kind;
    sim::ObjectConfig object = bodyOf(&n, fmt::format("body{}", i), diagonals[i], &kind);
    const bool flat = n.chance(0.4), rests = i + 1 < bodies || driven;
    const double aside = 0.3 * diagonals[i];
    object.X_WO = makePose({n.uniform(-aside, aside), n.uniform(-aside, aside), from + heights[i]},
                           flat ? Vector3(0, 0, n.uniform(-3, 3)) : n.within(M_PI));
    if (!rests || n.chance(0.15)) {
      const Vector3 down = (Vector3(0, 0, -1) + n.uniform(0, 1) * n.within(0.7)).normalized();
      object.linear_velocity = speed * down;
      if (n.chance(0.4)) object.angular_velocity = n.direction() * n.uniform(0, 1) * speed / diagonals[i];
    }
    scene.description += fmt::format(", {} {:.2g} m {:.2g} kg{}", kind, diagonals[i], *object.mass, rests ? " at rest" : "");
    config.objects.push_back(object);
  }
  if (driven) addPaddle(&n, from + top + 0.03, std::max(0.05, diagonals.back()), n.uniform(0.05, 0.25) + top, &scene);
  scene.steps = std::clamp(static_cast<int>(std::ceil(2 * (gaps + 0.05) / (speed * dt))), 10, driven ? 100 : 60);
  return scene;
}

inline ThrownOutcome runThrownScene(const ThrownScene& scene) {
  sim::Simulator simulator(scene.config, model::UriResolver());
  if (!scene.command.joints.empty()) simulator.commandJoints(0, scene.command);
  const Wall wall = scene.room ? Wall::around(simulator, "wall") : Wall::below(simulator, "wall", scene.floor);
  ThrownOutcome outcome;
  bool crossed_before = false, told = false;
  for (int i = 0; i < scene.steps; ++i) {
    const sim::StepReport& report = simulator.step();
    ++outcome.steps;
    outcome.most_solves = std::max(outcome.most_solves, report.substeps + report.redone_solves);
    outcome.said = outcome.said || (report.status & sim::CONTACT_UNRELIABLE);
    for (const sim::LayerEventReport& event : report.layer_events) told = told || event.outside;
    outcome.unsaid = outcome.unsaid || (crossed_before && !outcome.said);
    outcome.untold = outcome.untold || (crossed_before && !told);
    if (report.status & sim::STATE_NOT_FINITE) break;
    for (std::size_t c = 0; c < simulator.colliders().size(); ++c) {
      const contact::Collider& collider = simulator.colliders()[c];
      if (collider.body == dynamics::WORLD_BODY || static_cast<int>(c) == wall.collider) continue;
      const dynamics::BodyState& body = report.bodies[collider.body];
      if (!outcome.passed)
        outcome.fastest =
            std::max(outcome.fastest, body.v_WCom.norm() + 0.5 * body.w_WB.norm() * collider.geometry->bounds().diagonal().norm());
      const Behind now = behind(simulator, wall, static_cast<int>(c));
      crossed_before = crossed_before || now != Behind::NOTHING;
      outcome.passed = outcome.passed || now == Behind::ALL;
    }
    outcome.crossed = crossed_before;
  }
  return outcome;
}

}  // namespace blem_sim
