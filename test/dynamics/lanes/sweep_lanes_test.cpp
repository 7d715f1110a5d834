// Groups of free bodies are swept with the bodies' velocities, groups of trees with twists and responses: both must do the same.
#include "lanes/sweep_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace blem_sim::dynamics {
namespace {

constexpr int CONTACTS = 5, WITHOUT_B = 1, WITHOUT_PAIR = 3;  // the lanes that meet the static world, and that have no pair

struct Body {
  Matrix3 inverse_inertia = Matrix3::Zero();
  double inverse_mass = 0;
  Vector6 velocity = Vector6::Zero();
};

/** Twist about a point at `shift` from the one that `twist` is about. */
Vector6 moved(const Vector6& twist, const Vector3& shift) {
  Vector6 out = twist;
  out.tail<3>() += twist.head<3>().cross(shift);
  return out;
}

Matrix6 inverseOf(const Body& body) {
  Matrix6 inverse = Matrix6::Zero();
  inverse.topLeftCorner<3, 3>() = body.inverse_inertia;
  inverse.bottomRightCorner<3, 3>() = body.inverse_mass * Matrix3::Identity();
  return inverse;
}

class SweepLanes : public ::testing::Test {
 protected:
  SweepLanes() {
    for (int lane = 0; lane < SWEEP_LANES; ++lane) addLane(lane);
    setGains(group_, contacts_, contacts_ + CONTACTS);
  }

  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-52 - 1; }
  Vector3 vector() { return Vector3(uniform(), uniform(), uniform()); }

  Body body() {
    Matrix3 root;
    root << vector(), vector(), vector();
    Body body;
    body.inverse_inertia = root * root.transpose() + Matrix3::Identity();
    body.inverse_mass = 1.5 + uniform();
    body.velocity << vector(), vector();
    return body;
  }

  ContactTerm contact() {
    ContactTerm term;
    term.point = vector();
    term.normal = vector().normalized();
    term.friction = 0.5 * (1 + uniform());
    term.target = 0.2 * uniform();
    term.bend = 0.1 * vector();
    term.previous = 0.1 * term.normal;
    return term;
  }

  void setBody(const Body& body, int lane, int first_dof, BodyLanes* lanes) {
    lanes->first[lane] = first_dof;
    lanes->inverse_mass[lane] = body.inverse_mass;
    for (int r = 0, at = 0; r < 3; ++r)
      for (int c = 0; c <= r; ++c, ++at) lanes->inverse_inertia[at][lane] = body.inverse_inertia(r, c);
    if (first_dof >= 0) velocity_.segment<6>(first_dof) = body.velocity;
  }

  void addLane(int lane) {
    const bool exists = lane != WITHOUT_PAIR, has_b = exists && lane != WITHOUT_B;
    const Body a = exists ? body() : Body(), b = has_b ? body() : Body();
    shift_[lane] = has_b ? vector() : Vector3::Zero();
    setBody(a, lane, exists ? 12 * lane : -1, &bodies_.a);
    setBody(b, lane, has_b ? 12 * lane + 6 : -1, &bodies_.b);
    for (int i = 0; i < 3; ++i) bodies_.shift[i][lane] = shift_[lane][i];
    Matrix6 to_a = Matrix6::Identity();  // twists about b's reference point to a's
    for (int k = 0; k < 6; ++k) to_a.col(k) = moved(Vector6::Unit(k), -shift_[lane]);
    const Matrix6 response = inverseOf(a) + to_a * inverseOf(b) * to_a.transpose();
    for (int r = 0, at = 0; r < 6; ++r)
      for (int c = 0; c <= r; ++c, ++at) group_.response[at][lane] = exists ? response(r, c) : r == c;
    const Vector6 relative = a.velocity - to_a * b.velocity;
    for (int i = 0; i < 6; ++i) twist_[i][lane] = relative[i];
    for (int i = 0; i < CONTACTS; ++i) {
      const ContactTerm term = contact();
      setLane(exists ? &term : nullptr, lane, &contacts_[i], &impulses_[i]);
    }
  }

  Vector6 relativeVelocity(int lane) const {
    if (lane == WITHOUT_PAIR) return Vector6::Zero();
    const Vector6 a = velocity_.segment<6>(12 * lane);
    return lane == WITHOUT_B ? a : Vector6(a - moved(velocity_.segment<6>(12 * lane + 6), -shift_[lane]));
  }

