// Micro-steps of 1 um: no contact deeper than a few of them comes or goes, and the forces of deep layers change as a rigid shift would.
#include <gtest/gtest.h>

#include "blem_sim/contact/reduction.h"
#include "contact/stl_soup.h"
#include "contact_shapes.h"
#include "support/sanitizers.h"

namespace blem_sim {
namespace {

constexpr double STEP = 1e-6;    // [m]
constexpr double R = 0.0025;     // [m] boundary widths
constexpr double MARGIN = 1e-3;  // [m] the simulation's
constexpr double DEEP = 5e-6;    // [m] what is deeper must not come or go
constexpr double NEAR = 1e-4;    // [m] a contact this close ...
constexpr double ALIKE = 0.02;   // ... with a normal this close (sine), as deep, has taken over
constexpr double FASTEST = 4;    // depth fades 4 um per um outside; feet of nearly parallel edges run faster than the bodies

/** Closed box with n triangles' squares along each axis. */
TriangleMesh tessellatedBox(const Vector3& size, const Vector3i& n) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    TriangleMesh side = gridMesh(size[u], size[v], n[u], n[v]);
    for (const double height : {-0.5 * size[axis], 0.5 * size[axis]}) {
      const int first = static_cast<int>(mesh.vertices.size());
      for (const Vector3& p : side.vertices) {
        Vector3 q;
        q[axis] = height;
        q[u] = p.x();
        q[v] = p.y();
        mesh.vertices.push_back(q);
      }
      for (const Vector3i& e : side.elements) mesh.elements.push_back(e + Vector3i::Constant(first));
    }
  }
  return cleanMesh(mesh, nullptr);
}

struct Walk {
  int steps = 0, orphans = 0, changes = 0;
  double deepest_orphan = 0;  ///< [m]
  double rate = 0;            ///< change of the sum of weight * n * depth after reduction, per weight and step, in steps
  double support = 0;         ///< change of the largest depth-weighted component along a wrench, in steps' rigid shifts
};

/** Springs of one layer's contacts, and their number. */
struct Springs {
  Vector3 sum = Vector3::Zero();  ///< [m] of weight * normal * depth
  double weight = 0;

  explicit Springs(std::vector<Contact> contacts) {
    reduceHull(contacts, 1000);
    weighSprings(contacts);
    for (const Contact& c : contacts) {
      if (c.depth <= 0) continue;
      sum += c.weight * c.depth * c.normal_BA;
      weight += c.weight;
    }
  }
};

double supportOf(const std::vector<Contact>& contacts, const Vector3& centre, const Vector3& force, const Vector3& torque) {
  double support = 0;
  for (const Contact& c : contacts)
    support = std::max(support, std::max(0.0, c.depth) * (force + torque.cross(c.point - centre)).dot(c.normal_BA));
  return support;
}

void countOrphans(const std::vector<Contact>& of, const std::vector<Contact>& in, Walk* walk) {
  for (const Contact& c : of) {
    if (c.depth <= DEEP) continue;
    const bool lives_on = std::any_of(in.begin(), in.end(), [&c](const Contact& d) {
      const bool taken_over =
          (c.point - d.point).norm() < NEAR && (c.normal_BA - d.normal_BA).norm() < ALIKE && d.depth > c.depth - FASTEST * STEP;
      return taken_over || (c.id == d.id && std::abs(c.depth - d.depth) < 5 * FASTEST * STEP);
    });
    if (lives_on) continue;
    ++walk->orphans;
    walk->deepest_orphan = std::max(walk->deepest_orphan, c.depth);
  }
}

void compare(const std::vector<Contact>& before, const std::vector<Contact>& after, const Vector3& centre, Walk* walk) {
  constexpr double ARM = 0.05;  // [m]
  ++walk->steps;
  walk->changes += before.size() != after.size();
  countOrphans(before, after, walk);
  countOrphans(after, before, walk);
  const Springs was(before), is(after);
  walk->rate = std::max(walk->rate, (is.sum - was.sum).norm() / std::max({1.0, was.weight, is.weight}) / STEP);
  RandomShapes random(9);
  for (int i = 0; i < 40; ++i) {
    const Vector3 force = random.point(1), torque = random.point(1) / ARM;
    const double change = supportOf(after, centre, force, torque) - supportOf(before, centre, force, torque);
    walk->support = std::max(walk->support, std::abs(change) / STEP / (force.norm() + ARM * torque.norm()));
  }
}

/** Lowers A onto B until the layers overlap by `overlap` [m]. */
Pose lowered(const Collider& a, Pose X_BA, const Collider& b, double overlap) {
  for (int i = 0; i < 100; ++i) {
    const ContactManifold manifold = contactsOf(a, X_BA, b, Pose::Identity(), 1e-3);
    const double missing = manifold.contacts.empty() ? 0.004 : overlap - manifold.maxDepth();
    if (std::abs(missing) < 1e-8) break;
    X_BA.translation().z() -= 0.9 * missing;
  }
  return X_BA;
}

struct Scene {
  const char* name;
  Collider a, b;
  double height, spread;  ///< [m] where A starts above B, how far to the sides
};

