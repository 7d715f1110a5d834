// One 64-bit seed makes one scene of things that roll: coins, cans, logs, wheels, carts and rollers, nasty ones among them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "support/random/random_scene.h"
#include "support/random/round_robots.h"

namespace blem_sim {

/** Start of round things. */
struct RoundPlace {
  double size = 0;                     ///< [m] of things, typically
  Vector3 base = Vector3::Zero();      ///< [m] on the ground
  double hole = 0;                     ///< [m] inner radius of a tube that stands there; 0: none
  std::vector<double> radii, heights;  ///< [m] of the columns of a stack, and their tops
};

/** A tube about z, open at both ends. */
inline geometry::TriangleMesh tubeMesh(double inner, double outer, double length, int sides) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * i / sides;
    for (const double radius : {inner, outer})
      for (const double z : {0.0, length}) mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  for (int i = 0; i < sides; ++i) {
    const int a = 4 * i, b = 4 * ((i + 1) % sides);  // inner lower, inner upper, outer lower, outer upper
    const std::array<std::array<int, 4>, 4> quads{
        {{b, a, a + 1, b + 1}, {a + 2, b + 2, b + 3, a + 3}, {a, b, b + 2, a + 2}, {b + 1, a + 1, a + 3, b + 3}}};
    for (const auto& q : quads) {
      mesh.elements.emplace_back(q[0], q[1], q[2]);
      mesh.elements.emplace_back(q[0], q[2], q[3]);
    }
  }
  return mesh;
}

inline sim::EnvironmentConfig meshGround(const std::string& name, const geometry::TriangleMesh& mesh) {
  sim::EnvironmentConfig environment;
  environment.name = name;
  environment.uri = sim::meshFile("round_" + name, mesh);
  return environment;
}

/** Triangles, level or rough. @return [m] the highest */
inline double addTiles(SceneNumbers* n, double size, RandomScene* scene) {
  const double cell = size * n->spread(0.1, 3), rough = n->chance(0.4) ? 0 : cell * n->spread(0.01, 0.5);
  const int cells = n->count(4, 40);
  geometry::TriangleMesh mesh = geometry::gridMesh(cell * cells, cell * cells, cells, cells);
  for (Vector3& v : mesh.vertices) v.z() += rough * n->uniform(-1, 1);
  scene->config.environments.push_back(meshGround("tiles", mesh));
  scene->config.environments.push_back(sim::ground(1000));
  scene->config.environments.back().X_WE = makePose({0, 0, -2 * rough - size});
  scene->floor = -2 * rough - size;
  scene->description += fmt::format("{} x {} tiles of {:.2g} m, rough by {:.2g}", cells, cells, cell, rough);
  return rough;
}

/** Steps that lead down along x from the origin on. @return [m] height of the uppermost */
inline double addSteps(SceneNumbers* n, double size, RandomScene* scene) {
  const double rise = size * n->spread(0.05, 1.5), run = size * n->spread(0.3, 5);
  constexpr int STEPS = 6;
  for (int i = 0; i < STEPS; ++i) {
    sim::EnvironmentConfig step;
    step.name = fmt::format("step{}", i);
    step.uri = sim::meshFile("unit_cube", geometry::boxMesh(Vector3::Ones()));
    const double height = rise * (STEPS - i), length = i == 0 ? 10 * size : run;
    step.scale = {length, 20 * size, height};
    step.X_WE = makePose({i == 0 ? size - 0.5 * length : size + run * (i - 0.5), 0, 0.5 * height});
    scene->config.environments.push_back(step);
  }
  scene->config.environments.push_back(sim::ground(1000));
  scene->floor = 0;
  scene->description += fmt::format("steps of {:.2g} by {:.2g} m", rise, run);
  return rise * STEPS;
}

inline void addTube(SceneNumbers* n, RoundPlace* place, RandomScene* scene) {
  place->hole = place->size * n->uniform(0.3, 1);
  const int sides = n->count(5, 64);
  const double outer = place->hole * (1 + n->spread(0.02, 1));
  scene->config.environments.push_back(meshGround("tube", tubeMesh(place->hole, outer, place->size * n->uniform(1, 6), sides)));
  scene->config.environments.push_back(sim::ground(1000));
  scene->floor = 0;
  scene->description += fmt::format("tube of {} sides, {:.2g} m", sides, place->hole);
}