  std::mt19937_64 generator_{7};
  SweepGroup group_{};
  SweepBodies bodies_{};
  SweepContact contacts_[CONTACTS] = {};
  SweepImpulse impulses_[CONTACTS] = {};
  TwistLanes twist_ = {};
  Vector3 shift_[SWEEP_LANES];
  Eigen::VectorXd velocity_ = Eigen::VectorXd::Zero(12 * SWEEP_LANES);
};

TEST_F(SweepLanes, OfFreeBodiesDoWhatThoseOfTreesDo) {
  SweepImpulse free[CONTACTS];
  std::copy(impulses_, impulses_ + CONTACTS, free);
  SweepChange change, free_change;
  for (int sweeps = 0; sweeps < 3; ++sweeps) {
    TwistLanes wrench;
    sweep(group_, {contacts_, contacts_ + CONTACTS, impulses_}, twist_, &wrench, &change);
    sweepFree(bodies_, {contacts_, contacts_ + CONTACTS, free}, velocity_.data(), &free_change);
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      const Vector6 now = relativeVelocity(lane);
      for (int i = 0; i < 6; ++i) twist_[i][lane] = now[i];
      for (int c = 0; c < CONTACTS; ++c)
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(free[c].now[axis][lane], impulses_[c].now[axis][lane], 1e-12) << lane;
    }
    for (int half = 0; half < 2; ++half) EXPECT_NEAR(free_change.squared[half], change.squared[half], 1e-12);
    EXPECT_NEAR(free_change.largest, change.largest, 1e-12);
    EXPECT_NEAR(free_change.impulse, change.impulse, 1e-12);
    EXPECT_GT(change.impulse, 1e-3);
  }
}

TEST_F(SweepLanes, MomentumFollowsFromImpulses) {
  const Eigen::VectorXd before = velocity_;
  SweepImpulse start[CONTACTS];
  std::copy(impulses_, impulses_ + CONTACTS, start);
  SweepChange change;
  sweepFree(bodies_, {contacts_, contacts_ + CONTACTS, impulses_}, velocity_.data(), &change);
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    if (lane == WITHOUT_PAIR) continue;
    Vector3 force = Vector3::Zero();
    for (int c = 0; c < CONTACTS; ++c) force += readLane(contacts_[c], impulses_[c], lane) - readLane(contacts_[c], start[c], lane);
    const Vector3 a = (velocity_ - before).segment<3>(12 * lane + 3), b = (velocity_ - before).segment<3>(12 * lane + 9);
    EXPECT_TRUE(a.isApprox(bodies_.a.inverse_mass[lane] * force, 1e-12)) << lane;
    EXPECT_TRUE((b + bodies_.b.inverse_mass[lane] * force).isZero(1e-12)) << lane;
  }
}

TEST_F(SweepLanes, ImpulsesMoveOnBeforeTheirVisit) {
  constexpr double LEAD = 0.4;
  SweepImpulse moved[CONTACTS];
  for (int c = 0; c < CONTACTS; ++c)
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < SWEEP_LANES; ++lane) {
        impulses_[c].now[axis][lane] += 0.01 * uniform();
        moved[c].before[axis][lane] = 0;
        const double change = impulses_[c].now[axis][lane] - impulses_[c].before[axis][lane];
        moved[c].now[axis][lane] = impulses_[c].now[axis][lane] + LEAD * change;
      }
  const SweepImpulse found = impulses_[0];
  Eigen::VectorXd velocity = velocity_;
  SweepChange change;
  sweepFree(bodies_, {contacts_, contacts_ + CONTACTS, impulses_, LEAD}, velocity_.data(), &change);
  sweepFree(bodies_, {contacts_, contacts_ + CONTACTS, moved}, velocity.data(), &change);
  EXPECT_EQ(velocity_, velocity);
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      EXPECT_EQ(impulses_[0].now[axis][lane], moved[0].now[axis][lane]);
      EXPECT_EQ(impulses_[0].before[axis][lane], found.now[axis][lane]) << "the next sweep moves on from there";
    }
}

}  // namespace
}  // namespace blem_sim::dynamics
