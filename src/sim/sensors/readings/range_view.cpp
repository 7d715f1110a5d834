#include "blem_sim/sim/range_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "numbers/random_numbers.h"

namespace blem_sim::sim {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();
constexpr double DISPARITY_STEP = 2.85e-3;  // [1/m]
constexpr double DISPARITY_STDDEV = 0.5;    // steps

double between(double first, double last, int i, int count) { return count > 1 ? first + i * ((last - first) / (count - 1)) : first; }

/** The sensor's reading if its ray is hit at t. */
double rangeOf(const RangeView& view, std::size_t ray, double t) {
  if (t < view.rays.nearest) return -INFINITE;
  return t < INFINITE ? measuredRange(view, ray, t) : INFINITE;
}

/** A lidar's beams in fans: four of two layers, or eight of the only one; beyond the last layer and beam they repeat it. */
std::vector<float> drawBeams(const RangeView& view) {
  const contact::RayScene scene(view.targets);
  const contact::RayScene::Query query{view.rays.farthest, view.model, view.rays.nearest};
  const int layers = view.rays.layers, beams = view.rays.beams;
  const int height = std::min(layers, 2), width = contact::RayFan::WIDTH / height;
  std::vector<float> ranges(static_cast<std::size_t>(layers) * beams);
  tbb::parallel_for(0, (layers + height - 1) / height, [&](int band) {
    for (int first = 0; first < beams; first += width) {
      const auto layer = [&](int ray) { return std::min(band * height + ray / width, layers - 1); };
      const auto beam = [&](int ray) { return std::min(first + ray % width, beams - 1); };
      contact::RayFan fan{view.X_WS.translation(), {}};
      for (int ray = 0; ray < contact::RayFan::WIDTH; ++ray)
        fan.directions[ray] = view.X_WS.linear() * beamDirection(view.rays, layer(ray), beam(ray));
      const contact::RayScene::Hits hits = scene.firstHits(fan, query);
      for (int ray = 0; ray < contact::RayFan::WIDTH; ++ray) {
        const std::size_t place = static_cast<std::size_t>(layer(ray)) * beams + beam(ray);
        ranges[place] = static_cast<float>(rangeOf(view, place, hits[ray].t));
      }
    }
  });
  return ranges;
}

}  // namespace

contact::Pinhole pinholeOf(const RangeSensorConfig& camera) {
  return {camera.width, camera.height, camera.width / (2 * std::tan(camera.hfov / 2)), (camera.width - 1) / 2.0, (camera.height - 1) / 2.0};
}

Matrix3 opticalAxes() {
  Matrix3 R_SO;
  R_SO << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R_SO;
}

double beamAngle(const RangeSensorConfig& lidar, int beam) { return between(lidar.first_angle, lidar.last_angle, beam, lidar.beams); }
double layerAngle(const RangeSensorConfig& lidar, int layer) {
  return between(lidar.lowest_angle, lidar.highest_angle, layer, lidar.layers);
}

Vector3 beamDirection(const RangeSensorConfig& lidar, int layer, int beam) {
  const double up = layerAngle(lidar, layer), turn = beamAngle(lidar, beam);
  return {std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)};
}

double measuredRange(const RangeView& view, std::size_t ray, double range) {
  const RangeSensorConfig& rays = view.rays;
  if (rays.noise == RangeNoise::GAUSSIAN && rays.stddev == 0) return range;
  RandomNumbers random(RandomNumbers(view.noise_seed + ray).next());
  double measured = range + (rays.stddev > 0 ? rays.stddev * random.gaussian() : 0);
  if (rays.noise == RangeNoise::KINECT) {
    measured = std::clamp(measured, rays.nearest, rays.farthest);
    const double disparity = std::round(1 / (measured * DISPARITY_STEP) + DISPARITY_STDDEV * random.gaussian());
    measured = disparity > 0 ? 1 / (disparity * DISPARITY_STEP) : INFINITE;
  }
  return std::clamp(measured, rays.nearest, rays.farthest);
}

std::vector<float> depthsOf(const RangeView& camera) {
  const contact::DepthScene scene(camera.targets);
  const contact::PinholeRays rays{pinholeOf(camera.rays), camera.X_WS};
  const contact::RayScene::Query query{camera.rays.farthest, camera.model, camera.rays.nearest};
  const int rows = contact::DepthScene::BAND_ROWS, height = camera.rays.height, width = camera.rays.width;
  std::vector<float> depths(static_cast<std::size_t>(height) * width);
  tbb::parallel_for(0, (height + rows - 1) / rows, [&](int band) {
    std::vector<double> drawn(static_cast<std::size_t>(std::min(rows, height - band * rows)) * width);
    scene.drawBand(rays, query, band, drawn.data());
    const std::size_t first = static_cast<std::size_t>(band) * rows * width;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const float depth = static_cast<float>(rangeOf(camera, first + i, drawn[i]));
      depths[first + i] = std::isinf(depth) ? std::numeric_limits<float>::quiet_NaN() : depth;
    }
  });
  return depths;
}

std::vector<float> rangesOf(const RangeView& lidar) { return drawBeams(lidar); }

}  // namespace blem_sim::sim
