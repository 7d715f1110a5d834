#include "depth_camera.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/ray_cast.h"

namespace blem_sim::demo {

namespace {

constexpr double FARTHEST = 3.5;          // [m]
constexpr double GRAZING = 0.12;          // cosine of the angle of incidence below which nothing comes back
constexpr double DROPOUT = 0.004;         // share of samples that fail for no visible reason
constexpr double DISPARITY_STEP = 0.125;  // [pixels]

Vector3 normalOf(const geometry::TriangleMesh& mesh, int element) {
  const Vector3i& e = mesh.elements[element];
  const Vector3& a = mesh.vertices[e[0]];
  return (mesh.vertices[e[1]] - a).cross(mesh.vertices[e[2]] - a).normalized();
}

bool isLit(const Scene& scene, const Vector3& point, const Vector3& projector) {
  return geometry::castRay({scene.bvh, scene.mesh}, {projector, point - projector}).t > 1 - 1e-3;
}

// Whether a dark spot swallows a sample; spots are ragged at the rim, where some samples come back.
bool isSwallowed(const Scene& scene, const Vector3& point, Noise& noise) {
  const double reach = 0.75 + 0.5 * noise.uniform();
  return std::any_of(scene.dark_spots.begin(), scene.dark_spots.end(),
                     [&](const DarkSpot& spot) { return (point - spot.centre).norm() < reach * spot.radius; });
}

// Mean of `frames` measurements of a depth. [m]
double measuredDepth(const DepthCamera& camera, double depth, Noise& noise) {
  const double sigma = 0.0012 + 0.0019 * (depth - 0.4) * (depth - 0.4);
  double sum = 0;
  for (int frame = 0; frame < camera.frames; ++frame) {
    const double disparity = camera.focal_length * camera.baseline / (depth + sigma * noise.normal());
    sum += camera.focal_length * camera.baseline / (DISPARITY_STEP * std::floor(disparity / DISPARITY_STEP + 0.5));
  }
  return sum / camera.frames;
}

}  // namespace

Pose lookAt(const Vector3& eye, const Vector3& target) {
  Pose X_WC = Pose::Identity();
  const Vector3 z = (target - eye).normalized();
  const Vector3 x = z.cross(Vector3::UnitZ()).normalized();
  X_WC.linear().col(0) = x;
  X_WC.linear().col(1) = z.cross(x);
  X_WC.linear().col(2) = z;
  X_WC.translation() = eye;
  return X_WC;
}

DepthImage capture(const Scene& scene, const DepthCamera& camera, Noise& noise) {
  DepthImage image;
  image.columns = camera.width / camera.stride;
  image.rows = camera.height / camera.stride;
  const Vector3 eye = camera.X_WC.translation();
  const Vector3 projector = camera.X_WC * Vector3(camera.baseline, 0, 0);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      image.points.emplace_back();
      const Vector3 direction_C(((column + 0.5) * camera.stride - 0.5 * camera.width) / camera.focal_length,
                                ((row + 0.5) * camera.stride - 0.5 * camera.height) / camera.focal_length, 1);
      const Vector3 direction = camera.X_WC.linear() * direction_C;
      const auto [depth, hit] = geometry::castRay({scene.bvh, scene.mesh}, {eye, direction});
      const bool dropped = noise.uniform() < DROPOUT;
      if (hit < 0 || dropped || depth > FARTHEST) continue;
      if (std::abs(normalOf(scene.mesh, hit).dot(direction.normalized())) < GRAZING) continue;
      if (isSwallowed(scene, eye + depth * direction, noise)) continue;
      if (!isLit(scene, eye + depth * direction, projector)) continue;
      image.points.back() = eye + measuredDepth(camera, depth, noise) * direction;
    }
  }
  return image;
}

geometry::TriangleMesh triangulated(const DepthImage& image, double max_edge) {
  geometry::TriangleMesh mesh;
  std::vector<int> vertex_of(image.points.size(), -1);
  const auto isShort = [&](int i, int j) { return (*image.points[i] - *image.points[j]).norm() <= max_edge; };
  const auto vertex = [&](int i) {
    if (vertex_of[i] < 0) {
      vertex_of[i] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(*image.points[i]);
    }
    return vertex_of[i];
  };
  const auto addTriangle = [&](int i, int j, int k) {
    if (!image.points[i] || !image.points[j] || !image.points[k]) return;
    if (!isShort(i, j) || !isShort(j, k) || !isShort(k, i)) return;
    const int a = vertex(i), b = vertex(j), c = vertex(k);
    mesh.elements.emplace_back(a, b, c);
  };
  for (int row = 0; row + 1 < image.rows; ++row) {
    for (int column = 0; column + 1 < image.columns; ++column) {
      // Triangles are wound so that their fronts show to the camera.
      const int i = row * image.columns + column, below = i + image.columns;
      addTriangle(i, below, i + 1);
      addTriangle(i + 1, below, below + 1);
    }
  }
  return mesh;
}

}  // namespace blem_sim::demo
