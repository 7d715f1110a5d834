// What looks like work of a contact, and is none.
#pragma once

#include "contact_term.h"

namespace blem_sim {

/**
 * [J] An impulse's work is that times the mean of the velocities at the step's start and end. Where loads end a departure or a slip within
 * the step, the contact acts only after they did, yet half of its impulse times what they were at the start is in that mean; and where what
 * sticks follows a path that bends, it is led back by as much as it went. So much a contact that holds to its law may seem to do, never
 * more: what it does beyond its law is not among this.
 * @param before [m/s] relative velocity at the start of the step, after impacts. Precondition: the contact was solved
 */
double apparentWork(const ContactTerm& contact, const Vector3& before);

}  // namespace blem_sim
