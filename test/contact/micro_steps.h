// Micro-steps: changes of a contact set from one to the next, against those of a rigid shift.
#pragma once

#include <array>
#include <cstdio>

#include "blem_sim/reduction/reduction.h"
#include "contact/contact_shapes.h"
#include "support/sanitizers.h"

namespace blem_sim::contact {

constexpr double STEP = 1e-6;    // [m]
constexpr double R = 0.0025;     // [m] boundary widths
constexpr double MARGIN = 1e-3;  // [m] the simulation's
constexpr double DEEP = 5e-6;    // [m] deeper contacts must not come or go
constexpr double NEAR = 1e-4;    // [m] a contact this close ...
constexpr double ALIKE = 0.02;   // ... with a normal this close (sine), as deep, has taken over
constexpr double FASTEST = 4;    // depth fades 2 um per um outside; feet of nearly parallel edges run faster than the bodies

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
    reduction::ReductionWorkspace workspace;
    reduction::reduceHull(contacts, 1000);
    reduction::weighSprings(contacts, &workspace);
    for (const Contact& c : contacts) {
      if (c.depth <= 0) continue;
      sum += c.weight * c.depth * c.normal_BA;
      weight += c.weight;
    }
  }
};

inline double supportOf(const std::vector<Contact>& contacts, const Vector3& centre, const Vector3& force, const Vector3& torque) {
  double support = 0;
  for (const Contact& c : contacts)
    support = std::max(support, std::max(0.0, c.depth) * (force + torque.cross(c.point - centre)).dot(c.normal_BA));
  return support;
}

inline void countOrphans(const std::vector<Contact>& of, const std::vector<Contact>& in, Walk* walk) {
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

inline void compare(const std::vector<Contact>& before, const std::vector<Contact>& after, const Vector3& centre, Walk* walk) {
  constexpr double ARM = 0.05;  // [m]
  ++walk->steps;
  walk->changes += before.size() != after.size();
  countOrphans(before, after, walk);
  countOrphans(after, before, walk);
  const Springs was(before), is(after);
  walk->rate = std::max(walk->rate, (is.sum - was.sum).norm() / std::max({1.0, was.weight, is.weight}) / STEP);
  geometry::RandomShapes random(9);
  for (int i = 0; i < 40; ++i) {
    const Vector3 force = random.point(1), torque = random.point(1) / ARM;
    const double change = supportOf(after, centre, force, torque) - supportOf(before, centre, force, torque);
    walk->support = std::max(walk->support, std::abs(change) / STEP / (force.norm() + ARM * torque.norm()));
  }
}

struct Scene {
  const char* name;
  Collider a, b;
  double height, spread;  ///< [m] of A's start above B, and to the sides
};

inline Walk walk(const Scene& scene, double overlap, int poses, int steps) {
  geometry::RandomShapes random(77);
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

}  // namespace blem_sim::contact