/** Static: half-space, sheet, tray, tiles, steps or a tube. */
inline void addRoundGround(SceneNumbers* n, RoundPlace* place, RandomScene* scene) {
  const int kind = n->count(0, 9);
  if (kind <= 1) {
    sim::EnvironmentConfig plane;
    plane.name = "ground";
    plane.plane = Eigen::Vector4d(0, 0, 1, 0);
    scene->config.environments.push_back(plane);
    scene->floor = 0;
    scene->description += "half-space";
  } else if (kind <= 5) {
    place->base.z() = addTiles(n, place->size, scene);
  } else if (kind == 6) {
    place->base.z() = addSteps(n, place->size, scene);
  } else if (kind == 7) {
    addTube(n, place, scene);
  } else {
    scene->config.environments.push_back(sim::ground(1000));
    scene->floor = 0;
    scene->description += kind == 8 ? "tray" : "sheet";
    if (kind == 8) addWalls(place->size * n->uniform(6, 14), scene);
  }
}

/** Turns a thing that was placed by a lean, a heading and an upright spin. */
inline void spinAtStart(SceneNumbers* n, double size, sim::ObjectConfig* object) {
  const double fast = n->spread(1, n->chance(0.1) ? 1000 : 100);
  const int kind = n->count(0, 3);
  const Vector3 axis = object->X_WO.linear().col(2);
  if (kind == 1) object->angular_velocity = fast * axis;
  if (kind == 2) object->angular_velocity = fast * Vector3::UnitZ();
  if (kind == 3) object->angular_velocity = fast * n->direction();
  if (n->chance(0.3)) object->linear_velocity = Vector3(n->uniform(-1, 1), n->uniform(-1, 1), 0) * n->spread(0.1, 100) * std::sqrt(size);
}

/** One above the other, standing. */
inline void stackRound(SceneNumbers* n, const RoundShape& shape, RoundPlace* place, sim::ObjectConfig* object) {
  const std::size_t columns = 3, column = static_cast<std::size_t>(n->count(0, columns - 1));
  place->heights.resize(columns, 0);
  const double layer = object->contact.boundary_width->metres, half = 0.5 * shape.length;
  double& height = place->heights[column];
  object->X_WO = standingAt(
      place->base + Vector3(2.5 * place->size * (static_cast<double>(column) - 1), 0, height + half + n->uniform(-0.1, 0.3) * layer), 0, 0,
      n->uniform(-M_PI, M_PI));
  height += 2 * half;
}

/** Lying along y, beside the ones before, at rest or rolling along x. @param i how many lie already */
inline void layRound(SceneNumbers* n, const RoundShape& shape, int i, const RoundPlace& place, sim::ObjectConfig* object) {
  const double radius = shape.radius, x = 1.05 * place.size * (i % 5 - 2), z = 1.2 * place.size * (i / 5);
  object->X_WO =
      standingAt(place.base + Vector3(x, n->uniform(-0.2, 0.2) * place.size, radius + z), M_PI / 2, M_PI / 2, n->uniform(-M_PI, M_PI));
  if (n->chance(0.4)) return;
  const double speed = n->uniform(-1, 1) * n->spread(0.1, 100) * std::sqrt(place.size);
  object->linear_velocity = {speed, 0, 0};
  object->angular_velocity = {0, n->chance(0.5) ? speed / radius : n->uniform(-300, 300), 0};
}

/** Leaning on its rim, in the hole if there is one. @param i how many lean already */
inline void leanRound(SceneNumbers* n, const RoundShape& shape, int i, const RoundPlace& place, sim::ObjectConfig* object) {
  const bool in_hole = place.hole > 0;
  const double lean = in_hole ? n->uniform(-0.05, 0.05) : n->chance(0.3) ? n->spread(1e-6, 0.2) : n->uniform(0, M_PI / 2);
  const Vector3 beside =
      in_hole ? Vector3(0, 0, 1.2 * place.size * i) : Vector3(2.5 * place.size * (i % 5 - 2), 2.5 * place.size * (i / 5), 0);
  const double height = reachBelow(shape, lean);
  object->X_WO = standingAt(place.base + beside + Vector3(0, 0, height), lean, n->uniform(-M_PI, M_PI), n->uniform(-M_PI, M_PI));
  spinAtStart(n, place.size, object);
}

/** Thrown from anywhere above. */
inline void throwRound(SceneNumbers* n, int i, const RoundPlace& place, sim::ObjectConfig* object) {
  const Vector3 at(1.5 * place.size * (i % 3 - 1), 1.5 * place.size * (i / 3 % 3 - 1), 1.5 * place.size * (1 + i / 9));
  object->X_WO = makePose(place.base + at, n->direction() * n->uniform(0, M_PI));
  object->linear_velocity = n->direction() * n->spread(0.1, 30);
  spinAtStart(n, place.size, object);
}

