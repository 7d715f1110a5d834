// Terms side by side against the same terms one by one, and against their definitions.
#include <gtest/gtest.h>

#include <random>

#include "lanes/contact_lanes.h"
#include "lanes/joint_lanes.h"

namespace blem_sim::dynamics {
namespace {

class Lane : public ::testing::Test {
 protected:
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-52 - 1; }
  Vector3 vector() { return Vector3(uniform(), uniform(), uniform()); }

  JointTerm joint() {
    JointTerm term;
    term.dof = 0;
    term.motor_gain = 1 + uniform();
    term.motor_velocity = uniform();
    term.motor_bound = uniform() > 0 ? 0.3 : INFINITY;
    if (uniform() > 0) {
      term.velocity_gain = 2;
      term.max_velocity = 0.3 * uniform();
      term.min_velocity = term.max_velocity - 0.3;
    }
    term.viscous = 0.1;
    term.softness = 3;
    term.dry_gain = 2 + uniform();
    term.dry_bound = 0.4;
    term.dry_previous = 0.4 * uniform();
    if (uniform() > 0) return term;
    term.limit_gain = 5;
    term.lower_velocity = uniform() > 0 ? -INFINITY : -0.3;
    term.upper_velocity = 0.3;
    term.upper_previous = std::max(0.0, uniform());
    return term;
  }

  ContactTerm contact() {
    ContactTerm term;
    term.point = vector();
    term.normal = vector().normalized();
    term.friction = uniform() > 0.6 ? 0 : 0.5 * (1 + uniform());
    term.compliance = uniform() > 0 ? 0 : 1e-2;
    term.inverse_mass = 0.3;
    term.stiffest_rho = 0.05;
    term.target = 0.2 * uniform();
    const Vector3 across = term.normal.cross(vector());
    if (uniform() > -0.5) term.previous = 3 * term.normal + 3 * term.friction * std::min(1.0, across.norm()) * across.normalized();
    term.slip = std::max(0.0, 0.01 * uniform());
    return term;
  }

  /** A block of one contact in each of the first three lanes; the last one has none. */
  ContactBlock block(const ContactTerm* terms) {
    ContactBlock b{};
    for (int lane = 0; lane < LANES; ++lane) setLane(lane < LANES - 1 ? &terms[lane] : nullptr, lane, &b);
    soften(terms, LANES - 1, 1, &b);
    return b;
  }

  static Vector3 at(const VectorLanes& v, int lane) { return Vector3(v[0][lane], v[1][lane], v[2][lane]); }
  static void put(const Vector3& v, int lane, VectorLanes* out) {
    for (int i = 0; i < 3; ++i) (*out)[i][lane] = v[i];
  }

