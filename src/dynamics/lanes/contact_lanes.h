// Contacts of the step problem while it is iterated: Coulomb's cone with a proximal point, four contacts at a time.
#pragma once

#include <vector>

#include "lanes/contact_term.h"
#include "lanes/lanes.h"
#include "lanes/spatial.h"

namespace blem_sim::dynamics {

/** Four contacts of one pair. A contact's impulse falls with the velocity: its stiffness -d impulse/du is positive semidefinite. */
struct ContactBlock {
  static constexpr double OPEN = 0, STICK = 1, SLIP = 2;

  VectorLanes point, normal;
  Lanes friction, compliance, inverse_mass, target;
  Lanes rho;                                         ///< proximal weight [m/s per N s]
  Lanes inverse_rho, inverse_normal, inverse_ridge;  ///< of rho, compliance + rho, compliance + rho + friction^2 rho
  VectorLanes previous;                              ///< [N s] impulse of the proximal point
  Lanes slip;                                        ///< [m/s] |u_t| there: De Saxce's term
  VectorLanes velocity;                              ///< [m/s] relative, mean over the step, at the present iterate
  VectorLanes step;                                  ///< its change along the search direction
  // The response at the velocity it was asked for last. Stiffness of a contact that sticks: normal_gain along its axis, the normal,
  // tangent_gain across; of one that slips: normal_gain along its axis, the ridge n + mu t of the cone, tangent_gain along `side`.
  Lanes kind, normal_gain, tangent_gain;
  VectorLanes impulse, axis, side;
};

/** Slope of the contacts' potential along the steps, and its derivative. */
struct PotentialSlope {
  double first = 0, second = 0;

  PotentialSlope& operator+=(const PotentialSlope& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

/** A lane's contact from a term; null: a contact that never acts. */
void setLane(const ContactTerm* term, int lane, ContactBlock* block);
/** Impulse and velocity of a lane's contact at the present iterate, into its term. */
void readLane(const ContactBlock& block, int lane, ContactTerm* term);

/** Proximal weights `softness` times the terms' own. @param terms of the block's lanes; those that are left never act */
void soften(const ContactTerm* terms, int count, double softness, ContactBlock* block);

/** The response at the velocity that the proximal point's impulse belongs to, extended linearly to the present velocity. */
void expect(ContactBlock* begin, ContactBlock* end);
/** The responses at velocity + a step. */
PotentialSlope respond(double a, ContactBlock* begin, ContactBlock* end);

/** Sum of the impulses' wrenches about the points' origin. */
Vector6 wrenchOf(const ContactBlock* begin, const ContactBlock* end);
/** Stiffness of the pair: the 6 x 6 sum of J' k J, k being the responses' stiffnesses. @return false if no contact acts */
bool stiffnessOf(const ContactBlock* begin, const ContactBlock* end, Matrix6* out);
/** The steps of the points that a twist carries along. */
void setSteps(const Vector6& twist, ContactBlock* begin, ContactBlock* end);
/** velocity += a step */
void take(double a, ContactBlock* begin, ContactBlock* end);
/** Contacts that stay open at their velocities, and have no impulse in the proximal point, slip there as they do at these. */
void startSlips(ContactBlock* begin, ContactBlock* end);
/** Takes the present iterate as the next proximal point. */
void remember(ContactBlock* begin, ContactBlock* end);
/** By how much contacts miss Coulomb's law. */
struct ContactResidual {
  double impulse = 0;  ///< [N s] the worst
  double speed = 0;    ///< [m/s] the worst as the velocity that the contact's own inertia would make of it
};
/** Each impulse's distance to its own projection after a step against the velocity. */
ContactResidual residual(const ContactBlock* begin, const ContactBlock* end);
/** [m/s] of the fastest of the points. */
double fastest(const ContactBlock* begin, const ContactBlock* end);

}  // namespace blem_sim::dynamics
