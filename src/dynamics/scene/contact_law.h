// The contact law: bounds on relative velocities at a contact's point.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::dynamics {

/** Memory of one contact from one step to the next. */
struct ContactMemo {
  std::uint64_t id = 0;
  Vector3 friction = Vector3::Zero();  ///< [N] tangential force on A, world axes
  double approach = 0;                 ///< [m/s] closing speed of an impact that landed in the last step and is still to bounce
};

inline void turnOver(ContactMemo* memo) { memo->friction = -memo->friction; }

/** Memos of the contacts of the last step, sorted by id. */
class ContactMemory {
 public:
  const ContactMemo* find(std::uint64_t id) const;
  void replace(std::vector<ContactMemo> memos);
  /** @param ids ascending @param go_on as World::forgetContacts has it */
  void forget(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on);
  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  std::vector<ContactMemo> memos_;
};

/** Motion of A's point against B's at a contact, world axes, at the start of a step. */
struct ContactMotion {
  Vector3 velocity_BA = Vector3::Zero();      ///< [m/s]
  Vector3 acceleration_BA = Vector3::Zero();  ///< [m/s^2] by gravity and outside wrenches alone
};

/** Bound of a contact along its normal: v_n+ >= speed - compliance f_n. */
struct NormalRow {
  double speed = 0;       ///< [m/s]
  double compliance = 0;  ///< [m/s per N] of the surface, at least the solver's own softness
  double approach = 0;    ///< [m/s] to be remembered if the contact pushes in this step
};

/** Normal row without restitution. @param softness [m/s per N] least compliance that the solver needs */
NormalRow surfaceRow(const ContactConstraint& contact, double dt, double softness, const SolverSettings& settings);

/**
 * The rows of one contact: v_n+ >= normal_speed - normal_cfm f_n, and in the tangent plane v_t+ = tangent_velocity - tangent_cfm f_t within
 * the friction pyramid whose first axis is `first_axis`. Velocities of A against B, forces on A, cfm in m/s per N.
 */
struct ContactRows {
  double normal_speed = 0, normal_cfm = 0;
  Vector3 first_axis = Vector3::UnitX();  ///< unit, tangential
  Vector3 tangent_velocity = Vector3::Zero();
  double tangent_cfm = 0;
  double approach = 0;  ///< [m/s] to be remembered if the contact pushes in this step
};

/** Notes a contact that pushed for the next step. @param force [N] on A, world axes */
void addMemo(const ContactConstraint& contact, const ContactRows& rows, const Vector3& force, std::vector<ContactMemo>* memos);

/**
 * The contact law:
 * - rigid: v_n >= -gap/dt before touch, so that no contact appears with a force; v_n >= min(fraction depth/dt, max speed) behind it;
 * - compliant (stiffness and damping finite): f_n = k depth+ - d v_n+, from touch on;
 * - restitution: the impact lands, its approach speed is remembered by identity, and the next step leaves with e times it;
 * - friction: first axis along the slip; at rest along the last friction force, whose creep by cfm is fed forward; if neither, along the
 * slip to be.
 * @param memo of the same contact in the last step, or null
 */
ContactRows contactRows(const ContactConstraint& contact, const ContactMotion& motion, const ContactMemo* memo, double dt,
                        const SolverSettings& settings);

}  // namespace blem_sim::dynamics
