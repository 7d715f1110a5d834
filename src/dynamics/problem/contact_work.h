// Apparent work: the part of a contact's work, as it is booked, that its law does not do.
#pragma once

#include "lanes/contact_term.h"

namespace blem_sim::dynamics {

/**
 * [J] An impulse's work is booked as the impulse times the mean of the velocities at the step's start and end. Loads may end a departure or
 * a slip within the step: the contact acts only afterwards, but half of its impulse times the velocity at the start is booked. A contact
 * that sticks on a bent path is led back by the bend, which is booked too. The apparent work is the most that a contact which obeys its law
 * can book in these ways. Work beyond the law is never part of it.
 * @param before [m/s] relative velocity at the start of the step, after impacts. Precondition: the contact was solved
 */
double apparentWork(const ContactTerm& contact, const Vector3& before);

}  // namespace blem_sim::dynamics
