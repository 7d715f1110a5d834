#include "wrench_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "contact_order.h"

namespace blem_sim {

namespace {

constexpr int DIRECTIONS = 256;          // more cost time, fewer leave extremes unseen
constexpr float CHOICE_FRICTION = 0.5f;  // of the cones that are compared; the choice hardly depends on it
// [m] A contact that does not touch yet counts less, by a unit force per this gap: it cannot carry anything now.
constexpr double GAP_SCALE = 2e-4;
// [m] Once no wrench lacks, depth counts too, a unit force per this depth.
constexpr double DEPTH_SCALE = 1e-3;
constexpr float NOTHING_LACKS = 1e-6f;  // of a unit force
// What an earlier choice may lack beyond a fresh one, in the direction that lacks most, of a unit force; and [m] in depth.
constexpr float GOOD_ENOUGH = 0.05f;
constexpr double DEEP_ENOUGH = 1e-6;
constexpr double DEPTH_TIE = 1e-8;  // [m]

using DirectionValues = Eigen::Array<float, DIRECTIONS, 1>;

// Force and torque part of each direction, one row per axis.
struct WrenchDirections {
  std::array<DirectionValues, 3> force, torque;
};

double nextUniform(std::uint64_t& state) {  // splitmix64
  std::uint64_t z = (state += 0x9E3779B97F4A7C15ull);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

// The twelve axis directions, then directions spread evenly over the 6-D sphere (sums of uniform numbers are nearly normal).
WrenchDirections makeDirections() {
  WrenchDirections directions;
  std::uint64_t state = 1;
  for (int i = 0; i < DIRECTIONS; ++i) {
    Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
    if (i < 12) {
      d[i / 2] = i % 2 ? -1 : 1;
    } else {
      for (int axis = 0; axis < 6; ++axis) {
        for (int sum = 0; sum < 12; ++sum) d[axis] += nextUniform(state) - 0.5;
      }
      d.normalize();
    }
    for (int axis = 0; axis < 3; ++axis) {
      directions.force[axis][i] = static_cast<float>(d[axis]);
      directions.torque[axis][i] = static_cast<float>(d[3 + axis]);
    }
  }
  return directions;
}

// Largest component, along every direction, of the wrenches (f, x f) with f in the friction cone and unit normal force: with g the
// direction seen by a force at x it is g.n + mu |g - (g.n) n|.
void wrenchSupport(const WrenchDirections& d, const Eigen::Vector3f& x, const Eigen::Vector3f& n, float handicap, DirectionValues* out) {
  const DirectionValues gx = d.force[0] + d.torque[1] * x.z() - d.torque[2] * x.y();
  const DirectionValues gy = d.force[1] + d.torque[2] * x.x() - d.torque[0] * x.z();
  const DirectionValues gz = d.force[2] + d.torque[0] * x.y() - d.torque[1] * x.x();
  const DirectionValues along = gx * n.x() + gy * n.y() + gz * n.z();
  const DirectionValues tangential = (gx.square() + gy.square() + gz.square() - along.square()).max(0.0f).sqrt();
  *out = along + CHOICE_FRICTION * tangential - handicap;
}

std::vector<DirectionValues> supportOfEach(const std::vector<Contact>& contacts) {
  static const WrenchDirections directions = makeDirections();
  Box box;
  for (const Contact& contact : contacts) box.extend(contact.point);
  const Vector3 centre = box.center();
  const double radius = std::max(0.5 * box.diagonal().norm(), 1e-6);  // torques are measured in forces at this distance
  std::vector<DirectionValues> support(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3 lever = (contacts[i].point - centre) / radius;
    const double handicap = std::max(0.0, -contacts[i].depth) / GAP_SCALE;
    wrenchSupport(directions, lever.cast<float>(), contacts[i].normal_BA.cast<float>(), static_cast<float>(handicap), &support[i]);
  }
  return support;
}

// The deepest contact; of those that are as deep but for rounding the farthest along UNCOMMON_DIRECTION, so that the names of vertices do
// not decide.
int deepest(const std::vector<Contact>& contacts) {
  double depth = contacts[0].depth;
  for (const Contact& contact : contacts) depth = std::max(depth, contact.depth);
  int best = -1;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].depth < depth - DEPTH_TIE) continue;
    if (best < 0 || UNCOMMON_DIRECTION.dot(contacts[i].point) > UNCOMMON_DIRECTION.dot(contacts[best].point)) best = static_cast<int>(i);
  }
  return best;
}