Walk walk(const Scene& scene, double overlap, int poses, int steps) {
  RandomShapes random(77);
  Walk all;
  for (int pose = 0; pose < samples(poses); ++pose) {
    const double tilt = std::array<double, 4>{0, 1e-3, 0.05, 1}[pose % 4];
    Pose X_BA = makePose({random.uniform(-scene.spread, scene.spread), random.uniform(-scene.spread, scene.spread), scene.height},
                         {random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), pose % 8 < 4 ? 0 : random.uniform(-3, 3)});
    X_BA.translation().z() += 0.05 * tilt;
    X_BA = lowered(scene.a, X_BA, scene.b, overlap);
    Vector3 direction = random.point(1);
    if (pose % 3) direction.z() = 0;
    std::vector<Contact> before;
    for (int step = 0; step <= steps; ++step) {
      std::vector<Contact> after = contactsOf(scene.a, X_BA, scene.b, Pose::Identity(), MARGIN).contacts;
      if (step > 0) compare(before, after, X_BA.translation(), &all);
      before = std::move(after);
      X_BA.pretranslate(STEP * direction.normalized());
    }
  }
  std::printf("%-11s %5.2f mm: %d steps, %d changes of count, %d orphans (deepest %.1f um), rate %.3g, support %.3g\n", scene.name,
              1e3 * overlap, all.steps, all.changes, all.orphans, 1e6 * all.deepest_orphan, all.rate, all.support);
  return all;
}

Collider cube() { return makeCollider(boxMesh(Vector3::Constant(0.1)), R); }
Collider pad() { return makeCollider(tessellatedBox({0.02, 0.02, 0.004}, {20, 20, 4}), R); }
Collider shellMug() { return makeCollider(cleanMesh(readStlSoup(BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl"), nullptr), R); }

TEST(Smoothness, CubeOnCube) {
  for (const double overlap : {1e-3, 1e-5}) {
    const Walk w = walk({"cube_cube", cube(), cube(), 0.12, 0.06}, overlap, 40, 100);
    EXPECT_EQ(w.orphans, 0);
    EXPECT_LE(w.rate, 1);
    EXPECT_LE(w.support, 2);
  }
}

TEST(Smoothness, FinePadOnCube) {
  for (const double overlap : {1e-3, 1e-5}) {
    const Walk w = walk({"pad_cube", pad(), cube(), 0.065, 0.055}, overlap, 40, 100);
    EXPECT_EQ(w.orphans, 0);
    EXPECT_LE(w.rate, overlap < 1e-4 ? 1 : 20);
    EXPECT_LE(w.support, 2);
  }
}

TEST(Smoothness, BallOnFinePlane) {
  for (const double overlap : {1e-3, 1e-5}) {
    const Scene scene{"ball_plane", makeCollider(icosphereMesh(0.03, 3), R), makeCollider(gridMesh(0.2, 0.2, 200, 200), 0), 0.04, 0.05};
    const Walk w = walk(scene, overlap, 16, 60);
    EXPECT_EQ(w.orphans, 0);
    EXPECT_LE(w.rate, 1);
    EXPECT_LE(w.support, 2);
  }
}

TEST(Smoothness, MugOnBoxAndMugOnMug) {
  const Collider mug = shellMug();
  const double height = -mug.geometry->bounds().min().z();
  for (const double overlap : {1e-3, 1e-5}) {
    for (const Walk& w : {walk({"mug_box", mug, cube(), 0.06 + height, 0.06}, overlap, 8, 40),
                          walk({"mug_mug", mug, mug, 0.01 + 2 * height, 0.03}, overlap, 8, 40)}) {
      EXPECT_LE(w.orphans, overlap < 1e-4 ? 0 : 1);
      EXPECT_LE(w.rate, overlap < 1e-4 ? 1 : 4);
      EXPECT_LE(w.support, 2);
    }
  }
}

/** Valleys everywhere: contacts leave faces and edges where nothing takes them over exactly. */
TEST(Smoothness, CubeOnNoise) {
  RandomShapes random(5);
  const Scene scene{"cube_noise", cube(), makeCollider(hillMesh(random, 0.15, 40, 0.0002), 0), 0.06, 0.01};
  const Walk w = walk(scene, 1e-3, 12, 60);
  EXPECT_LE(w.support, 2);
}

/** A vertex that leaves a plane into a valley: its contact fades over a quarter of its depth, at that rate and no faster. */
TEST(Smoothness, ContactFadesAcrossAConcaveEdge) {
  TriangleMesh valley;
  valley.vertices = {{0, -0.1, 0}, {0, 0.1, 0}, {-0.1, -0.1, 0}, {-0.1, 0.1, 0}, {0.1, -0.1, 0.02}, {0.1, 0.1, 0.02}};
  valley.elements = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5}};
  const Collider floor = makeCollider(valley, R), point = makeCollider(octahedronMesh(0.02), R);
  const auto depthOnPlane = [&](double x) {
    double depth = 0;
    for (const Contact& c : contactsOf(point, makePose({x, 0.013, 0.024}), floor, Pose::Identity()).contacts) {
      // The lower tip on the level half.
      const bool level = (c.point - Vector3(std::min(x, 0.0), 0.013, 0.002)).norm() < 1e-3 && std::abs(c.normal_BA.x() - x / 0.004) < 0.05;
      if (level) depth = std::max(depth, c.depth);
    }
    return depth;
  };
  EXPECT_NEAR(depthOnPlane(-1e-6), 1e-3, 1e-9);
  EXPECT_NEAR(depthOnPlane(1e-6), 1e-3 - 4e-6, 1e-7);
  EXPECT_NEAR(depthOnPlane(1e-4), 1e-3 - 4e-4, 2e-6);
  EXPECT_NEAR(depthOnPlane(2.4e-4), 1e-3 - 9.6e-4, 1e-5);
  EXPECT_EQ(depthOnPlane(2.6e-4), 0);
}

}  // namespace
}  // namespace blem_sim
