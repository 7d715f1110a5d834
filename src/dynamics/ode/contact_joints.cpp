#include "ode/contact_joints.h"

#include <algorithm>
#include <cmath>

#include "scene/contact_motion.h"

namespace blem_sim::dynamics {
namespace {

// Largest friction coefficient of a pyramid, whose bound is the normal force times it: an infinite one would hold contacts that do not
// push.
constexpr double MAX_FRICTION = 1e6;

}  // namespace

void ContactJoints::prepare(const Scene& scene, const std::vector<ContactConstraint>& contacts, const ContactMemory& memory, double dt,
                            const SolverSettings& settings) {
  contacts_.resize(contacts.size());
  feedback_.assign(contacts.size(), dJointFeedback{});
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Contact& contact = contacts_[i];
    contact.constraint = contacts[i];
    contact.active = isUsable(scene, contacts[i]);
    contact.reversed = contacts[i].body_a == WORLD_BODY;
    if (!contact.active) continue;
    contact.rows = contactRows(contacts[i], contactMotion(scene, contacts[i]), memory.find(contacts[i].id), dt, settings);
  }
}

void ContactJoints::create(Scene* scene, double cfm_scale) {
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    if (contacts_[i].active) create(scene, contacts_[i], cfm_scale, &feedback_[i]);
}

void ContactJoints::create(Scene* scene, const Contact& contact, double cfm_scale, dJointFeedback* feedback) const {
  const ContactConstraint& c = contact.constraint;
  const ContactRows& rows = contact.rows;
  // Everything below is seen from ODE's first body.
  const double side = contact.reversed ? -1 : 1;
  const Vector3 normal = side * c.normal_BA, t1 = rows.first_axis, t2 = normal.cross(t1);
  const Vector3 tangent_velocity = side * rows.tangent_velocity;
  dContact ode = {};
  ode.surface.mode = dContactMotionN | dContactSoftCFM | dContactFDir1 | dContactApprox1 | dContactMotion1 | dContactMotion2 |
                     dContactSlip1 | dContactSlip2;
  ode.surface.mu = std::min(c.friction, MAX_FRICTION);
  ode.surface.motionN = rows.normal_speed;
  ode.surface.soft_cfm = rows.normal_cfm * cfm_scale;
  ode.surface.motion1 = tangent_velocity.dot(t1);
  ode.surface.motion2 = tangent_velocity.dot(t2);
  ode.surface.slip1 = ode.surface.slip2 = rows.tangent_cfm * cfm_scale;
  for (int k = 0; k < 3; ++k) {
    ode.geom.pos[k] = c.point[k];
    ode.geom.normal[k] = normal[k];
    ode.fdir1[k] = t1[k];
  }
  const dJointID joint = dJointCreateContact(scene->ode(), scene->contactGroup(), &ode);
  const auto body = [&](int index) { return index == WORLD_BODY ? nullptr : scene->bodies()[index].ode; };
  dJointAttach(joint, body(contact.reversed ? c.body_b : c.body_a), body(contact.reversed ? c.body_a : c.body_b));
  dJointSetFeedback(joint, feedback);
}

void ContactJoints::clear(Scene* scene) { dJointGroupEmpty(scene->contactGroup()); }

void ContactJoints::readForces(std::vector<Vector3>* forces) const {
  forces->resize(contacts_.size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) (*forces)[i] = (contacts_[i].reversed ? -1 : 1) * fromOde(feedback_[i].f1);
}

std::vector<ContactMemo> ContactJoints::memos(const std::vector<Vector3>& forces) const {
  std::vector<ContactMemo> memos;
  memos.reserve(contacts_.size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) addMemo(contacts_[i].constraint, contacts_[i].rows, forces[i], &memos);
  return memos;
}

}  // namespace blem_sim::dynamics
