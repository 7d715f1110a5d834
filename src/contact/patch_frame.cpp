#include "patch_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blem_sim {

namespace {

constexpr double SMALLEST = 1e-6;  // [m] radius
constexpr double UNIT = 1.9e-14;   // squares of lengths are 1 within it

}  // namespace

PatchScale::PatchScale(const std::vector<Contact>& contacts, bool* ready) {
  constexpr double INFINITE = std::numeric_limits<double>::infinity();
  double low[3] = {INFINITE, INFINITE, INFINITE}, high[3] = {-INFINITE, -INFINITE, -INFINITE}, deepest = -INFINITE;
  int unready = 0;
  double nothing = 0;  // not a number if any place or depth is none, or infinite
  for (const Contact& contact : contacts) {
    const double x = contact.point.x(), y = contact.point.y(), z = contact.point.z(), depth = contact.depth;
    nothing += 0 * x + 0 * y + 0 * z + 0 * depth;
    unready |= !(std::abs(contact.normal_BA.squaredNorm() - 1) <= UNIT);
    low[0] = std::min(low[0], x);
    low[1] = std::min(low[1], y);
    low[2] = std::min(low[2], z);
    high[0] = std::max(high[0], x);
    high[1] = std::max(high[1], y);
    high[2] = std::max(high[2], z);
    deepest = std::max(deepest, depth);
  }
  *ready = !unready && nothing == 0;
  if (!*ready || contacts.empty()) return;
  const Vector3 lowest(low[0], low[1], low[2]), highest(high[0], high[1], high[2]);
  centre_ = 0.5 * (lowest + highest);
  per_radius_ = 1 / std::max(0.5 * (highest - lowest).norm(), SMALLEST);
  depth_ = deepest;
}

}  // namespace blem_sim
