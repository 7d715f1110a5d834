#include "shells.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::demo {

namespace {

constexpr int SEGMENTS = 24;  // around an outline

// A closed curve at one height; of the same number of points as its neighbours. [m]
struct Section {
  double z;
  std::vector<Eigen::Vector2d> outline;  // counter-clockwise
};

// An outline between an ellipse (exponent 2) and a rectangle (large exponent).
Section oval(double z, double half_x, double half_y, double centre_x = 0, double exponent = 4) {
  Section section{z, {}};
  for (int i = 0; i < SEGMENTS; ++i) {
    const double angle = 2 * M_PI * (i + 0.5) / SEGMENTS, c = std::cos(angle), s = std::sin(angle);
    const double x = std::copysign(std::pow(std::abs(c), 2 / exponent), c), y = std::copysign(std::pow(std::abs(s), 2 / exponent), s);
    section.outline.emplace_back(centre_x + half_x * x, half_y * y);
  }
  return section;
}

// A sole: half an ellipse in front, rounded corners at the heel. `inset` [m] makes it smaller all around.
Section sole(double z, double heel, double toe, double half_width, double inset) {
  Section section{z, {}};
  const double w = half_width - inset, front = toe - inset - 0.045, back = -heel + inset;
  for (int i = 0; i <= 14; ++i) {
    const double angle = M_PI * (i / 14.0 - 0.5);
    section.outline.emplace_back(front + 0.045 * std::cos(angle), w * std::sin(angle));
  }
  for (double x : {0.6, 0.3}) section.outline.emplace_back(back + x * (front - back), w);
  for (double angle : {0.0, 30.0, 60.0, 90.0}) {
    const double a = angle * M_PI / 180;
    section.outline.emplace_back(back + 0.02 - 0.02 * std::sin(a), w - 0.02 + 0.02 * std::cos(a));
  }
  section.outline.emplace_back(back, 0);
  for (double angle : {90.0, 60.0, 30.0, 0.0}) {
    const double a = angle * M_PI / 180;
    section.outline.emplace_back(back + 0.02 - 0.02 * std::sin(a), -w + 0.02 - 0.02 * std::cos(a));
  }
  for (double x : {0.3, 0.6}) section.outline.emplace_back(back + x * (front - back), -w);
  return section;
}

// Closes an end by shrinking rings around the outline's middle, so that a large cap is not one fan of slivers.
void appendCap(geometry::TriangleMesh& mesh, int ring, int count, bool upwards) {
  constexpr int RINGS = 3;
  Vector3 middle = Vector3::Zero();
  for (int i = 0; i < count; ++i) middle += mesh.vertices[ring + i] / count;
  const auto add = [&](int a, int b, int c) { mesh.elements.emplace_back(upwards ? Vector3i(a, b, c) : Vector3i(a, c, b)); };
  const int outermost = ring;
  for (int r = 1; r < RINGS; ++r) {
    const int inner = static_cast<int>(mesh.vertices.size());
    for (int i = 0; i < count; ++i) {
      const Vector3 rim = mesh.vertices[outermost + i];
      mesh.vertices.push_back(middle + (1 - double(r) / RINGS) * (rim - middle));
    }
    for (int i = 0; i < count; ++i) {
      const int next = (i + 1) % count;
      add(ring + i, ring + next, inner + next);
      add(ring + i, inner + next, inner + i);
    }
    ring = inner;
  }
  const int centre = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(middle);
  for (int i = 0; i < count; ++i) add(ring + i, ring + (i + 1) % count, centre);
}

// Skin over sections from below upwards, with caps; closed and wound outwards.
geometry::TriangleMesh loft(const std::vector<Section>& sections) {
  geometry::TriangleMesh mesh;
  const int count = static_cast<int>(sections[0].outline.size());
  for (const Section& section : sections) {
    for (const Eigen::Vector2d& p : section.outline) mesh.vertices.emplace_back(p.x(), p.y(), section.z);
  }
  for (int row = 0; row + 1 < static_cast<int>(sections.size()); ++row) {
    for (int i = 0; i < count; ++i) {
      const int a = row * count + i, b = row * count + (i + 1) % count;
      mesh.elements.emplace_back(a, b, b + count);
      mesh.elements.emplace_back(a, b + count, a + count);
    }
  }
  appendCap(mesh, 0, count, false);
  appendCap(mesh, (static_cast<int>(sections.size()) - 1) * count, count, true);
  return mesh;
}

geometry::TriangleMesh pelvis() {
  return loft({oval(-0.045, 0.045, 0.070), oval(-0.025, 0.060, 0.095), oval(0.020, 0.065, 0.105), oval(0.050, 0.055, 0.080)});
}

geometry::TriangleMesh torso() {
  return loft({oval(0.005, 0.050, 0.070), oval(0.040, 0.065, 0.095), oval(0.150, 0.080, 0.125), oval(0.240, 0.082, 0.130),
               oval(0.280, 0.065, 0.105), oval(0.300, 0.035, 0.045), oval(0.320, 0.032, 0.038)});
}

geometry::TriangleMesh head() {
  return loft({oval(0.000, 0.030, 0.035, 0, 2.5), oval(0.020, 0.060, 0.058, 0.005, 2.5), oval(0.070, 0.078, 0.068, 0.008, 2.5),
               oval(0.110, 0.070, 0.062, 0.004, 2.5), oval(0.135, 0.040, 0.038, 0, 2.5)});
}

geometry::TriangleMesh upperArm() {
  return loft({oval(-0.185, 0.024, 0.024, 0, 2.5), oval(-0.150, 0.030, 0.030, 0, 2.5), oval(-0.030, 0.034, 0.032, 0, 2.5),
               oval(0.015, 0.036, 0.034, 0, 2.5), oval(0.035, 0.022, 0.022, 0, 2.5)});
}

geometry::TriangleMesh forearm() {
  return loft({oval(-0.230, 0.020, 0.016, 0, 2.5), oval(-0.215, 0.034, 0.020, 0, 3), oval(-0.165, 0.034, 0.022, 0, 3),
               oval(-0.145, 0.022, 0.020, 0, 2.5), oval(-0.060, 0.030, 0.028, 0, 2.5), oval(0.010, 0.028, 0.027, 0, 2.5),
               oval(0.025, 0.016, 0.016, 0, 2.5)});
}

geometry::TriangleMesh hipYaw() { return loft({oval(-0.010, 0.040, 0.036), oval(0.010, 0.044, 0.040), oval(0.040, 0.036, 0.034)}); }

geometry::TriangleMesh hipRoll() { return loft({oval(-0.040, 0.036, 0.034), oval(-0.005, 0.048, 0.038), oval(0.015, 0.040, 0.032)}); }

geometry::TriangleMesh thigh() {
  return loft({oval(-0.275, 0.030, 0.032, 0.004), oval(-0.240, 0.042, 0.042, 0.004), oval(-0.120, 0.050, 0.048, 0.004),
               oval(-0.030, 0.054, 0.050), oval(0.015, 0.036, 0.036)});
}

geometry::TriangleMesh shin() {
  return loft({oval(-0.235, 0.030, 0.030), oval(-0.200, 0.036, 0.035, -0.002), oval(-0.090, 0.046, 0.042, -0.008),
               oval(-0.010, 0.040, 0.040), oval(0.025, 0.026, 0.030)});
}

geometry::TriangleMesh anklePitch() { return loft({oval(-0.020, 0.030, 0.026), oval(0.000, 0.036, 0.032), oval(0.025, 0.030, 0.028)}); }

// The sole lies 60 mm below the ankle, 80 mm to the heel, 140 mm to the toe.
geometry::TriangleMesh foot() {
  return loft({sole(-0.060, 0.080, 0.140, 0.055, 0.003), sole(-0.057, 0.080, 0.140, 0.055, 0.000), sole(-0.042, 0.080, 0.140, 0.055, 0.001),
               sole(-0.030, 0.075, 0.110, 0.048, 0.004), sole(-0.012, 0.055, 0.070, 0.036, 0.000)});
}

}  // namespace

