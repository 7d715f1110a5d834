// Motion of a contact's two bodies at its point.
#pragma once

#include "scene/contact_law.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {

/** Whether the contact joins two different things that are in the scene, one of them a body. */
bool isUsable(const Scene& scene, const ContactConstraint& contact);

/** Motion of A's point against B's at the start of a step. Precondition: the contact is usable. */
ContactMotion contactMotion(const Scene& scene, const ContactConstraint& contact);

}  // namespace blem_sim::dynamics
