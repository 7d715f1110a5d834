// Contacts as patches, curves and crowds, for the tests of their reduction.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "blem_sim/geometry/shortest_turn.h"
#include "blem_sim/reduction/reduction.h"
#include "geometry/random_shapes.h"

namespace blem_sim::reduction {

using Contacts = std::vector<contact::Contact>;

inline contact::Contact makeContact(const Vector3& point, const Vector3& normal, double depth, std::uint64_t id) {
  contact::Contact contact;
  contact.point = point;
  contact.normal_BA = normal.normalized();
  contact.depth = depth;
  contact.id = id;
  return contact;
}

// Uniform numbers in [-1, 1), the same with every standard library.
class Noise {
 public:
  explicit Noise(unsigned seed) : engine_(seed) {}
  double operator()() { return engine_() * (2.0 / 4294967296.0) - 1.0; }

 private:
  std::mt19937 engine_;
};

// A 10 cm square in the plane across `normal`, all contacts at one depth: contacts of a tessellated cube on a plane.
inline Contacts flatPatch(int count, const Vector3& normal, const Vector3& centre, unsigned seed = 1) {
  Noise noise(seed);
  const Quaternion tilt = geometry::shortestTurn(Vector3::UnitZ(), normal);
  Contacts contacts;
  for (int i = 0; i < count; ++i) {
    const Vector3 p(0.05 * noise(), 0.05 * noise(), 0);
    contacts.push_back(makeContact(centre + tilt * p, normal, 1e-3, i));
  }
  return contacts;
}

// A cube's face on sensor noise: normals within some degrees, depths within the layer.
inline Contacts noisyPatch(int count, unsigned seed = 2) {
  Noise noise(seed);
  Contacts contacts;
  for (int i = 0; i < count; ++i) {
    const Vector3 normal(0.1 * noise() + 0.1 * noise(), 0.1 * noise() + 0.1 * noise(), 1);
    contacts.push_back(makeContact({0.05 * noise(), 0.05 * noise(), 5e-4 * noise()}, normal, 1.25e-3 * (1 + noise()), i));
  }
  return contacts;
}

/** The wall of a mug of 4 cm beside another, with noise: normals within 30 degrees, the deepest along a line. */
inline Contacts wallPatch(int count, unsigned seed = 7) {
  Noise noise(seed);
  Contacts contacts;
  for (int i = 0; i < count; ++i) {
    const double angle = 0.5 * noise();
    const Vector3 out(std::cos(angle), std::sin(angle), 0);
    const Vector3 point = 0.04 * (out - Vector3::UnitX()) + 0.04 * noise() * Vector3::UnitZ();
    contacts.push_back(makeContact(point, out + 0.05 * noise() * Vector3::UnitZ(), 5e-3 - 0.04 * angle * angle + 2e-4 * noise(), i));
  }
  return contacts;
}

constexpr int RIM_CORNERS = 72;

/** The rim of a mug's foot, its depths trembling by some nanometres. */
inline contact::ContactManifold rim(geometry::RandomShapes& random, double tremble) {
  contact::ContactManifold manifold;
  manifold.a = 3;
  manifold.b = 7;
  for (int i = 0; i < RIM_CORNERS; ++i) {
    contact::Contact contact;
    const double angle = 2 * M_PI * i / RIM_CORNERS;
    contact.point = {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0};
    contact.normal_BA = Vector3::UnitZ();
    contact.depth = 1e-5 + random.uniform(-tremble, tremble);
    contact.id = 100 + i;
    manifold.contacts.push_back(contact);
  }
  return manifold;
}

inline Contacts reducedBy(const Reduction& method, const Contacts& contacts, int k) {
  Contacts reduced;
  ReductionWorkspace workspace;
  method.reduce(contacts, k, {}, &workspace, &reduced);
  return reduced;
}

/** Reduces manifolds in place. */
inline ReductionLoss reduceAll(std::vector<contact::ContactManifold>& manifolds, const std::vector<int>& model_a,
                               const std::vector<int>& model_b, const std::vector<ContactBudget>& budgets, const Reduction& method,
                               ReductionMemory* memory) {
  std::vector<contact::ContactManifold> reduced;
  ReductionWorkspace workspace;
  const ReductionLoss loss = reduceManifolds({manifolds, model_a, model_b, budgets}, method, memory, &workspace, &reduced);
  manifolds = std::move(reduced);
  return loss;
}

// Largest component along (a, b) of the wrenches about the origin that contacts with unit normal force give.
inline double support(const Contacts& contacts, const Vector3& a, const Vector3& b, double friction = 0.5) {
  double best = -std::numeric_limits<double>::infinity();
  for (const contact::Contact& c : contacts) {
    const Vector3 g = a + b.cross(c.point);
    const double along = g.dot(c.normal_BA);
    best = std::max(best, along + friction * (g - along * c.normal_BA).norm());
  }
  return best;
}

struct SupportError {
  double mean = 0, max = 0;
};

/** Difference of the support functions of the friction wrenches over 500 directions, relative to the mean; torques at half the patch's
 * size. */
inline SupportError supportError(const Contacts& all, const Contacts& reduced) {
  Noise noise(31);
  double sum = 0, worst = 0, level = 0;
  for (int d = 0; d < 500; ++d) {
    Eigen::Matrix<double, 6, 1> w;
    for (int i = 0; i < 6; ++i) w[i] = noise() + noise() + noise();
    w.normalize();
    const Vector3 a = w.head<3>(), b = w.tail<3>() / 0.05;
    const double difference = support(all, a, b) - support(reduced, a, b);
    sum += difference;
    worst = std::max(worst, difference);
    level += std::abs(support(all, a, b));
  }
  return {sum / level, worst * 500 / level};
}

inline contact::ContactManifold manifoldOf(int a, int b, Contacts contacts) {
  contact::ContactManifold manifold;
  manifold.a = a;
  manifold.b = b;
  manifold.contacts = std::move(contacts);
  return manifold;
}

}  // namespace blem_sim::reduction
