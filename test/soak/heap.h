// Heaps to be: cubes of twelve triangles thrown over a ground of two, or dropped into a bin.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"

namespace blem_sim {

/** Thirty cubes of 0.1 m and 1 kg in five layers, turned, spinning and falling as the seed says. */
inline sim::SimulationConfig heapOfCubes(int seed, const dynamics::SolverSettings& solver) {
  sim::SimulationConfig config;
  config.solver = solver;
  config.environments = {sim::ground(8)};
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53; };
  const auto vector = [&](double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return Vector3(x, y, z);
  };
  for (int i = 0; i < 30; ++i) {
    const Vector3 centre(0.2 * (i % 3) - 0.2, 0.2 * (i / 3 % 2) - 0.1, 0.2 + 0.2 * (i / 6));
    sim::ObjectConfig cube = sim::box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, Vector3::Zero());
    cube.X_WO = makePose(centre, vector(M_PI));
    cube.linear_velocity = vector(0.5);
    cube.angular_velocity = vector(5);
    config.objects.push_back(cube);
  }
  return config;
}

/** Columns of cubes along each side of the bin that holds so many: the next whole cube root. */
inline int heapColumns(int count) {
  int columns = 1;
  while (columns * columns * columns < count) ++columns;
  return columns;
}
constexpr double HEAP_SPACING = 0.18;  // [m] between the centres of cubes at the start: beyond the diagonal of one
/** [m] between opposite walls of that bin. */
inline double heapBinWidth(int count) { return HEAP_SPACING * heapColumns(count) + 0.02; }
/** [m] from its floor to the upper edge of its walls, above every cube at the start. */
inline double heapBinHeight(int count) { return HEAP_SPACING * (heapColumns(count) + 2); }

/** Pose of each piece of a heap at the start: turned at random by the seed, layer upon layer of columns x columns, the lowest 0.1 m up. */
inline std::vector<Pose> heapPoses(int count, int seed, double spacing = HEAP_SPACING) {
  const int columns = heapColumns(count);
  std::mt19937_64 generator(seed);
  const auto normal = [&] {  // by Box and Muller: the standard library's own differ between libraries
    const double u = static_cast<double>((generator() >> 11) + 1) * 0x1p-53, turn = static_cast<double>(generator() >> 11) * 0x1p-53;
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * turn);
  };
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double w = normal(), x = normal(), y = normal(), z = normal();
    const double middle = 0.5 * (columns - 1);
    Pose X_WC(Quaternion(w, x, y, z).normalized());
    X_WC.translation() = spacing * Vector3(i % columns - middle, i / columns % columns - middle, i / (columns * columns)) +
                         Vector3(0, 0, 0.1 + 0.5 * spacing);
    poses.push_back(X_WC);
  }
  return poses;
}

/** A floor and four walls of two triangles each, open at the top, wound towards the inside; the floor's middle is the origin. */
inline geometry::TriangleMesh binMesh(double width, double height) {
  geometry::TriangleMesh mesh =
      geometry::transformed(geometry::boxMesh(Vector3(width, width, height)), makePose(Vector3(0, 0, 0.5 * height)));
  std::vector<Vector3i> inside;
  for (const Vector3i& e : mesh.elements) {
    const bool lid = mesh.vertices[e[0]].z() > 0 && mesh.vertices[e[1]].z() > 0 && mesh.vertices[e[2]].z() > 0;
    if (!lid) inside.emplace_back(e[0], e[2], e[1]);
  }
  mesh.elements = inside;
  return mesh;
}

/** [m] */
inline sim::EnvironmentConfig bin(double width, double height) {
  sim::EnvironmentConfig bin;
  bin.name = "bin";
  bin.uri = sim::meshFile("bin_" + std::to_string(width) + "_" + std::to_string(height), binMesh(width, height));
  return bin;
}

/** Cubes of 0.1 m and 1 kg, friction 0.5, at rest at the start, in a bin a little wider than their columns. */
inline sim::SimulationConfig heapInBin(int count, int seed, const dynamics::SolverSettings& solver) {
  sim::SimulationConfig config;
  config.solver = solver;
  config.environments = {bin(heapBinWidth(count), heapBinHeight(count))};
  config.contact.surface.friction = 0.5;
  sim::ObjectConfig cube = sim::box("cube", Vector3::Constant(0.1), 1, Vector3::Zero());
  for (const Pose& X_WC : heapPoses(count, seed)) {
    cube.name = "cube" + std::to_string(config.objects.size());
    cube.X_WO = X_WC;
    config.objects.push_back(cube);
  }
  return config;
}

