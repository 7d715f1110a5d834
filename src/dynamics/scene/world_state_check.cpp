#include "scene/world_state_check.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/input_error.h"
#include "scene/world_state.h"

namespace blem_sim::dynamics {
namespace {

constexpr double FARTHEST = 1e12;       // [m], [m/s], [rad/s]
constexpr double TURN_ROUNDING = 1e-6;  // of quaternions and rotations
constexpr std::size_t WRENCH_SIZE = 6;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("world state: " + what + ", as no world saves it; save the state again");
}

bool within(const Vector3& v) { return v.cwiseAbs().maxCoeff() <= FARTHEST; }

void checkBits(const BodyBits& bits, const std::string& name) {
  if (!(std::abs(bits.turn().norm() - 1) <= TURN_ROUNDING)) refuse("the quaternion of body '" + name + "' is not unit");
  if (!((bits.rotation() - bits.turn().toRotationMatrix()).cwiseAbs().maxCoeff() <= TURN_ROUNDING))
    refuse("rotation and quaternion of body '" + name + "' are not the same");
  if (!within(bits.com()) || !within(bits.velocity()) || !within(bits.spin()))
    refuse("body '" + name + "' is farther or faster than 1e12 m, m/s or rad/s");
}

}  // namespace

void checkNumbers(const Scene& scene, const WorldState& state) {
  if (!std::all_of(state.numbers.begin(), state.numbers.end(), [](double x) { return std::isfinite(x); })) refuse("a number is not finite");
  geometry::StateReader reader = readerOf(state);
  reader.vector();  // gravity
  for (const BodySlot& slot : scene.bodies()) {
    if (!slot.ode) continue;
    BodyBits bits;
    double wrench[WRENCH_SIZE];
    reader.numbers(bits.numbers, BodyBits::SIZE);
    reader.numbers(wrench, WRENCH_SIZE);
    checkBits(bits, slot.spec.name);
  }
}

}  // namespace blem_sim::dynamics
