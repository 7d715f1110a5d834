// Depth images of 640 x 480 pixels of the largest shared scan (1,021,436 triangles), on one thread and on two; counter: images per second.
// Without the shared data, of a terrain as large. Arguments: Google Benchmark's.
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

sim::RangeView viewOf(std::shared_ptr<const geometry::TriangleMesh> mesh) {
  sim::RangeView view;
  const auto geometry = std::make_shared<const contact::CollisionGeometry>(std::move(mesh));
  // The whole scan in the image, as seen from in front of it.
  const Box& bounds = geometry->bounds();
  view.X_WS = makePose(bounds.center() + Vector3(-0.5 * bounds.sizes().x() - 0.8 * bounds.sizes().tail<2>().maxCoeff(), 0, 0));
  view.targets = {{geometry, Pose::Identity(), 0, 0}};
  return view;
}

void drawDepths(benchmark::State& state) {
  const auto file = sharedData("scans/synthetic_kinect/stepladder_1m.ply");
  static const sim::RangeView view =
      viewOf(file ? model::loadSurface(*file, Vector3::Ones()).mesh : std::make_shared<const geometry::TriangleMesh>(terrain()));
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  std::size_t hits = 0;
  for (auto _ : state) {
    const std::vector<float> depths = arena.execute([&] { return sim::depthsOf(view); });
    hits = depths.size() - static_cast<std::size_t>(std::count_if(depths.begin(), depths.end(), [](float d) { return std::isnan(d); }));
  }
  state.counters["hits"] = static_cast<double>(hits);
  state.counters["images_per_second"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(drawDepths)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace blem_sim

BENCHMARK_MAIN();
