// Engines that simulate the same stack of triangulated cubes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/** Cubes on a ground of two triangles, all as meshes, nothing asleep. Units m, kg, s; gravity 9.81 along -z. */
struct StackScene {
  geometry::TriangleMesh cube, ground;
  double mass = 1, friction = 0.5, time_step = 0.001;
  double gap = 0.01;  ///< [m] of air below each cube at the start
  int cubes = 3;
};

struct CubeState {
  Vector3 position, velocity;  ///< [m] of the centre above the ground's surface, [m/s]
};

/** One engine with a scene in it. */
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void step() = 0;
  virtual std::vector<CubeState> cubes() const = 0;
  /** Distance [m] of surfaces at rest, by the engine's own theory: boundary layers, margins. */
  virtual double layer() const { return 0; }
};

using MakeEngine = std::unique_ptr<Engine> (*)(const StackScene& scene);

struct EngineRow {
  std::string name;
  MakeEngine make;
};

std::unique_ptr<Engine> makeBlemSimArticulated(const StackScene& scene);
std::unique_ptr<Engine> makeBlemSimWorldStep(const StackScene& scene);
std::unique_ptr<Engine> makeOdeWorldStep(const StackScene& scene);
std::unique_ptr<Engine> makeOdeQuickStep(const StackScene& scene);
std::unique_ptr<Engine> makeBulletGimpact(const StackScene& scene);

}  // namespace blem_sim
