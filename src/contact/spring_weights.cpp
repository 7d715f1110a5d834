// How much each of several springs counts, so that a patch is as stiff whatever it is made of.
#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/contact/reduction.h"

namespace blem_sim {

namespace {

constexpr int DIRECTIONS = 32;
constexpr double RESOLUTION = 0.005;  // [m] contacts within it share a direction
constexpr double DEPTH_SLOPE = 20;    // [m/m] one deeper by this part of the distance stands before one farther out
constexpr double ALIKE = 0.5;         // contacts whose normals differ more are of different patches
constexpr double SPRINGS = 5;         // of a patch in all, if it has as many contacts; a rectangle's corners then still count fully

using Directions = std::vector<Vector3>;
using Prominence = Eigen::Map<Eigen::ArrayXXd>;

// Spread evenly over the sphere [Fibonacci].
Directions makeDirections() {
  constexpr double GOLDEN_ANGLE = 2.39996322972865332;
  Directions directions;
  for (int m = 0; m < DIRECTIONS; ++m) {
    const double z = (2.0 * m + 1) / DIRECTIONS - 1, r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(GOLDEN_ANGLE * m), r * std::sin(GOLDEN_ANGLE * m), z);
  }
  return directions;
}

// How far out every contact lies along every direction, as powers of e: entry (contact, direction), the largest of a direction is 1.
Prominence prominence(const std::vector<Contact>& contacts) {
  static const Directions directions = makeDirections();
  static thread_local std::vector<double> memory;  // kept between calls
  memory.resize(contacts.size() * DIRECTIONS);
  Prominence out(memory.data(), static_cast<Eigen::Index>(contacts.size()), DIRECTIONS);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3 lever = contacts[i].point - contacts[0].point;
    for (int m = 0; m < DIRECTIONS; ++m) out(i, m) = (directions[m].dot(lever) + DEPTH_SLOPE * contacts[i].depth) / RESOLUTION;
  }
  for (int m = 0; m < DIRECTIONS; ++m) out.col(m) = (out.col(m) - out.col(m).maxCoeff()).exp();
  return out;
}

// Of the directions in which a patch has an extreme, the part in which contact i is it.
double shareOf(const std::vector<Contact>& contacts, const Prominence& prominence, Eigen::Index i) {
  Eigen::Array<double, 1, DIRECTIONS> all = Eigen::Array<double, 1, DIRECTIONS>::Zero();
  for (Eigen::Index j = 0; j < prominence.rows(); ++j) {
    const double alike = 1 - (contacts[i].normal_BA - contacts[j].normal_BA).norm() / ALIKE;
    if (alike > 0) all += alike * prominence.row(j);
  }
  return (prominence.row(i) / all.max(1e-300)).mean();
}

}  // namespace

void weighSprings(std::vector<Contact>& contacts) {
  if (contacts.size() < 3) {
    for (Contact& contact : contacts) contact.weight = 1;
    return;
  }
  const Prominence far_out = prominence(contacts);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    contacts[i].weight = std::clamp(SPRINGS * shareOf(contacts, far_out, static_cast<Eigen::Index>(i)), 1e-6, 1.0);
}

}  // namespace blem_sim
