// One 64-bit seed makes one scene: grounds, trays, heaps, throws, spins, robots and hands, nasty ones among them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"
#include "sim/simulation_scene.h"
#include "support/random/random_robot.h"
#include "support/random/scene_numbers.h"

namespace blem_sim {

struct RandomScene {
  sim::SimulationConfig config;
  std::vector<sim::JointCommandMessage> commands;  ///< one per robot, given once at the start
  bool passive = true;                             ///< no motor and no compliant contact: energy may only fall
  double floor = -INFINITY;                        ///< [m] height that no centre of an object may pass downwards
  double size = 0;                                 ///< [m] of a body, typically
  bool watches_walls = false;                      ///< no centre may go through a mesh of the environment
  std::string description;                         ///< one line
};

/** Traits of all bodies of a scene. */
struct SceneTraits {
  double size;           // [m] of a body, typically
  double size_spread;    // factor by which bodies differ from it at most
  double pitch;          // of the lattice they start in, of the larger ones' diagonal; below 1 they may overlap
  bool any_mass;         // 1e-3 to 1e3 kg for any size
  double throws, spins;  // fractions of bodies
  int columns;           // of the lattice
};

inline SceneTraits randomTraits(SceneNumbers* n) {
  SceneTraits traits{};
  traits.size = n->chance(0.2) ? n->spread(1e-3, 10) : n->spread(0.03, 0.3);
  traits.size_spread = n->chance(0.2) ? n->spread(1, 10) : n->uniform(1, 1.8);
  traits.pitch = n->chance(0.1) ? n->uniform(0.6, 0.95) : n->uniform(1.02, 1.5);
  traits.any_mass = n->chance(0.35);
  traits.throws = n->chance(0.25) ? n->uniform(0.1, 1) : 0;
  traits.spins = n->chance(0.25) ? n->uniform(0.1, 1) : 0;
  traits.columns = n->count(1, 4);
  return traits;
}

/** A ball has a shape of its own, exact; its radius is one of few, so that few files are written. [m] */
inline double ballRadius(double wanted) { return std::pow(10, std::round(20 * std::log10(wanted)) / 20); }

inline std::string ballFile(double radius) {
  const std::string name = fmt::format("ball_{:.6g}", radius);
  return sim::sceneFile(name + ".urdf", [&](std::ofstream& out) {
    out << fmt::format(
        R"(<robot name="{}"><link name="link">{}<collision><geometry><sphere radius="{}"/></geometry></collision></link></robot>)", "ball",
        massText(1, Vector3::Zero(), Vector3::Constant(std::sqrt(2.4) * radius)), radius);
  });
}

/** A body of this diagonal [m]: ball, cube, box, plate, rod or a round mesh. @param kind its word in descriptions */
inline sim::ObjectConfig randomShape(SceneNumbers* n, const std::string& name, double diagonal, std::string* kind, Vector3* extent) {
  sim::ObjectConfig object;
  object.name = name;
  const int shape = n->count(0, 5);
  *kind = std::vector<std::string>{"ball", "cube", "box", "rod", "mesh", "cylinder"}[shape];
  if (shape == 0) {
    const double radius = ballRadius(diagonal / 2);
    object.urdf = ballFile(radius);
    *extent = Vector3::Constant(2 * radius);
    return object;
  }
  Vector3 size = Vector3::Ones();
  if (shape == 2) size = {n->uniform(0.1, 1), n->uniform(0.1, 1), 1};
  if (shape == 3) size = {0.12, 0.12, 1};
  if (shape == 5) size = {1, 1, n->uniform(0.2, 3)};
  size *= diagonal / size.norm();
  if (shape <= 3) object.uri = sim::meshFile("unit_cube", geometry::boxMesh(Vector3::Ones()));
  if (shape == 4) object.uri = sim::meshFile("unit_ball", geometry::icosphereMesh(0.5, 2));
  if (shape == 5) object.uri = sim::meshFile("unit_cylinder", geometry::cylinderMesh(0.5, 1, 16));
  object.scale = size;
  *extent = size;
  return object;
}

inline void moveAtStart(SceneNumbers* n, const SceneTraits& traits, double diagonal, sim::ObjectConfig* object) {
  const double speed = n->chance(traits.throws) ? n->spread(1, 30) : n->uniform(0, 0.5);
  const double spin = n->chance(traits.spins) ? n->spread(10, 300) : n->uniform(0, 5);
  object->linear_velocity = n->direction() * speed;
  object->angular_velocity = n->direction() * spin;
  if (diagonal < 0.01) object->angular_velocity *= n->uniform(0, 1);
}

/** Bodies in a lattice above the ground. @param base [m] its lowest place */
inline void addBodies(SceneNumbers* n, const SceneTraits& traits, int count, const Vector3& base, RandomScene* scene) {
  std::string kinds;
  const double cell = traits.pitch * traits.size * std::max(1.0, std::sqrt(traits.size_spread));
  double lightest = INFINITY, heaviest = 0;
  for (int i = 0; i < count; ++i) {
    const double diagonal =
        std::clamp(traits.size * n->spread(1 / std::sqrt(traits.size_spread), std::sqrt(traits.size_spread)), 1e-3, 10.0);
    std::string kind;
    Vector3 extent;
    sim::ObjectConfig object = randomShape(n, fmt::format("body{}", i), diagonal, &kind, &extent);
    const double weight = n->uniform(100, 8000) * extent.prod();
    object.mass = traits.any_mass ? n->spread(1e-3, 1e3) : weight;
    const int c = traits.columns;
    const Vector3 place(i % c - 0.5 * (c - 1), i / c % c - 0.5 * (c - 1), i / (c * c));
    const Vector3 jitter = n->within(0.05 * cell);
    object.X_WO = makePose(base + cell * place + jitter + Vector3(0, 0, 0.6 * cell), n->direction() * n->uniform(0, M_PI));
    object.contact.boundary_width = std::min(0.0025, 0.05 * extent.minCoeff());
    if (n->chance(0.2)) object.contact.friction = n->uniform(0, 1.5);
    moveAtStart(n, traits, diagonal, &object);
    lightest = std::min(lightest, *object.mass);
    heaviest = std::max(heaviest, *object.mass);
    if (kinds.find(kind) == std::string::npos) kinds += (kinds.empty() ? "" : "/") + kind;
    scene->config.objects.push_back(object);
  }
  scene->description += fmt::format(", {} x {} of {:.2g} m (x {:.2g}), {:.2g} to {:.2g} kg{}{}{}", count, kinds, traits.size,
                                    traits.size_spread, lightest, heaviest, traits.pitch < 1 ? ", overlapping" : "",
                                    traits.throws > 0 ? ", thrown" : "", traits.spins > 0 ? ", spinning" : "");
}

/** Four boards around the origin. @param inner [m] between opposite ones */
inline void addWalls(double inner, RandomScene* scene) {
  const double wall = 0.2 * inner;
  for (int side = 0; side < 4; ++side) {
    sim::EnvironmentConfig board;
    board.name = fmt::format("wall{}", side);
    board.uri = sim::meshFile("unit_cube", geometry::boxMesh(Vector3::Ones()));
    board.scale = side < 2 ? Vector3(wall, inner + 2 * wall, inner) : Vector3(inner + 2 * wall, wall, inner);
    const double at = (side % 2 == 0 ? 0.5 : -0.5) * (inner + wall);
    board.X_WE = makePose({side < 2 ? at : 0, side < 2 ? 0 : at, 0.45 * inner});
    scene->config.environments.push_back(board);
  }
}

/** Static: a large sheet, a half-space, a tray, or nothing. */
inline void addGround(SceneNumbers* n, const SceneTraits& traits, RandomScene* scene) {
  const int kind = n->count(0, 9);
  if (kind == 0) {
    scene->description += "no ground";
    return;
  }
  scene->floor = 0;
  if (kind <= 2) {
    sim::EnvironmentConfig plane;
    plane.name = "ground";
    plane.plane = Eigen::Vector4d(0, 0, 1, 0);
    scene->config.environments.push_back(plane);
    scene->description += "half-space";
    return;
  }
  scene->config.environments.push_back(sim::ground(1000));
  scene->description += kind >= 8 ? "tray" : "sheet";
  if (kind < 8) return;
  addWalls(traits.size * (traits.columns + 1) * traits.pitch * std::sqrt(traits.size_spread), scene);
}

/** Gravity, surfaces and the step. */
inline void setConditions(SceneNumbers* n, RandomScene* scene) {
  sim::SimulationConfig& config = scene->config;
  if (n->chance(0.08)) config.gravity = Vector3::Zero();
  if (n->chance(0.08)) config.gravity = 9.81 * (n->direction() - Vector3(0, 0, 2)).normalized();
  if (n->chance(0.1)) config.time_step = n->chance(0.5) ? 0.002 : 0.0005;
  config.contact.surface.friction = n->chance(0.1) ? 0 : n->uniform(0.1, 1.2);
  if (n->chance(0.25)) config.contact.surface.restitution = n->chance(0.3) ? 1 : n->uniform(0.1, 1);
  if (n->chance(0.12)) {
    config.contact.surface.stiffness = n->spread(1e2, 1e6);
    config.contact.surface.damping = config.contact.surface.stiffness * n->spread(1e-4, 1e-1);
    scene->passive = false;
  }
  scene->description += fmt::format(", mu {:.2g}", config.contact.surface.friction);
  if (config.gravity.isZero()) scene->description += ", weightless";
  if (config.time_step != 0.001) scene->description += fmt::format(", {} s steps", config.time_step);
  if (config.contact.surface.restitution > 0) scene->description += fmt::format(", e {:.2g}", config.contact.surface.restitution);
  if (!scene->passive)
    scene->description += fmt::format(", k {:.2g} N/m, d {:.2g} N s/m", config.contact.surface.stiffness, config.contact.surface.damping);
}

inline void addRobot(const RandomRobot& robot, RandomScene* scene) {
  scene->config.robots.push_back(robot.config);
  scene->commands.push_back(robot.command);
  scene->passive = scene->passive && !robot.driven;
  scene->description += ", " + robot.description;
}

inline RandomScene randomScene(std::uint64_t seed) {
  SceneNumbers n(seed);
  RandomScene scene;
  const SceneTraits traits = randomTraits(&n);
  scene.size = traits.size;
  addGround(&n, traits, &scene);
  setConditions(&n, &scene);
  const int robots = n.chance(0.4) ? n.count(1, 2) : 0;
  const double height = robots > 0 ? 8 * traits.size : 0;
  for (int i = 0; i < robots; ++i)
    addRobot(randomTree(&n, fmt::format("robot{}", i), {3.0 * i * traits.size, 0, 0.5 * height}, traits.size), &scene);
  if (n.chance(0.12)) {
    const double width = n.spread(0.02, 0.2);
    const Vector3 place(-10 * std::max(width, traits.size), 0, 5 * width);
    addRobot(randomHand(&n, "hand", place, width), &scene);
    sim::ObjectConfig held = sim::box("held", Vector3(width, 0.8 * width, 0.8 * width), 1000 * width * width * width, place);
    held.contact.friction = n.uniform(0.3, 1.5);
    scene.config.objects.push_back(held);
  }
  const int most = n.chance(0.5) ? 8 : 40;
  const int bodies = robots > 0 && n.chance(0.4) ? 0 : n.count(1, most);
  if (bodies > 0) addBodies(&n, traits, bodies, {0, 0, height}, &scene);
  return scene;
}

inline void commandRobots(const RandomScene& scene, sim::Simulator* simulator) {
  for (std::size_t i = 0; i < scene.commands.size(); ++i)
    if (!scene.commands[i].joints.empty()) simulator->commandJoints(static_cast<int>(i), scene.commands[i]);
}

}  // namespace blem_sim
