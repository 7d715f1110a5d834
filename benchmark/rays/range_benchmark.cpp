// Depth images of 640 x 480 pixels of the largest shared scan (1,021,436 triangles), on one thread and on two, beside rays that look for
// their triangles; counter: images per second. Without the shared data, of a terrain as large. Arguments: Google Benchmark's.
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "blem_sim/model/loaders.h"
#include "blem_sim/sim/range_view.h"
#include "geometry/random_shapes.h"
#include "support/shared_data.h"

namespace blem_sim {
namespace {

/** An open grid of 1,002,528 triangles with noise, standing 2 m ahead as a wall. */
geometry::TriangleMesh terrain() {
  geometry::RandomShapes random(5);
  geometry::TriangleMesh grid = geometry::gridMesh(3, 3, 708, 708);
  for (Vector3& v : grid.vertices) v.z() = random.uniform(-2.5e-4, 2.5e-4);
  return geometry::transformed(grid, makePose({2, 0, 0}, {0, M_PI / 2, 0}));
}

std::shared_ptr<const contact::CollisionGeometry> scan() {
  const auto file = sharedData("scans/synthetic_kinect/stepladder_1m.ply");
  return std::make_shared<const contact::CollisionGeometry>(file ? model::loadSurface(*file, Vector3::Ones()).mesh
                                                                 : std::make_shared<const geometry::TriangleMesh>(terrain()));
}

sim::RangeView viewFrom(const Pose& X_WS) {
  static const std::shared_ptr<const contact::CollisionGeometry> geometry = scan();
  sim::RangeView view;
  view.X_WS = X_WS;
  view.targets = {{geometry, Pose::Identity(), 0, 0}};
  return view;
}

/** The whole scan in the image, as seen from in front of it. */
sim::RangeView whole() {
  const Box bounds = viewFrom(Pose::Identity()).targets[0].geometry->bounds();
  return viewFrom(makePose(bounds.center() + Vector3(-0.5 * bounds.sizes().x() - 0.8 * bounds.sizes().tail<2>().maxCoeff(), 0, 0)));
}

/** As a humanoid sees it that stands before it and looks down at 0.5 rad. */
sim::RangeView fromAHead() { return viewFrom(makePose({-0.45, 0, 1.45}, {0, 0.5, 0})); }

template <sim::RangeView (*VIEW)()>
void drawDepths(benchmark::State& state) {
  const sim::RangeView view = VIEW();
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  std::size_t hits = 0;
  for (auto _ : state) {
    const std::vector<float> depths = arena.execute([&] { return sim::depthsOf(view); });
    hits = depths.size() - static_cast<std::size_t>(std::count_if(depths.begin(), depths.end(), [](float d) { return std::isnan(d); }));
  }
  state.counters["hits"] = static_cast<double>(hits);
  state.counters["images_per_second"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}

/** The same depths by fans of rays that look for triangles, on one thread. */
template <sim::RangeView (*VIEW)()>
void followRays(benchmark::State& state) {
  const sim::RangeView view = VIEW();
  const contact::PinholeRays rays{sim::pinholeOf(view.rays), view.X_WS};
  const contact::RayScene scene(view.targets);
  std::size_t hits = 0;
  for (auto _ : state) {
    hits = 0;
    for (int row = 0; row < rays.pinhole.height; row += 2)
      for (int column = 0; column < rays.pinhole.width; column += 4) {
        contact::RayFan fan{view.X_WS.translation(), {}};
        for (int ray = 0; ray < contact::RayFan::WIDTH; ++ray) fan.directions[ray] = rays.direction(row + ray / 4, column + ray % 4);
        for (const contact::RayScene::Hit& hit : scene.firstHits(fan, {view.rays.farthest, -1, 0}))
          hits += hit.t >= view.rays.nearest && hit.target >= 0;
      }
  }
  state.counters["hits"] = static_cast<double>(hits);
}

BENCHMARK_TEMPLATE(drawDepths, whole)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_TEMPLATE(followRays, whole)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_TEMPLATE(drawDepths, fromAHead)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_TEMPLATE(followRays, fromAHead)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace blem_sim

BENCHMARK_MAIN();