/** Round things, one in five of another kind among them. */
inline void addRoundBodies(SceneNumbers* n, int count, RoundPlace* place, RandomScene* scene) {
  const int start = place->hole > 0 ? 2 : n->count(0, 3);
  const bool any_mass = n->chance(0.35);
  std::string kinds;
  for (int i = 0; i < count; ++i) {
    const double size = place->size * n->uniform(0.4, 1);
    RoundShape shape = randomRound(n, size);
    if (place->hole > 0) shape.radius = std::min(shape.radius, place->hole * n->uniform(0.5, 0.97));
    const std::string name = fmt::format("body{}", i);
    sim::ObjectConfig object = roundObject(n, name, shape);
    if (start == 0) stackRound(n, shape, place, &object);
    if (start == 1) layRound(n, shape, i, *place, &object);
    if (start == 2) leanRound(n, shape, i, *place, &object);
    if (start == 3) throwRound(n, i, *place, &object);
    if (any_mass) object.mass = n->spread(1e-3, 1e3);
    if (kinds.find(shape.kind) == std::string::npos) kinds += (kinds.empty() ? "" : "/") + shape.kind;
    scene->config.objects.push_back(object);
  }
  scene->description +=
      fmt::format(", {} x {} of {:.2g} m {}{}", count, kinds, place->size,
                  std::array{"stacked", "lying", place->hole > 0 ? "in it" : "leaning", "thrown"}[start], any_mass ? ", any mass" : "");
}

/** Balls, boxes, meshes and capsules that fall onto the rest. */
inline void addOthers(SceneNumbers* n, const RoundPlace& place, RandomScene* scene) {
  const int count = n->count(1, 6);
  for (int i = 0; i < count; ++i) {
    const double size = place.size * n->uniform(0.3, 1);
    const std::string name = fmt::format("other{}", i);
    std::string kind = "capsule";
    Vector3 extent = Vector3::Constant(size);
    sim::ObjectConfig object = n->chance(0.25) ? capsuleObject(n, name, size) : randomShape(n, name, size, &kind, &extent);
    if (kind != "capsule") {
      object.mass = n->uniform(100, 8000) * extent.prod();
      object.contact.boundary_width = std::min(0.0025, 0.05 * extent.minCoeff());
      object.contact.shrink = false;
    }
    object.X_WO = makePose(place.base + place.size * Vector3(n->uniform(-2, 2), n->uniform(-2, 2), 4 + 1.2 * i),
                           n->direction() * n->uniform(0, M_PI));
    scene->config.objects.push_back(object);
    scene->description += ", " + kind;
  }
}

/** A hand that closes on a cylinder. */
inline void addGrasp(SceneNumbers* n, const RoundPlace& place, RandomScene* scene) {
  const double width = n->spread(0.005, 0.2);
  const Vector3 at = place.base + Vector3(-10 * std::max(width, place.size), 0, 5 * width);
  addRobot(randomHand(n, "hand", at, width), scene);
  sim::ObjectConfig held = roundObject(n, "held", {"held", 0.5 * width, width * n->spread(0.1, 2), n->uniform(0, 1)});
  held.X_WO = standingAt(at, n->chance(0.5) ? 0 : M_PI / 2, n->chance(0.7) ? M_PI / 2 : n->uniform(-M_PI, M_PI), n->uniform(-M_PI, M_PI));
  scene->config.objects.push_back(held);
}

inline RandomScene roundScene(std::uint64_t seed) {
  SceneNumbers n(seed + 7000000);
  RandomScene scene;
  RoundPlace place;
  scene.size = place.size = n.chance(0.3) ? n.spread(1e-3, 1) : n.spread(0.02, 0.2);
  scene.watches_walls = true;
  addRoundGround(&n, &place, &scene);
  setConditions(&n, &scene);
  if (n.chance(0.3)) scene.config.contact.surface.friction = n.uniform(0, 1.5);
  scene.config.contact.shrink = n.chance(0.3);
  const int robot = n.count(0, 9);
  const Vector3 beside = place.base + Vector3(place.hole > 0 ? 12 * place.size : 0, 0, 0);  // a tube has no room
  if (robot <= 1) addRobot(randomCart(&n, "cart", beside, place.size), &scene);
  if (robot == 2) addRobot(randomRollers(&n, "rollers", beside, place.size * n.uniform(0.3, 1)), &scene);
  if (robot == 3) addGrasp(&n, place, &scene);
  if (robot <= 2 && place.hole == 0) place.base.z() += 2.5 * place.size;
  const int most = n.chance(0.7) ? 6 : 25;
  addRoundBodies(&n, n.count(1, most), &place, &scene);
  if (n.chance(0.3)) addOthers(&n, place, &scene);
  return scene;
}

/** A scene of a kind. @param round things that roll */
inline RandomScene sceneOf(std::uint64_t seed, bool round) { return round ? roundScene(seed) : randomScene(seed); }

}  // namespace blem_sim
