#include "scene/contact_law.h"

#include <algorithm>
#include <cmath>

#include "scene/contact_records.h"

namespace blem_sim::dynamics {
namespace {

constexpr double STICKING_SPEED = 1e-3;    // [m/s] of slip below which a contact counts as sticking
constexpr double MAX_FEED_FORWARD = 1e-4;  // [m/s]
constexpr double NO_FORCE = 1e-9;          // [N]

Vector3 tangential(const Vector3& v, const Vector3& normal) { return v - normal * normal.dot(v); }

bool compliant(const ContactConstraint& c) { return std::isfinite(c.stiffness) && std::isfinite(c.damping) && c.stiffness + c.damping > 0; }

// A step of free motion keeps v^2/2 + a x - a dt v/2 constant; an impact leaves e^2 of it, taken at the surface. So e = 1
// neither gains nor loses height, wherever in the step the impact falls and however deep it was noticed.
double impactSpeed(double closing, double acceleration, double depth, double dt) {
  if (closing <= 0) return 0;
  return std::sqrt(std::max(0.0, closing * closing - 2 * acceleration * depth + acceleration * dt * closing));
}

double reboundSpeed(double impact, double acceleration, double depth, double dt, double restitution) {
  const double half = 0.5 * std::max(0.0, acceleration) * dt;
  const double square = restitution * restitution * impact * impact + 2 * std::max(0.0, acceleration) * depth;
  return std::sqrt(std::max(0.0, half * half + square)) - half;
}

/** @param approach [m/s] remembered of the last step, 0 if none */
void setRestitution(const ContactConstraint& c, const ContactMotion& motion, double approach, double dt, NormalRow* row) {
  if (!(c.restitution > 0)) return;
  const double acceleration = -c.normal_BA.dot(motion.acceleration_BA);
  if (approach > 0)
    row->speed = std::max(row->speed, reboundSpeed(approach, acceleration, c.depth, dt, c.restitution));
  else
    row->approach = impactSpeed(-c.normal_BA.dot(motion.velocity_BA), acceleration, c.depth, dt);
}

// Friction force to be: last step's, less the present slip over the row's softness. So the pyramid's first axis follows the slip as soon as
// it exceeds the creep, and the last force below; an axis of the last force alone turns sideways once sliding starts.
Vector3 frictionToBe(const Vector3& last_force, const Vector3& slip, double cfm) { return last_force - slip / cfm; }

// Precondition: the softness of the rows is set.
void setFriction(const ContactConstraint& c, const ContactMotion& motion, const ContactMemo* memo, double dt, ContactRows* rows) {
  const Vector3 slip = tangential(motion.velocity_BA, c.normal_BA);
  const Vector3 slip_to_be = tangential(motion.velocity_BA + dt * motion.acceleration_BA, c.normal_BA);
  const Vector3 last = memo ? tangential(memo->friction, c.normal_BA) : Vector3::Zero();
  const Vector3 force = frictionToBe(last, last.norm() > NO_FORCE ? slip : slip_to_be, rows->tangent_cfm);
  rows->first_axis = force.norm() > NO_FORCE ? force.normalized() : c.normal_BA.unitOrthogonal();
  // Feed-forward of the last force: one proximal point step, so that the creep of the regularisation vanishes at rest.
  if (slip.norm() > STICKING_SPEED) return;
  rows->tangent_velocity = rows->tangent_cfm * last;
  const double speed = rows->tangent_velocity.norm();
  if (speed > MAX_FEED_FORWARD) rows->tangent_velocity *= MAX_FEED_FORWARD / speed;
}

}  // namespace

const ContactMemo* ContactMemory::find(std::uint64_t id) const {
  const auto it = std::lower_bound(memos_.begin(), memos_.end(), id, [](const ContactMemo& m, std::uint64_t i) { return m.id < i; });
  return it != memos_.end() && it->id == id ? &*it : nullptr;
}

void ContactMemory::replace(std::vector<ContactMemo> memos) {
  memos_ = std::move(memos);
  std::stable_sort(memos_.begin(), memos_.end(), [](const ContactMemo& a, const ContactMemo& b) { return a.id < b.id; });
}

void ContactMemory::forget(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on) { forgetRecords(ids, go_on, &memos_); }

void addMemo(const ContactConstraint& contact, const ContactRows& rows, const Vector3& force, std::vector<ContactMemo>* memos) {
  const double push = contact.normal_BA.dot(force);
  if (push > 0) memos->push_back({contact.id, force - push * contact.normal_BA, rows.approach});
}

NormalRow surfaceRow(const ContactConstraint& c, double dt, double softness, const SolverSettings& settings) {
  NormalRow row;
  row.compliance = softness;
  const double gap_speed = c.depth / dt;
  row.speed = c.depth <= 0 ? gap_speed : std::min(settings.correction_fraction * gap_speed, settings.max_correction_speed);
  if (!compliant(c)) return row;
  // f = k depth+ - d v+ with depth+ = depth - dt v+.
  row.compliance = std::max(softness, 1 / (dt * c.stiffness + c.damping));
  if (c.depth > 0) row.speed = std::min(1.0, dt * c.stiffness * row.compliance) * gap_speed;
  return row;
}

ContactRows contactRows(const ContactConstraint& contact, const ContactMotion& motion, const ContactMemo* memo, double dt,
                        const SolverSettings& settings) {
  NormalRow normal = surfaceRow(contact, dt, settings.cfm, settings);
  setRestitution(contact, motion, memo ? memo->approach : 0, dt, &normal);
  ContactRows rows;
  rows.normal_speed = normal.speed;
  rows.normal_cfm = normal.compliance;
  rows.approach = normal.approach;
  rows.tangent_cfm = settings.cfm;
  setFriction(contact, motion, memo, dt, &rows);
  return rows;
}

}  // namespace blem_sim::dynamics