geometry::TriangleMesh gridBox(const Vector3& size, double cell) {
  geometry::TriangleMesh box;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int nu = std::max(1, static_cast<int>(std::lround(size[u] / cell))),
              nv = std::max(1, static_cast<int>(std::lround(size[v] / cell)));
    Pose face = Pose::Identity();
    face.linear().col(0) = Vector3::Unit(u);
    face.linear().col(1) = Vector3::Unit(v);
    face.linear().col(2) = Vector3::Unit(axis);
    for (double side : {-0.5, 0.5}) {
      face.translation() = side * size[axis] * Vector3::Unit(axis);
      geometry::TriangleMesh grid = geometry::transformed(geometry::gridMesh(size[u], size[v], nu, nv), face);
      const int offset = static_cast<int>(box.vertices.size());
      box.vertices.insert(box.vertices.end(), grid.vertices.begin(), grid.vertices.end());
      for (const Vector3i& e : grid.elements) {
        box.elements.emplace_back(offset + e[0], offset + (side < 0 ? e[2] : e[1]), offset + (side < 0 ? e[1] : e[2]));
      }
    }
  }
  return box;
}

std::vector<NamedMesh> humanoidShells() {
  return {{"pelvis", pelvis()},  {"torso", torso()},      {"head", head()},   {"upper_arm", upperArm()}, {"forearm", forearm()},
          {"hip_yaw", hipYaw()}, {"hip_roll", hipRoll()}, {"thigh", thigh()}, {"shin", shin()},          {"ankle_pitch", anklePitch()},
          {"foot", foot()}};
}

