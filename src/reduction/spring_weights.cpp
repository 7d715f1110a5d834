// Weights of several springs, so that a patch is equally stiff whatever its tessellation.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "blem_sim/reduction/reduction.h"
#include "lanes/instruction_sets.h"
#include "reduction_room.h"

namespace blem_sim::reduction {

namespace {

constexpr int LANES = 8;
constexpr double RESOLUTION = 0.005;  // [m] contacts within it share a direction
constexpr double DEPTH_SLOPE = 20;    // [m/m] one deeper by this part of the distance stands before one farther out
constexpr double ALIKE = 0.5;         // contacts whose normals differ more are of different patches
constexpr double SPRINGS = 5;         // springs of a patch in all, if it has as many contacts; a rectangle's corners then still count fully

struct alignas(64) Directions {
  double x[SPRING_DIRECTIONS], y[SPRING_DIRECTIONS], z[SPRING_DIRECTIONS];
};

// Directions spread evenly over the sphere [Fibonacci].
Directions makeSpringDirections() {
  constexpr double GOLDEN_ANGLE = 2.39996322972865332;
  Directions directions;
  for (int m = 0; m < SPRING_DIRECTIONS; ++m) {
    directions.z[m] = (2.0 * m + 1) / SPRING_DIRECTIONS - 1;
    const double r = std::sqrt(1 - directions.z[m] * directions.z[m]);
    directions.x[m] = r * std::cos(GOLDEN_ANGLE * m);
    directions.y[m] = r * std::sin(GOLDEN_ANGLE * m);
  }
  return directions;
}

// e^x for x <= 0, to some units in the last place; e^-700 below -700.
BLEM_SIM_INLINE double decay(double x) {
  constexpr double ROUND = 0x1.8p52;  // added to a number it leaves the nearest integer in the lowest bits
  constexpr double LN2_HIGH = 0x1.62e42fee00000p-1, LN2_LOW = 0x1.a39ef35793c76p-33;
  const double bounded = x > -700 ? x : -700, shifted = bounded * 1.4426950408889634 + ROUND, doublings = shifted - ROUND;
  const double r = (bounded - doublings * LN2_HIGH) - doublings * LN2_LOW;
  double sum = 1.0 / 479001600;
  sum = sum * r + 1.0 / 39916800;
  sum = sum * r + 1.0 / 3628800;
  sum = sum * r + 1.0 / 362880;
  sum = sum * r + 1.0 / 40320;
  sum = sum * r + 1.0 / 5040;
  sum = sum * r + 1.0 / 720;
  sum = sum * r + 1.0 / 120;
  sum = sum * r + 1.0 / 24;
  sum = sum * r + 1.0 / 6;
  sum = sum * r + 0.5;
  sum = sum * r + 1;
  sum = sum * r + 1;
  std::uint64_t bits;
  std::memcpy(&bits, &shifted, sizeof(bits));
  bits = (bits + 1023) << 52;
  double power;
  std::memcpy(&power, &bits, sizeof(power));
  return sum * power;
}

// Height of a contact along every direction, its depth times DEPTH_SLOPE added, in resolutions.
BLEM_SIM_LANES void findHeights(const Directions& directions, const double* lever, double depth, SpringRow* heights, SpringRow* highest) {
  const double x = lever[0], y = lever[1], z = lever[2], deep = DEPTH_SLOPE * depth;
  for (int m = 0; m < SPRING_DIRECTIONS; ++m) {
    const double height = (directions.x[m] * x + directions.y[m] * y + directions.z[m] * z + deep) * (1 / RESOLUTION);
    heights->of[m] = height;
    highest->of[m] = height > highest->of[m] ? height : highest->of[m];
  }
}

BLEM_SIM_LANES void turnIntoPowers(const SpringRow& highest, SpringRow* rows, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    for (int m = 0; m < SPRING_DIRECTIONS; ++m) rows[i].of[m] = decay(rows[i].of[m] - highest.of[m]);
  }
}

// Inverse of the sum of the rows, each times its factor.
BLEM_SIM_LANES void invertSum(const SpringRow* rows, const double* factors, std::size_t count, SpringRow* inverse) {
  double sum[SPRING_DIRECTIONS] = {};
  for (std::size_t i = 0; i < count; ++i) {
    const double factor = factors[i];
    if (factor <= 0) continue;
    for (int m = 0; m < SPRING_DIRECTIONS; ++m) sum[m] += factor * rows[i].of[m];
  }
  for (int m = 0; m < SPRING_DIRECTIONS; ++m) inverse->of[m] = 1 / (sum[m] > 1e-300 ? sum[m] : 1e-300);
}

BLEM_SIM_LANES double meanProduct(const SpringRow& a, const SpringRow& b) {
  double sums[LANES] = {};
  for (int m = 0; m < SPRING_DIRECTIONS; m += LANES) {
    for (int lane = 0; lane < LANES; ++lane) sums[lane] += a.of[m + lane] * b.of[m + lane];
  }
  double sum = 0;
  for (const double each : sums) sum += each;
  return sum / SPRING_DIRECTIONS;
}

void findProminence(const std::vector<contact::Contact>& contacts, SpringRoom* room) {
  static const Directions directions = makeSpringDirections();
  SpringRow highest;
  std::fill(std::begin(highest.of), std::end(highest.of), -std::numeric_limits<double>::infinity());
  room->prominence.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3 lever = contacts[i].point - contacts[0].point;
    findHeights(directions, lever.data(), contacts[i].depth, &room->prominence[i], &highest);
  }
  turnIntoPowers(highest, room->prominence.data(), contacts.size());
}

// Adds a leader, with the inverse sum of all contacts that lie in one patch with those of its normal.
void addLeader(const std::vector<contact::Contact>& contacts, std::size_t leader, SpringRoom* room) {
  room->alike.clear();
  for (const contact::Contact& contact : contacts)
    room->alike.push_back(1 - (contacts[leader].normal_BA - contact.normal_BA).norm() / ALIKE);
  room->leaders.push_back(leader);
  room->inverses.emplace_back();
  invertSum(room->prominence.data(), room->alike.data(), contacts.size(), &room->inverses.back());
}

// Inverse sum for a contact: the last leader's, mostly, for patches are flat, or curved without equal normals.
const SpringRow& inverseFor(const std::vector<contact::Contact>& contacts, std::size_t i, SpringRoom* room) {
  for (std::size_t l = room->leaders.size(); l-- > 0;) {
    if (contacts[room->leaders[l]].normal_BA == contacts[i].normal_BA) return room->inverses[l];
  }
  addLeader(contacts, i, room);
  return room->inverses.back();
}

}  // namespace

void weighSprings(std::vector<contact::Contact>& contacts, ReductionWorkspace* workspace) {
  SpringRoom& room = (*workspace)->springs;
  if (contacts.size() < 3) {
    for (contact::Contact& contact : contacts) contact.weight = 1;
    return;
  }
  findProminence(contacts, &room);
  room.leaders.clear();
  room.inverses.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    // Part of the directions in which this contact is the extreme of its patch.
    const double share = meanProduct(room.prominence[i], inverseFor(contacts, i, &room));
    contacts[i].weight = std::clamp(SPRINGS * share, 1e-6, 1.0);
  }
}

}  // namespace blem_sim::reduction
