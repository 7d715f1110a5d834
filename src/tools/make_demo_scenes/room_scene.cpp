#include "room_scene.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::demo {

namespace {

constexpr double TILE = 0.30;       // [m] side of the floor's tiles
constexpr double MAX_EDGE = 0.045;  // [m] between neighbouring samples of one surface

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& part) {
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Vector3i& e : part.elements) mesh.elements.emplace_back(e + Vector3i::Constant(offset));
}

void appendBox(geometry::TriangleMesh& mesh, const Vector3& size, const Vector3& centre, const Vector3& rpy) {
  append(mesh, geometry::transformed(geometry::boxMesh(size), makePose(centre, rpy)));
}

// A floor of long waves of 1 mm, each tile laid up to 0.5 mm too high and a little askew; smaller near the origin, where the robot stands.
geometry::TriangleMesh unevenFloor() {
  geometry::TriangleMesh floor = geometry::gridMesh(4.4, 4.4, 220, 220);
  for (Vector3& v : floor.vertices) {
    const double waves = 0.6e-3 * std::sin(4.1 * v.x() + 0.7) + 0.5e-3 * std::sin(5.3 * v.y() - 1.1 * v.x());
    Noise tile(static_cast<std::uint64_t>(1000 + 100 * std::floor(v.x() / TILE) + std::floor(v.y() / TILE)));
    const double lift = 0.5e-3 * tile.uniform();
    const double slope_x = 2e-3 * (tile.uniform() - 0.5), slope_y = 2e-3 * (tile.uniform() - 0.5);
    const double far = std::min(1.0, v.head<2>().norm() / 0.8);
    const double tilted = slope_x * (v.x() - TILE * std::floor(v.x() / TILE)) + slope_y * (v.y() - TILE * std::floor(v.y() / TILE));
    v.z() = waves + (0.4 + 0.6 * far) * (lift + tilted);
  }
  return floor;
}

void appendStones(geometry::TriangleMesh& mesh) {
  Noise noise(7);
  for (int i = 0; i < 45; ++i) {
    const double angle = 2 * M_PI * noise.uniform(), distance = 0.62 + 1.0 * noise.uniform();
    const Vector3 size(0.02 + 0.03 * noise.uniform(), 0.02 + 0.03 * noise.uniform(), 0.012 + 0.018 * noise.uniform());
    const Pose X_WS = makePose({distance * std::cos(angle), distance * std::sin(angle), 0.2 * size.z()}, {0, 0, 3 * noise.uniform()});
    append(mesh, geometry::transformed(geometry::icosphereMesh(1.0, 2), X_WS, size));
  }
}

void appendBoards(geometry::TriangleMesh& mesh) {
  appendBox(mesh, {0.60, 0.14, 0.018}, {0.85, 0.10, 0.009}, {0, 0, 1.45});
  appendBox(mesh, {0.70, 0.12, 0.022}, {-0.15, 0.80, 0.011}, {0, 0, 0.10});
  appendBox(mesh, {0.50, 0.20, 0.015}, {-0.80, -0.25, 0.0075}, {0, 0, 1.75});
  appendBox(mesh, {0.45, 0.12, 0.030}, {0.10, -0.78, 0.015}, {0, 0, -0.25});
  appendBox(mesh, {0.40, 0.10, 0.020}, {0.35, -0.95, 0.040}, {0.05, 0, 0.9});
}

void appendClutter(geometry::TriangleMesh& mesh) {
  appendBox(mesh, {0.40, 0.30, 0.28}, {1.25, 0.75, 0.14}, {0, 0, 0.3});
  appendBox(mesh, {0.60, 0.50, 0.02}, {1.15, -0.70, 0.085}, {0, -0.26, -0.2});
  append(mesh, geometry::transformed(geometry::cylinderMesh(0.06, 0.9, 32), makePose({-1.10, 0.75, 0.45})));
  append(mesh, geometry::transformed(geometry::icosphereMesh(0.11, 3), makePose({-0.55, 1.15, 0.11})));
  append(mesh, geometry::transformed(geometry::cylinderMesh(0.05, 0.7, 24), makePose({-1.05, -0.85, 0.05}, {M_PI_2, 0, 0.6})));
  for (double x : {-0.17, 0.17}) {
    for (double y : {-0.17, 0.17}) appendBox(mesh, {0.035, 0.035, 0.42}, {0.35 + x, 1.35 + y, 0.21}, {0, 0, 0});
  }
  appendBox(mesh, {0.42, 0.42, 0.03}, {0.35, 1.35, 0.435}, {0, 0, 0});
}

// Dark spots everywhere on the floor, small ones under the robot's feet too.
std::vector<DarkSpot> darkSpots() {
  std::vector<DarkSpot> spots = {
      {{0.10, 0.13, 0}, 0.022}, {{-0.07, 0.06, 0}, 0.018}, {{0.03, -0.13, 0}, 0.025}, {{-0.10, -0.08, 0}, 0.020}};
  Noise noise(11);
  for (int i = 0; i < 60; ++i) {
    const Vector3 centre(3.2 * noise.uniform() - 1.6, 3.2 * noise.uniform() - 1.6, 0);
    spots.push_back({centre, (centre.head<2>().norm() < 0.4 ? 0.02 : 0.03) + 0.03 * noise.uniform()});
  }
  return spots;
}

// Registration error of a view: up to 1 mm along the floor, 0.4 mm in height and 0.5 mrad, as of scans put together by hand.
Pose registrationError(Noise& noise) {
  const auto part = [&](double size) { return size * (2 * noise.uniform() - 1); };
  return makePose({part(1e-3), part(1e-3), part(0.4e-3)}, {part(5e-4), part(5e-4), part(5e-4)});
}

std::vector<Pose> viewpoints() {
  return {lookAt({1.35, 0.15, 1.35}, {0.05, 0.0, 0}), lookAt({-0.75, 1.25, 1.40}, {0, 0.05, 0}), lookAt({-0.95, -1.05, 1.45}, {0.05, 0, 0}),
          lookAt({0.55, -1.30, 1.30}, {0.25, 0.20, 0})};
}

}  // namespace

Scene workshopFloor() {
  geometry::TriangleMesh mesh = unevenFloor();
  appendBoards(mesh);
  appendStones(mesh);
  appendClutter(mesh);
  return Scene(std::move(mesh), darkSpots());
}

geometry::TriangleMesh scannedFloor(const Scene& scene) {
  geometry::TriangleMesh scan;
  Noise noise(2013);
  for (const Pose& X_WC : viewpoints()) {
    DepthCamera camera;
    camera.X_WC = X_WC;
    const geometry::TriangleMesh sheet = triangulated(capture(scene, camera, noise), MAX_EDGE);
    append(scan, geometry::transformed(sheet, registrationError(noise)));
  }
  return scan;
}

std::vector<Vector3> scannedFloorPoints(const Scene& scene) {
  std::vector<Vector3> points;
  Noise noise(2014);
  const std::vector<Pose> views = viewpoints();
  for (int view = 0; view < 3; ++view) {
    DepthCamera camera;
    camera.X_WC = views[view];
    camera.stride = 3;
    camera.frames = 12;
    const DepthImage image = capture(scene, camera, noise);
    const Pose error = registrationError(noise);
    for (const auto& point : image.points) {
      if (point) points.push_back(error * *point);
    }
  }
  return points;
}

}  // namespace blem_sim::demo
