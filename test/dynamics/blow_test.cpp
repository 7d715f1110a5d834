// A heavy ball strikes a light plate that lies on the ground, or nearly does: nothing gives way, whatever the ratio of masses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/analytic_contacts.h"
#include "geometry/random_shapes.h"
#include "support/sanitizers.h"

namespace blem_sim::dynamics {
namespace {

/** Plate and ball as a seed makes them, at the moment before they meet. */
struct Blow {
  Blow(std::uint64_t seed, double largest_ratio) : n(seed), world({0, 0, -9.81}, {}) {
    const double mass = spread(1e-3, 1), side = 0.05 * std::cbrt(100 * mass), radius = side * n.uniform(0.5, 2);
    ratio = spread(1, largest_ratio), speed = spread(0.1, 30), dt = spread(6e-5, 3e-3);
    const double friction = n.uniform(0.1, 1), turn = 2 * speed / side;
    const Vector3 size(side, side, 0);
    const int plate = world.addBody(boxBody("plate", mass, size, Vector3::Zero()));
    BodySpec sphere = boxBody("ball", ratio * mass, size, Vector3::Zero());
    sphere.inertial.inertia = Vector3::Constant(0.4 * ratio * mass * radius * radius).asDiagonal();
    const int ball = world.addBody(sphere);

    BodyState lies;
    lies.X_WB = makePose(Vector3::Zero(), {n.uniform(-0.03, 0.03), n.uniform(-0.03, 0.03), 0});
    double lowest = 0;
    for (int i = 0; i < 4; ++i) lowest = std::min(lowest, (lies.X_WB * corner(size, i)).z());
    lies.X_WB.translation().z() = n.uniform(-1e-4, 1e-4) - lowest;
    lies.v_WCom = speed * Vector3(n.uniform(-0.1, 0.1), n.uniform(-0.1, 0.1), n.uniform(-1, 0));
    lies.w_WB = turn * Vector3(n.uniform(-1, 1), n.uniform(-1, 1), n.uniform(-0.1, 0.1));
    world.setBodyState(plate, lies);
    const Vector3 up = lies.X_WB.linear().col(2), hit = lies.X_WB * (side * Vector3(n.uniform(-0.45, 0.45), n.uniform(-0.45, 0.45), 0));
    BodyState strikes;
    strikes.X_WB.translation() = hit + radius * up;
    strikes.v_WCom = speed * Vector3(n.uniform(-0.2, 0.2), n.uniform(-0.2, 0.2), -1);
    world.setBodyState(ball, strikes);

    for (int i = 0; i < 4; ++i) {
      const Vector3 p = lies.X_WB * corner(size, i);
      contacts.push_back(contactOf(plate, WORLD_BODY, p, Vector3::UnitZ(), -p.z(), {friction}, 1 + i));
    }
    contacts.push_back(contactOf(ball, plate, hit, up, n.uniform(-1e-4, 1e-5), {friction}, 5));
    starts = {lies, strikes};
  }

  /** [m/s] by which contacts sink in beyond where they were, the fastest. */
  double sinking() const {
    double fastest = 0;
    for (const ContactConstraint& c : contacts) {
      const auto velocity = [&](int body) -> Vector3 {
        if (body == WORLD_BODY) return Vector3::Zero();
        const BodyState before = starts[body], after = world.bodyState(body);
        return after.v_WCom + after.w_WB.cross(c.point - before.X_WB.translation());
      };
      fastest = std::max(fastest, std::min(0.0, c.depth) / dt - c.normal_BA.dot(velocity(c.body_a) - velocity(c.body_b)));
    }
    return fastest;
  }

  /** Uniform in the logarithm. */
  double spread(double low, double high) { return low * std::pow(high / low, n.uniform(0, 1)); }

  geometry::RandomShapes n;
  World world;
  double ratio = 1, speed = 0, dt = 0;
  std::vector<ContactConstraint> contacts;
  std::vector<BodyState> starts;
};

// Bounds on impulses by the largest one do not tell: a thousandth of what stops the ball throws the plate.
TEST(Blow, NothingGivesWay) {
  int iterations = 0;
  for (int seed = 1; seed <= samples(2000); ++seed) {
    Blow blow(seed, 1e4);
    const SolveResult& result = blow.world.step(blow.dt, blow.contacts, {});
    iterations += result.iterations;
    EXPECT_LT(blow.sinking(), 0.03 * blow.speed + 1e-3) << "seed " << seed << ", ratio " << blow.ratio;
    EXPECT_LT(result.creep, 0.05) << "seed " << seed << ", ratio " << blow.ratio;
  }
  EXPECT_LT(iterations, 2000 * 40);
}

// Beyond the ratios that are solved, what gives way is told.
TEST(Blow, TellsWhatGivesWay) {
  int told = 0;
  for (int seed = 1; seed <= samples(2000); ++seed) {
    Blow blow(seed, 1e12);
    const SolveResult& result = blow.world.step(blow.dt, blow.contacts, {});
    if (blow.sinking() <= 0.03 * blow.speed + 0.02) continue;
    EXPECT_GT(result.creep, 0.01) << "seed " << seed << ", ratio " << blow.ratio;
    ++told;
  }
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace blem_sim::dynamics
