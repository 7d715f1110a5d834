// Bodies of the scene: ODE's body sits at the centre of mass, with the axes of the body frame B.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "blem_sim/geometry/free_slots.h"
#include "blem_sim/geometry/input_error.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {
namespace {

constexpr double LEAST = 1e-30, MOST = 1e30;  // [kg], and [kg m^2] along a principal axis
constexpr double MOST_OBLONG = 1e12;          // largest principal inertia over the smallest

void checkBody(const BodySpec& spec) {
  const geometry::MassProperties& m = spec.inertial;
  const std::string where = "body '" + spec.name + "': ";
  if (!(m.mass > 0) || !std::isfinite(m.mass))
    throw InputError(fmt::format("{}mass is {:g} kg; give it a finite mass above 0", where, m.mass));
  if (!(m.mass >= LEAST && m.mass <= MOST))
    throw InputError(fmt::format("{}mass is {:g} kg; give it {:g} to {:g}", where, m.mass, LEAST, MOST));
  if (!m.com.allFinite() || !spec.X_WB.matrix().allFinite())
    throw InputError(where + "centre of mass or pose is not finite; correct its origin");
  if (!m.inertia.allFinite()) throw InputError(where + "inertia is not finite; correct ixx..izz");
  const Vector3 principal = Eigen::SelfAdjointEigenSolver<Matrix3>(m.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(principal[0] > 0)) throw InputError(where + "inertia is not positive definite; correct ixx..izz");
  if (!(principal[0] >= LEAST && principal[2] <= MOST && principal[2] <= MOST_OBLONG * principal[0]))
    throw InputError(
        fmt::format("{}principal inertias are {:g} to {:g} kg m^2; give it ones from {:g} to {:g} that differ by {:g} times at most", where,
                    principal[0], principal[2], LEAST, MOST, MOST_OBLONG));
}

void setMass(dBodyID body, const geometry::MassProperties& m) {
  dMass mass;
  dMassSetParameters(&mass, m.mass, 0, 0, 0, m.inertia(0, 0), m.inertia(1, 1), m.inertia(2, 2), m.inertia(0, 1), m.inertia(0, 2),
                     m.inertia(1, 2));
  dBodySetMass(body, &mass);
}

/** Moves the centre of mass that the bits are of by an offset [m] in the body's axes. */
void moveCom(const Vector3& offset, BodyBits* bits) {
  const Vector3 com = bits->com() + bits->rotation() * offset;
  std::copy_n(com.data(), 3, bits->numbers);
}

}  // namespace

int Scene::addBody(const BodySpec& spec) {
  checkBody(spec);
  BodySlot slot;
  slot.spec = spec;
  createBody(&slot);
  const int body = geometry::takeSlot(&free_bodies_, &bodies_);
  bodies_[body] = slot;
  ++structure_;
  BodyState state;
  state.X_WB = spec.X_WB;
  setBodyState(body, state);
  return body;
}

void Scene::createBody(BodySlot* slot) {
  slot->ode = dBodyCreate(world_);
  setMass(slot->ode, slot->spec.inertial);
  dBodySetGyroscopicMode(slot->ode, 1);
  // Rotation by the exponential map: a hinge then turns by exactly dt times its speed.
  dBodySetFiniteRotationMode(slot->ode, 1);
}

void Scene::setInertial(int body, const geometry::MassProperties& inertial) {
  BodySlot& slot = bodies_[body];
  BodySpec spec = slot.spec;
  spec.inertial = inertial;
  checkBody(spec);
  const Vector3 offset = inertial.com - slot.spec.inertial.com;
  BodyState state = bodyState(body);
  state.v_WCom += state.w_WB.cross(state.X_WB.linear() * offset);
  slot.spec = spec;
  setMass(slot.ode, inertial);
  ++structure_;
  if (offset.isZero(0)) return;
  setBodyState(body, state);
  // ODE holds a joint's geometry against the centres of mass.
  for (JointSlot& joint : joints_) {
    if (!joint.joint || (joint.spec.child != body && joint.spec.parent != body)) continue;
    moveCom(offset, joint.spec.child == body ? &joint.child_assembled : &joint.parent_assembled);
    recreateJoint(&joint);
  }
}