// The largest component of all contacts along each direction, and whose it is.
struct Extremes {
  explicit Extremes(const std::vector<DirectionValues>& support) : value(support[0]) {
    for (std::size_t i = 1; i < support.size(); ++i) {
      for (int d = 0; d < DIRECTIONS; ++d) {
        if (support[i][d] > value[d]) {
          value[d] = support[i][d];
          contact[d] = static_cast<int>(i);
        }
      }
    }
  }
  DirectionValues value;
  std::array<int, DIRECTIONS> contact{};
};

// Adds to `chosen` the extreme contacts of the directions that lack most, until k are chosen or nothing lacks.
// Returns what still lacks most.
float addExtremes(const std::vector<DirectionValues>& support, const Extremes& extremes, int k, std::vector<int>& chosen) {
  DirectionValues reached = support[chosen[0]];
  for (int i : chosen) reached = reached.max(support[i]);
  while (true) {
    Eigen::Index direction = 0;
    const float lack = (extremes.value - reached).maxCoeff(&direction);
    if (lack <= NOTHING_LACKS || static_cast<int>(chosen.size()) >= k) return lack;
    chosen.push_back(extremes.contact[direction]);
    reached = reached.max(support[chosen.back()]);
  }
}

// Those of `contacts` that were chosen before; none if they are too many.
std::vector<int> stillThere(const std::vector<Contact>& contacts, int k, const std::vector<std::uint64_t>& chosen_before) {
  std::vector<int> there;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (std::binary_search(chosen_before.begin(), chosen_before.end(), contacts[i].id)) there.push_back(static_cast<int>(i));
  }
  if (static_cast<int>(there.size()) > k) there.clear();
  return there;
}

// Adds the deepest of those not chosen until k are.
void addDeepest(const std::vector<Contact>& contacts, int k, std::vector<int>& chosen) {
  std::vector<char> is_chosen(contacts.size(), 0);
  for (int i : chosen) is_chosen[i] = 1;
  std::vector<int> rest;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!is_chosen[i]) rest.push_back(static_cast<int>(i));
  }
  std::stable_sort(rest.begin(), rest.end(), [&](int a, int b) { return contacts[a].depth > contacts[b].depth; });
  const std::size_t room = std::max(0, k - static_cast<int>(chosen.size()));
  rest.resize(std::min(rest.size(), room));
  chosen.insert(chosen.end(), rest.begin(), rest.end());
}

}  // namespace

std::vector<int> chooseSpanningContacts(const std::vector<Contact>& contacts, int k, const std::vector<std::uint64_t>& chosen_before) {
  if (contacts.empty()) return {};
  std::vector<DirectionValues> support = supportOfEach(contacts);
  const Extremes extremes(support);
  std::vector<int> chosen = {deepest(contacts)};
  const float lack = addExtremes(support, extremes, k, chosen);
  std::vector<int> continued = stillThere(contacts, k, chosen_before);
  if (!continued.empty() && addExtremes(support, extremes, k, continued) <= lack + GOOD_ENOUGH) {
    const auto shallower = [&](int a, int b) { return contacts[a].depth < contacts[b].depth; };
    const int its_deepest = *std::max_element(continued.begin(), continued.end(), shallower);
    if (contacts[its_deepest].depth >= contacts[chosen[0]].depth - DEEP_ENOUGH) chosen = std::move(continued);
  }
  if (static_cast<int>(chosen.size()) < k) {
    for (std::size_t i = 0; i < contacts.size(); ++i) support[i] += static_cast<float>(std::max(0.0, contacts[i].depth) / DEPTH_SCALE);
    addExtremes(support, Extremes(support), k, chosen);
    addDeepest(contacts, k, chosen);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace blem_sim