std::vector<NamedMesh> gripperShells() {
  const auto box = [](const Vector3& size, const Vector3& centre) {
    return geometry::transformed(geometry::boxMesh(size), makePose(centre));
  };
  return {{"gripper_carriage", box({0.06, 0.10, 0.06}, {0, 0, 0.125})},
          {"gripper_palm", box({0.05, 0.20, 0.03}, {0, 0, 0.075})},
          {"gripper_finger", box({0.016, 0.010, 0.085}, {0, 0.011, 0.0225})},
          {"finger_pad", geometry::transformed(gridBox({0.020, 0.006, 0.030}, 0.001), makePose({0, 0.003, 0}))}};
}

std::vector<NamedMesh> watcherShells() {
  // The lidar's drum sits around the mast, its middle 0.2 m above the ground.
  return {
      {"watcher_foot", loft({oval(0.000, 0.155, 0.125), oval(0.004, 0.160, 0.130), oval(0.060, 0.160, 0.130), oval(0.080, 0.120, 0.090)})},
      {"watcher_mast", loft({oval(0.070, 0.030, 0.030, 0, 2), oval(0.160, 0.030, 0.030, 0, 2), oval(0.165, 0.055, 0.055, 0, 2),
                             oval(0.235, 0.055, 0.055, 0, 2), oval(0.240, 0.024, 0.024, 0, 2), oval(0.580, 0.020, 0.020, 0, 2)})},
      {"watcher_neck", loft({oval(0.000, 0.026, 0.026, 0, 2), oval(0.030, 0.026, 0.030, 0, 3), oval(0.045, 0.018, 0.018, 0, 3)})},
      {"watcher_head", loft({oval(-0.025, 0.030, 0.070, 0.015), oval(-0.018, 0.040, 0.085, 0.015), oval(0.022, 0.040, 0.085, 0.015),
                             oval(0.030, 0.030, 0.070, 0.015)})}};
}

}  // namespace blem_sim::demo