void BodyBits::set(const Vector3& com, const Matrix3& R, const Vector3& velocity, const Vector3& spin) {
  const Quaternion q = Quaternion(R).normalized();
  double* to = numbers;
  for (int i = 0; i < 3; ++i) *to++ = com[i];
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) *to++ = x;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) *to++ = R(row, column);
    *to++ = 0;
  }
  for (int i = 0; i < 3; ++i) *to++ = velocity[i];
  for (int i = 0; i < 3; ++i) *to++ = spin[i];
}

BodyBits Scene::bits(int body) const {
  const dBodyID ode = bodies_[body].ode;
  BodyBits out;
  std::copy_n(dBodyGetPosition(ode), 3, out.numbers);
  std::copy_n(dBodyGetQuaternion(ode), 4, out.numbers + 3);
  std::copy_n(dBodyGetRotation(ode), 12, out.numbers + 7);
  std::copy_n(dBodyGetLinearVel(ode), 3, out.numbers + 19);
  std::copy_n(dBodyGetAngularVel(ode), 3, out.numbers + 22);
  return out;
}

bool Scene::hasBits(int body, const BodyBits& bits) const {
  const dBodyID ode = bodies_[body].ode;
  const double* known = bits.numbers;
  // Few bodies are changed from outside, so all numbers are compared before the result is asked for.
  std::uint64_t differs = 0;
  const auto compare = [&](const dReal* numbers, int count) {
    for (int i = 0; i < count; ++i) {
      std::uint64_t one, other;
      std::memcpy(&one, numbers + i, sizeof one);
      std::memcpy(&other, known++, sizeof other);
      differs |= one ^ other;
    }
  };
  compare(dBodyGetPosition(ode), 3);
  compare(dBodyGetQuaternion(ode), 4);
  compare(dBodyGetRotation(ode), 12);
  compare(dBodyGetLinearVel(ode), 3);
  compare(dBodyGetAngularVel(ode), 3);
  return differs == 0;
}

void Scene::setBits(int body, const BodyBits& bits) {
  const dBodyID ode = bodies_[body].ode;
  const double* n = bits.numbers;
  dBodySetPosition(ode, n[0], n[1], n[2]);
  // The getters give ODE's own arrays; its setters would normalise and so change the last bits. The body has no geoms to tell.
  std::copy_n(n + 3, 4, const_cast<dReal*>(dBodyGetQuaternion(ode)));
  std::copy_n(n + 7, 12, const_cast<dReal*>(dBodyGetRotation(ode)));
  dBodySetLinearVel(ode, n[19], n[20], n[21]);
  dBodySetAngularVel(ode, n[22], n[23], n[24]);
}

BodyState Scene::bodyState(int body) const {
  BodyState state;
  state.X_WB.linear() = rotation(body);
  state.X_WB.translation() = com(body) - state.X_WB.linear() * bodies_[body].spec.inertial.com;
  state.v_WCom = velocity(body);
  state.w_WB = spin(body);
  return state;
}

void Scene::setBodyState(int body, const BodyState& state) {
  const dBodyID ode = bodies_[body].ode;
  const Quaternion q = Quaternion(state.X_WB.linear()).normalized();
  const dQuaternion numbers = {q.w(), q.x(), q.y(), q.z()};
  dBodySetQuaternion(ode, numbers);
  const Vector3 com = state.X_WB * bodies_[body].spec.inertial.com;
  dBodySetPosition(ode, com.x(), com.y(), com.z());
  dBodySetLinearVel(ode, state.v_WCom.x(), state.v_WCom.y(), state.v_WCom.z());
  dBodySetAngularVel(ode, state.w_WB.x(), state.w_WB.y(), state.w_WB.z());
}

}  // namespace blem_sim::dynamics
