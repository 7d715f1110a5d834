#include "scene/contact_motion.h"

#include "scene/joint_readings.h"

namespace blem_sim::dynamics {
namespace {

struct PointMotion {
  Vector3 velocity = Vector3::Zero(), acceleration = Vector3::Zero();
};

PointMotion pointMotion(const Scene& scene, int body, const Vector3& point) {
  if (body == WORLD_BODY) return {};
  const BodySlot& slot = scene.bodies()[body];
  const Vector3 arm = point - scene.com(body);
  PointMotion motion;
  motion.velocity = scene.velocity(body) + scene.spin(body).cross(arm);
  motion.acceleration = scene.gravity() + slot.pending.force / slot.spec.inertial.mass;
  if (!slot.pending.torque.isZero(0))
    motion.acceleration += (inertiaInWorld(scene, body, scene.rotation(body)).inverse() * slot.pending.torque).cross(arm);
  return motion;
}

}  // namespace

bool isUsable(const Scene& scene, const ContactConstraint& c) {
  const bool a = scene.exists(c.body_a), b = scene.exists(c.body_b);
  return (a || c.body_a == WORLD_BODY) && (b || c.body_b == WORLD_BODY) && (a || b) && c.body_a != c.body_b;
}

ContactMotion contactMotion(const Scene& scene, const ContactConstraint& contact) {
  const PointMotion a = pointMotion(scene, contact.body_a, contact.point);
  const PointMotion b = pointMotion(scene, contact.body_b, contact.point);
  return {a.velocity - b.velocity, a.acceleration - b.acceleration};
}

}  // namespace blem_sim::dynamics
