// Stacks of triangulated cubes in several engines, one after the other, in one run: distance from theory, calmness, speed.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "engine.h"

namespace blem_sim {
namespace {

const std::vector<EngineRow> ENGINES = {{"blem_sim, articulated", makeBlemSimArticulated},
                                        {"blem_sim, world_step", makeBlemSimWorldStep},
                                        {"ODE OPCODE, world step", makeOdeWorldStep},
                                        {"ODE OPCODE, quick step", makeOdeQuickStep},
                                        {"Bullet GImpact", makeBulletGimpact}};

double threadSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Outcome {
  double off = 0;               ///< [m] worst cube against theory at the end
  double square_speed = 0;      ///< [m^2/s^2] mean over the last second
  double fallen_at = INFINITY;  ///< [s] when a cube was half a cube off theory
  double seconds_per_step = 0;
};

double offTheory(const StackScene& scene, const Engine& engine) {
  const double size = scene.cube.bounds().sizes().z(), layer = engine.layer();
  const std::vector<CubeState> cubes = engine.cubes();
  double off = 0;
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const Vector3 theory(0, 0, 0.5 * size + layer + static_cast<double>(i) * (size + 2 * layer));
    off = std::max(off, (cubes[i].position - theory).norm());
  }
  return std::isfinite(off) ? off : INFINITY;
}

Outcome run(const EngineRow& row, const StackScene& scene, double seconds) {
  const std::unique_ptr<Engine> engine = row.make(scene);
  const int steps = static_cast<int>(std::lround(seconds / scene.time_step)), last_second = static_cast<int>(1 / scene.time_step);
  const double size = scene.cube.bounds().sizes().z(), settled = 1;
  Outcome outcome;
  const double start = threadSeconds();
  for (int k = 1; k <= steps; ++k) {
    engine->step();
    const double time = k * scene.time_step;
    if (time > settled && offTheory(scene, *engine) > 0.5 * size) outcome.fallen_at = std::min(outcome.fallen_at, time);
    if (k <= steps - last_second) continue;
    for (const CubeState& cube : engine->cubes()) outcome.square_speed += cube.velocity.squaredNorm() / (scene.cubes * last_second);
  }
  outcome.seconds_per_step = (threadSeconds() - start) / steps;
  outcome.off = offTheory(scene, *engine);
  return outcome;
}

void print(const EngineRow& row, const StackScene& scene, double seconds, const Outcome& o) {
  std::printf("%-24s %2d cubes %4.0f s  ", row.name.c_str(), scene.cubes, seconds);
  if (std::isfinite(o.fallen_at)) {
    std::printf("fallen within %5.2f s %34s", o.fallen_at, "");
  } else {
    std::printf("off theory %11.3e mm, rms speed %9.2e mm/s  ", 1e3 * o.off, 1e3 * std::sqrt(o.square_speed));
  }
  std::printf("%8.1f us a step\n", 1e6 * o.seconds_per_step);
  std::fflush(stdout);
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  if (!(seconds >= 2) || argc > 2) {
    std::fprintf(stderr, "usage: comparison [SECONDS >= 2]: stacks of 3 and 10 triangulated cubes in every engine\n");
    return 2;
  }
  StackScene scene;
  scene.cube = geometry::boxMesh(Vector3::Constant(0.1));
  scene.ground = geometry::gridMesh(4, 4, 1, 1);
  for (const int cubes : {3, 10}) {
    scene.cubes = cubes;
    for (const EngineRow& row : ENGINES) print(row, scene, seconds, run(row, scene, seconds));
  }
  return 0;
}
