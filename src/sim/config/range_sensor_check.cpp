#include "config/range_sensor_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace blem_sim::sim {
namespace {

constexpr double WIDEST = 3.1;         // [rad] a plane image has no room for half a circle
constexpr double ROUNDED = 1e-3;       // [rad] by which a whole or a quarter turn may be written too large, as in 6.28319 and 1.5708
constexpr double MOST_RAYS = 1 << 24;  // of a reading: 64 MB of float

std::optional<ConfigFault> faultOfCount(const char* key, int value) {
  if (value >= 1) return std::nullopt;
  return ConfigFault{key, fmt::format("is {}; give it a whole number of at least 1", value)};
}

std::optional<ConfigFault> faultOfRays(const char* key, double columns, double rows) {
  if (columns * rows <= MOST_RAYS) return std::nullopt;
  return ConfigFault{key, fmt::format("{} x {} rays are more than the {} that are cast; give fewer", columns, rows, MOST_RAYS)};
}

std::optional<ConfigFault> faultOfCamera(const RangeSensorConfig& rays) {
  if (auto fault = faultOfCount("width", rays.width)) return fault;
  if (auto fault = faultOfCount("height", rays.height)) return fault;
  if (!(rays.hfov > 0 && rays.hfov <= WIDEST))
    return ConfigFault{"hfov", fmt::format("is {}; give it an angle above 0 and at most {} rad", rays.hfov, WIDEST)};
  return faultOfRays("width", rays.width, rays.height);
}

/** The angles of the outer beams or layers, which lie at one place if there is but one. */
std::optional<ConfigFault> faultOfAngles(const char* key, double first, double last, bool several) {
  if (std::isfinite(first) && std::isfinite(last) && last - first <= 2 * M_PI + ROUNDED && (several ? first < last : first <= last))
    return std::nullopt;
  return ConfigFault{key, fmt::format("is [{}, {}]; give the smaller angle first, at most a turn apart [rad]", first, last)};
}

std::optional<ConfigFault> faultOfLidar(const RangeSensorConfig& rays) {
  if (auto fault = faultOfCount("beams", rays.beams)) return fault;
  if (auto fault = faultOfCount("layers", rays.layers)) return fault;
  if (auto fault = faultOfAngles("angle", rays.first_angle, rays.last_angle, rays.beams > 1)) return fault;
  if (rays.layers == 1 && (rays.lowest_angle != 0 || rays.highest_angle != 0))
    return ConfigFault{"vertical_angle",
                       "is there, but one layer lies in the plane of x and y; take it away, give more layers, or turn pose"};
  if (std::max(std::abs(rays.lowest_angle), std::abs(rays.highest_angle)) > M_PI / 2 + ROUNDED)
    return ConfigFault{"vertical_angle", "goes beyond straight up or down; give angles from -1.57 to 1.57 rad"};
  if (auto fault = faultOfAngles("vertical_angle", rays.lowest_angle, rays.highest_angle, rays.layers > 1)) return fault;
  return faultOfRays("beams", rays.beams, rays.layers);
}

}  // namespace

std::optional<ConfigFault> faultOf(SensorType type, const RangeSensorConfig& rays) {
  if (!isRangeSensor(type)) return std::nullopt;
  if (!(rays.nearest >= 0 && rays.nearest < rays.farthest && std::isfinite(rays.farthest)))
    return ConfigFault{"range", fmt::format("is [{}, {}]; give [near, far] in metres, 0 <= near < far", rays.nearest, rays.farthest)};
  if (!(rays.stddev >= 0 && std::isfinite(rays.stddev)))
    return ConfigFault{"noise.stddev", fmt::format("is {}; give it a finite number of at least 0", rays.stddev)};
  return type == SensorType::DEPTH_CAMERA ? faultOfCamera(rays) : faultOfLidar(rays);
}

}  // namespace blem_sim::sim