constexpr double POURED_RADIUS = 0.015, POURED_MASS = 0.03, POURED_SPACING = 0.035;  // [m, kg]
constexpr double POURED_SHIFT = 0.002;                                               // [m] at most: a lattice would stand as columns

/** Centres of poured spheres at the start: a lattice, each shifted as the seed says. */
inline std::vector<Pose> pouredPoses(int count, int seed) {
  std::vector<Pose> poses = heapPoses(count, seed, POURED_SPACING);
  for (Pose& pose : poses) pose = makePose(pose.translation() + POURED_SHIFT * pose.linear().col(0));
  return poses;
}
/** [m] between opposite walls of their bin, and its height. */
inline double pouredBinWidth(int count) { return POURED_SPACING * heapColumns(count) + 0.01; }
inline double pouredBinHeight(int count) { return 0.1 + POURED_SPACING * (heapColumns(count) + 2); }

/** Exact spheres of 15 mm and 30 g, friction 0.5, at rest at the start, over a bin a little wider than their columns. */
inline sim::SimulationConfig spheresInBin(int count, int seed, const dynamics::SolverSettings& solver) {
  sim::SimulationConfig config;
  config.solver = solver;
  config.environments = {bin(pouredBinWidth(count), pouredBinHeight(count))};
  config.contact.surface.friction = 0.5;
  sim::ObjectConfig sphere;
  sphere.urdf = sim::sceneFile("poured_sphere.urdf", [](std::ofstream& out) {
    const double i = 0.4 * POURED_MASS * POURED_RADIUS * POURED_RADIUS;
    out << "<robot name=\"sphere\"><link name=\"link\"><inertial><mass value=\"" << POURED_MASS << "\"/><inertia ixx=\"" << i << "\" iyy=\""
        << i << "\" izz=\"" << i << "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><sphere radius=\"" << POURED_RADIUS
        << "\"/></geometry></collision></link></robot>";
  });
  for (const Pose& X_WC : pouredPoses(count, seed)) {
    sphere.name = "sphere" + std::to_string(config.objects.size());
    sphere.X_WO = X_WC;
    config.objects.push_back(sphere);
  }
  return config;
}

/** A shape and a mass that pieces of a pile have, and their friction 0.5. */
struct PileShape {
  const char* name;
  geometry::TriangleMesh mesh;
  double mass;  ///< [kg]
};

constexpr double PILE_LAYER = 0.001;  // [m] of small parts: each is so much larger on every side

/** Small parts of these shapes in turn, at rest at the start, turned at random, over a bin a little wider than their columns. */
inline sim::SimulationConfig pileInBin(const std::vector<PileShape>& shapes, int count, double spacing, int seed,
                                       const dynamics::SolverSettings& solver) {
  sim::SimulationConfig config;
  config.solver = solver;
  config.contact.boundary_width = PILE_LAYER;
  config.contact.surface.friction = 0.5;
  config.environments = {bin(spacing * heapColumns(count) + 0.01, 0.1 + spacing * (heapColumns(count) + 2))};
  for (const Pose& X_WC : heapPoses(count, seed, spacing)) {
    const PileShape& shape = shapes[config.objects.size() % shapes.size()];
    sim::ObjectConfig part;
    part.name = "part" + std::to_string(config.objects.size());
    part.uri = sim::meshFile(shape.name, shape.mesh);
    part.mass = shape.mass;
    part.X_WO = X_WC;
    config.objects.push_back(part);
  }
  return config;
}

/** Steel rods of 6 x 6 x 45 mm. */
inline sim::SimulationConfig rodsInBin(int count, int seed, const dynamics::SolverSettings& solver) {
  return pileInBin({{"pile_rod", geometry::boxMesh({0.006, 0.006, 0.045}), 0.0127}}, count, 0.05, seed, solver);
}

/** Blocks, hexagonal nuts, wedges and plates of 2 to 3 cm. */
inline sim::SimulationConfig partsInBin(int count, int seed, const dynamics::SolverSettings& solver) {
  const std::vector<PileShape> shapes = {{"pile_block", geometry::boxMesh({0.03, 0.02, 0.015}), 0.025},
                                         {"pile_nut", geometry::cylinderMesh(0.012, 0.01, 6), 0.012},
                                         {"pile_wedge", geometry::cylinderMesh(0.015, 0.02, 3), 0.01},
                                         {"pile_plate", geometry::boxMesh({0.03, 0.03, 0.005}), 0.015}};
  return pileInBin(shapes, count, 0.045, seed, solver);
}

}  // namespace blem_sim
