// Apparent work of contacts: departures and slips that loads end, and bent paths count; work beyond the contact's law does not.
#include "problem/contact_work.h"

#include <gtest/gtest.h>

namespace blem_sim::dynamics {
namespace {

/** Pushes upwards by 2 N s, rubs along x by as much as given. */
ContactTerm pushes(double rub = 0) {
  ContactTerm contact;
  contact.normal = Vector3::UnitZ();
  contact.impulse = {rub, 0, 2};
  return contact;
}

TEST(ApparentWork, IsHalfTheImpulseTimesADepartureThatEnds) {
  EXPECT_DOUBLE_EQ(apparentWork(pushes(), {0, 0, 0.3}), 0.3);
  EXPECT_EQ(apparentWork(pushes(), {0, 0, -0.3}), 0);
}

TEST(ApparentWork, IsNotThatOfARigidContactThatEndsAboveItsTarget) {
  ContactTerm contact = pushes();
  contact.velocity = {0, 0, 5};
  EXPECT_EQ(apparentWork(contact, Vector3::Zero()), 0);
  contact.target = 0.1;
  EXPECT_DOUBLE_EQ(apparentWork(contact, {0, 0, 0.3}), 0.2);
}

TEST(ApparentWork, OfASpringStandsInItsOwnBook) {
  ContactTerm contact = pushes();
  contact.compliance = 1e-3;
  contact.velocity = {0, 0, 0.2};
  EXPECT_EQ(apparentWork(contact, {0, 0, 0.3}), 0);
}

TEST(ApparentWork, OfFrictionIsASlipThatTurnsRoundOrABentPath) {
  EXPECT_DOUBLE_EQ(apparentWork(pushes(0.5), {0.2, 0, 0}), 0.05);
  EXPECT_EQ(apparentWork(pushes(0.5), {-0.2, 0, 0}), 0);
  ContactTerm bent = pushes(0.5);
  bent.bend = {-0.2, 0, 0};
  EXPECT_DOUBLE_EQ(apparentWork(bent, Vector3::Zero()), 0.05);
  EXPECT_EQ(apparentWork(bent, {-0.2, 0, 0}), 0);
}

TEST(ApparentWork, OfNoImpulseIsNone) {
  ContactTerm contact = pushes();
  contact.impulse.setZero();
  EXPECT_EQ(apparentWork(contact, {1, 1, 1}), 0);
}

}  // namespace
}  // namespace blem_sim::dynamics
