// Contacts while they are swept: impulses improved one contact after the other, eight pairs at a time, each between bodies of its own.
#pragma once

#include "lanes/contact_term.h"
#include "lanes/lanes.h"
#include "lanes/spatial.h"

namespace blem_sim::dynamics {

/** Twice as many as elsewhere: a visit is a long chain of dependent operations, and a processor works on two chains at once. */
constexpr int SWEEP_LANES = 2 * LANES;
using SweepLanes = double[SWEEP_LANES];
using SweepVectors = double[3][SWEEP_LANES];
using TwistLanes = double[6][SWEEP_LANES];

/** One contact of each of eight pairs: its constants while they are swept. */
struct alignas(8 * SWEEP_LANES) SweepContact {
  SweepVectors point;           ///< about the reference point of the pair's first body
  SweepVectors normal, across;  ///< the first two axes; the third one completes them
  SweepLanes friction, compliance, target;
  SweepLanes offset[2];           ///< [m/s] across the normal: by which the bodies' paths bend apart
  SweepLanes normal_gain;         ///< [kg] of the normal row, compliance included
  SweepLanes mixed[2];            ///< [1/kg] by which a push moves the point across
  SweepLanes tangent_inverse[3];  ///< [kg] inverse of the response across: 11, 12, 22
  SweepLanes slide_gain;          ///< [kg] inverse of the largest response across
};

/** Variables of a sweep: impulses along the axes [N s]. */
struct alignas(8 * SWEEP_LANES) SweepImpulse {
  SweepVectors now;     ///< those found
  SweepVectors before;  ///< those that the sweep before found
};

/** Eight pairs at most, no body in two of them. Lanes without a pair have contacts that never act. */
struct SweepGroup {
  int pair[SWEEP_LANES];             ///< -1: none
  int first = 0, end = 0;            ///< contacts: as many as the largest pair has
  bool free = false;                 ///< all bodies are free, or the static world
  double response[21][SWEEP_LANES];  ///< of the relative twist to a wrench, about the first body's reference point; lower triangle by rows
};

/** Velocity of eight bodies, and their inverse inertias. Lanes of the static world, or without a pair, stay at zero. */
struct alignas(8 * SWEEP_LANES) BodyLanes {
  double inverse_inertia[6][SWEEP_LANES];  ///< [1/(kg m^2)] lower triangle by rows, world axes
  SweepLanes inverse_mass;                 ///< [1/kg]
  int first[SWEEP_LANES];                  ///< of the six numbers of its velocity; -1: none
};

/** Bodies of a group that are all free. */
struct SweepBodies {
  BodyLanes a, b;
  SweepVectors shift;  ///< from a's reference point to b's
};

/** Contacts of a group, and their impulses in the same order. */
struct SweptContacts {
  const SweepContact *begin, *end;
  SweepImpulse* impulses;
  double lead = 0;  ///< share of the last change by which an impulse moves on before its visit
};

/** A lane's contact from a term; null: one that never acts. */
void setLane(const ContactTerm* term, int lane, SweepContact* contact, SweepImpulse* impulse);
/** Gains of the contacts, once all their lanes and the group's responses are set. */
void setGains(const SweepGroup& group, SweepContact* begin, SweepContact* end);
/** Impulse of a lane's contact, world axes. */
Vector3 readLane(const SweepContact& contact, const SweepImpulse& impulse, int lane);

/** Sum of the impulses' wrenches, about the pairs' reference points. */
void wrenchOf(const SweptContacts& contacts, TwistLanes* wrench);

/** Changes of impulses by a sweep over contacts. */
struct SweepChange {
  double squared[2] = {};  ///< [N^2 s^2] sums of the changes' squares: of the first LANES lanes, and of the others
  double largest = 0;      ///< [N^2 s^2] square of the largest change of one contact
  double impulse = 0;      ///< [N^2 s^2] square of the largest impulse
};

/**
 * Visits the contacts in turn: the push that ends the approach, then friction on Coulomb's cone.
 * @param twist relative, at the present impulses
 * @param wrench change of the impulses' wrenches, out
 */
void sweep(const SweepGroup& group, const SweptContacts& contacts, const TwistLanes& twist, TwistLanes* wrench, SweepChange* change);

/** The same with the bodies' velocities instead of twists and wrenches. @param velocity of all bodies, each angular, then linear */
void sweepFree(const SweepBodies& bodies, const SweptContacts& contacts, double* velocity, SweepChange* change);

/** Impulses times a factor. */
void scale(double factor, SweepImpulse* begin, SweepImpulse* end);

}  // namespace blem_sim::dynamics
