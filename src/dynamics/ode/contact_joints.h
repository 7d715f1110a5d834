// Contacts as ODE contact joints of one step.
#pragma once

#include <vector>

#include "scene/contact_law.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {

/** The contacts of one step: made into joints, as often as the step is tried, and read back. */
class ContactJoints {
 public:
  /** Takes the contacts' rows from the state at the start of the step. Contacts without a live body ask nothing. */
  void prepare(const Scene& scene, const std::vector<ContactConstraint>& contacts, const ContactMemory& memory, double dt,
               const SolverSettings& settings);
  /** Creates the joints, in the order of the contacts. @param cfm_scale at least 1; softens every row */
  void create(Scene* scene, double cfm_scale);
  /** Destroys the joints; the forces stay readable. */
  void clear(Scene* scene);

  /** [N] on body A, world axes. */
  void readForces(std::vector<Vector3>* forces) const;
  std::vector<ContactMemo> memos(const std::vector<Vector3>& forces) const;

 private:
  struct Contact {
    ContactConstraint constraint;
    ContactRows rows;
    bool active = false;
    bool reversed = false;  ///< A is the world; ODE's first body, which must be one, is then B
  };
  void create(Scene* scene, const Contact& contact, double cfm_scale, dJointFeedback* feedback) const;

  std::vector<Contact> contacts_;
  std::vector<dJointFeedback> feedback_;
};

}  // namespace blem_sim::dynamics