 private:
  std::mt19937_64 generator_{7};
};

TEST_F(Lane, JointsAnswerAsTheirTerms) {
  for (int round = 0; round < 1000; ++round) {
    JointTerm terms[3] = {joint(), joint(), joint()};
    JointBlock b{};
    double slope = 0, curvature = 0, first = 0, second = 0, worst = 0;
    for (int lane = 0; lane < LANES; ++lane) {
      setLane(lane < 3 ? &terms[lane] : nullptr, lane, &b);
      b.velocity[lane] = lane < 3 ? uniform() : 0;
      b.step[lane] = lane < 3 ? uniform() : 0;
    }
    respond(0.5, &b, &b + 1, &first, &second);
    for (int lane = 0; lane < 3; ++lane) {
      const double v = b.velocity[lane] + 0.5 * b.step[lane], d = b.step[lane];
      EXPECT_NEAR(b.impulse[lane], terms[lane].impulse(v), 1e-13);
      EXPECT_NEAR(b.stiffness[lane], terms[lane].stiffness(v), 1e-13);
      slope -= terms[lane].impulse(v) * d;
      curvature += terms[lane].stiffness(v) * d * d;
      worst = std::max(worst, terms[lane].creep(b.velocity[lane]));
    }
    EXPECT_NEAR(first, slope, 1e-12);
    EXPECT_NEAR(second, curvature, 1e-12);
    EXPECT_NEAR(creep(&b, &b + 1), worst, 1e-13);
    EXPECT_EQ(b.impulse[3], 0);
    EXPECT_EQ(b.stiffness[3], 0);
  }
}

// The impulse is the nearest point of the cone: the rest of y is normal to it and points away.
TEST_F(Lane, ContactsAreProjectedOnTheirCones) {
  int kinds[3] = {};
  for (int round = 0; round < 1000; ++round) {
    const ContactTerm terms[3] = {contact(), contact(), contact()};
    ContactBlock b = block(terms);
    for (int lane = 0; lane < 3; ++lane) put(0.3 * vector(), lane, &b.velocity);
    respond(0, &b, &b + 1);
    EXPECT_EQ(b.kind[3], ContactBlock::OPEN);
    EXPECT_EQ(at(b.impulse, 3), Vector3::Zero());
    for (int lane = 0; lane < 3; ++lane) {
      const ContactTerm& t = terms[lane];
      const Vector3 g = at(b.impulse, lane), u = at(b.velocity, lane);
      const double g_n = t.normal.dot(g);
      const Vector3 g_t = g - g_n * t.normal;
      ++kinds[static_cast<int>(b.kind[lane])];
      EXPECT_LE(g_t.norm(), t.friction * g_n + 1e-12);
      // w (y - g): the dual cone's, complementary to g.
      const Vector3 y = t.stiffest_rho * t.previous - u + (t.target - t.friction * t.slip) * t.normal;
      const Vector3 rest = y - (t.compliance + t.stiffest_rho) * g_n * t.normal - t.stiffest_rho * g_t;
      const double rest_n = t.normal.dot(rest);
      EXPECT_LE(t.friction * (rest - rest_n * t.normal).norm(), -rest_n + 1e-12);
      EXPECT_NEAR(rest.dot(g), 0, 1e-11);
    }
  }
  for (const int count : kinds) EXPECT_GT(count, 100);
}

TEST_F(Lane, StiffnessIsTheImpulsesDerivative) {
  constexpr double STEP = 1e-7;
  for (int round = 0; round < 300; ++round) {
    const ContactTerm terms[3] = {contact(), contact(), contact()};
    ContactBlock b = block(terms);
    for (int lane = 0; lane < 3; ++lane) put(0.3 * vector(), lane, &b.velocity);
    Vector6 twist;
    twist << vector(), vector();
    setSteps(twist, &b, &b + 1);
    respond(STEP, &b, &b + 1);
    const Lanes kinds = {b.kind[0], b.kind[1], b.kind[2], b.kind[3]};
    const Vector6 after = wrenchOf(&b, &b + 1);
    respond(-STEP, &b, &b + 1);
    if (!std::equal(kinds, kinds + LANES, b.kind)) continue;  // across a bend there is none
    const Vector6 before = wrenchOf(&b, &b + 1);
    const PotentialSlope slope = respond(0, &b, &b + 1);
    Matrix6 stiffness = Matrix6::Zero();
    const bool acts = stiffnessOf(&b, &b + 1, &stiffness);
    EXPECT_EQ(acts, kinds[0] + kinds[1] + kinds[2] > 0);
    EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-12);
    EXPECT_LT(((before - after) / (2 * STEP) - stiffness * twist).norm(), 1e-4);
    EXPECT_NEAR(slope.second, twist.dot(stiffness * twist), 1e-10);
    EXPECT_NEAR(slope.first, -twist.dot(wrenchOf(&b, &b + 1)), 1e-12);
  }
}

// If nothing has changed since the impulse was remembered, it is the expected one; at other velocities, along the response's stiffness.
TEST_F(Lane, ExpectsWhatWasRemembered) {
  int slipping = 0;
  for (int round = 0; round < 300; ++round) {
    ContactTerm terms[3] = {contact(), contact(), contact()};
    for (ContactTerm& t : terms) t.compliance = 0.1;
    ContactBlock b = block(terms);
    for (int lane = 0; lane < 3; ++lane) put(0.3 * vector(), lane, &b.velocity);
    // At a fixed point of the projection: the impulse at hand becomes the proximal point.
    for (int i = 0; i < 2000; ++i) {
      respond(0, &b, &b + 1);
      remember(&b, &b + 1);
    }
    respond(0, &b, &b + 1);
    ASSERT_LT(residual(&b, &b + 1).impulse, 1e-9);
    const ContactBlock solved = b;
    expect(&b, &b + 1);
    for (int lane = 0; lane < 3; ++lane) {
      EXPECT_LT((at(b.impulse, lane) - at(solved.impulse, lane)).norm(), 1e-6);
      if (at(solved.impulse, lane).norm() < 1e-6) continue;  // it opens just there
      EXPECT_EQ(b.kind[lane], solved.kind[lane]);
      slipping += b.kind[lane] == ContactBlock::SLIP;
    }
    Vector6 twist;
    twist << vector(), vector();
    Matrix6 stiffness = Matrix6::Zero();
    stiffnessOf(&b, &b + 1, &stiffness);
    const Vector6 here = wrenchOf(&b, &b + 1);
    setSteps(twist, &b, &b + 1);
    take(1, &b, &b + 1);
    expect(&b, &b + 1);
    EXPECT_LT((here - stiffness * twist - wrenchOf(&b, &b + 1)).norm(), 1e-9 * (1 + stiffness.norm()));
  }
  EXPECT_GT(slipping, 200);
}

