// Random points, poses and triangles, the same on every machine.
#pragma once

#include <cstdint>

#include "blem_sim/geometry/closest_points.h"

namespace blem_sim::geometry {

/** splitmix64; the standard library's distributions differ between implementations. */
class RandomShapes {
 public:
  explicit RandomShapes(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double uniform(double lower, double upper) { return lower + (upper - lower) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  int integer(int lower, int upper) { return lower + static_cast<int>(bits() % static_cast<std::uint64_t>(upper - lower + 1)); }

  Vector3 point(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return {x, y, z};
  }
  /** A corner of the integer grid: coincident, collinear and parallel things come up all the time. */
  Vector3 gridPoint(int size) {
    const int x = integer(0, size), y = integer(0, size), z = integer(0, size);
    return Vector3(x, y, z);
  }
  Pose pose(double size) {
    Pose pose = makePose(point(size), point(3.2));
    return pose;
  }
  Triangle triangle(double size) {
    const Vector3 a = point(size), b = point(size), c = point(size);
    return {a, b, c};
  }
  Triangle gridTriangle(int size) {
    const Vector3 a = gridPoint(size), b = gridPoint(size), c = gridPoint(size);
    return {a, b, c};
  }

 private:
  std::uint64_t state_;
};

inline Triangle operator*(const Pose& X, const Triangle& t) { return {X * t[0], X * t[1], X * t[2]}; }
inline Triangle moved(const Triangle& t, const Vector3& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

}  // namespace blem_sim::geometry