TEST_F(Lane, AMotorsImpulseFallsAndIsItsLine) {
  for (int round = 0; round < 1000; ++round) {
    const JointTerm term = joint();
    double last = INFINITY;
    for (double v = -1; v < 1; v += 0.01) {
      const JointResponse line = term.motorLine(v);
      const double impulse = term.motorImpulse(v);
      EXPECT_NEAR(line.impulse - line.stiffness * v, impulse, 1e-12);
      EXPECT_LE(impulse, last + 1e-12);
      EXPECT_LE(impulse, std::max(-term.motor_bound, term.velocity_gain * (term.max_velocity - v)) + 1e-12);
      EXPECT_GE(impulse, std::min(term.motor_bound, term.velocity_gain * (term.min_velocity - v)) - 1e-12);
      last = impulse;
    }
  }
}

TEST_F(Lane, AMotorsImpulseIsThatOfTheVelocityItLeadsTo) {
  for (int round = 0; round < 1000; ++round) {
    const JointTerm term = joint();
    for (const double response : {0.01, 1.0, 100.0}) {
      for (double v = -1; v < 1; v += 0.1) {
        const double impulse = term.motorImpulse(v, response), there = v + response * impulse;
        const double error = 1e-12 * (1 + response * std::max(term.motor_gain, term.velocity_gain));
        EXPECT_NEAR(term.motorImpulse(there), impulse, error);
        const JointResponse line = term.motorLine(v, response);
        EXPECT_NEAR(line.impulse - line.stiffness * there, impulse, error);
      }
    }
  }
}

TEST(JointExpectation, IsTheLineThroughTheProximalPoint) {
  JointTerm term;
  term.dry_gain = 10;
  term.dry_bound = 1;
  term.dry_previous = 0.5;
  EXPECT_DOUBLE_EQ(term.expect(0.2).impulse, 0.5 - 2);  // though friction would saturate there
  EXPECT_DOUBLE_EQ(term.expect(0.2).stiffness, 10);
  term.dry_previous = 1;  // it had slipped
  EXPECT_DOUBLE_EQ(term.expect(0.2).impulse, 1);
  EXPECT_DOUBLE_EQ(term.expect(0.2).stiffness, 0);
  term.limit_gain = 10;
  term.upper_velocity = 0.1;
  EXPECT_DOUBLE_EQ(term.expect(0.2).impulse, 1);  // a limit that did not push
  term.upper_previous = 2;
  EXPECT_DOUBLE_EQ(term.expect(0.2).impulse, 1 - 2 - 1);
  EXPECT_DOUBLE_EQ(term.expect(0.2).stiffness, 10);
}

// A body that crossed a thin one is pushed the other way from then on. Slip over friction was 0 / 0, and the simulation stopped.
TEST_F(Lane, AContactThatTurnedRoundOpens) {
  ContactTerm terms[LANES - 1] = {contact(), contact(), contact()};
  for (ContactTerm& term : terms) {
    term.normal = -Vector3::UnitX();
    term.previous = 0.8 * Vector3::UnitX();
    term.slip = 0;
  }
  ContactBlock b = block(terms);
  expect(&b, &b + 1);
  Matrix6 stiffness;
  EXPECT_FALSE(stiffnessOf(&b, &b + 1, &stiffness));
  EXPECT_TRUE(stiffness.isZero(0));
  EXPECT_TRUE(wrenchOf(&b, &b + 1).isZero(0));
  EXPECT_EQ(b.kind[0], ContactBlock::OPEN);
}

TEST_F(Lane, WithoutAContactNeverActsHoweverFast) {
  const ContactTerm terms[LANES - 1] = {contact(), contact(), contact()};
  for (const double speed : {0.5, 2.0, 1e3}) {
    ContactBlock b = block(terms);
    Vector6 twist = Vector6::Zero();
    twist.tail<3>() = Vector3(0.6, 0, -0.8) * speed;
    setSteps(twist, &b, &b + 1);
    take(1, &b, &b + 1);
    respond(0, &b, &b + 1);
    EXPECT_EQ(b.kind[LANES - 1], ContactBlock::OPEN) << speed;
    EXPECT_EQ(at(b.impulse, LANES - 1), Vector3::Zero()) << speed;
    EXPECT_EQ(b.tangent_gain[LANES - 1], 0) << speed;
  }
}

}  // namespace
}  // namespace blem_sim::dynamics
