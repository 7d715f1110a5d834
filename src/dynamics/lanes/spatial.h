// Six-dimensional vectors of rigid body mechanics: angular part first, linear part last, world axes, about one reference point.
#pragma once

#include "blem_sim/geometry/triangle_mesh.h"
#include "blem_sim/geometry/types.h"

namespace blem_sim::dynamics {

/** Twist (spin, velocity of the reference point) or wrench (torque about it, force). */
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Number by number: these are the innermost loops, and small blocks of a vector are slow to put together.
inline Vector6 spatial(const Vector3& a, const Vector3& l) {
  Vector6 out;
  for (int i = 0; i < 3; ++i) {
    out[i] = a[i];
    out[3 + i] = l[i];
  }
  return out;
}
inline Vector3 angular(const Vector6& v) { return {v[0], v[1], v[2]}; }
inline Vector3 linear(const Vector6& v) { return {v[3], v[4], v[5]}; }
inline Vector3 crossProduct(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector3 sum(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/** Velocity of a point that a twist carries along. */
inline Vector3 velocityAt(const Vector6& twist, const Vector3& point) { return sum(linear(twist), crossProduct(angular(twist), point)); }

/** Wrench of a force at a point. */
inline Vector6 wrenchOf(const Vector3& force, const Vector3& point) { return spatial(crossProduct(point, force), force); }

/** The same wrench about another reference point. @param shift from the new reference point to the old one */
inline Vector6 moveWrench(const Vector6& w, const Vector3& shift) {
  return spatial(sum(angular(w), crossProduct(shift, linear(w))), linear(w));
}

/** The same twist about another reference point. @param shift from the old reference point to the new one */
inline Vector6 moveTwist(const Vector6& v, const Vector3& shift) { return spatial(angular(v), velocityAt(v, shift)); }

/** Rate of change of the twist w when carried along by v. */
inline Vector6 crossMotion(const Vector6& v, const Vector6& w) {
  return spatial(crossProduct(angular(v), angular(w)), sum(crossProduct(angular(v), linear(w)), crossProduct(linear(v), angular(w))));
}

/** Rate of change of the momentum f when carried along by v. */
inline Vector6 crossForce(const Vector6& v, const Vector6& f) {
  return spatial(sum(crossProduct(angular(v), angular(f)), crossProduct(linear(v), linear(f))), crossProduct(angular(v), linear(f)));
}

inline Matrix3 crossMatrix(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/** Rigid body inertia about the reference point: sums of bodies are sums of these numbers. */
struct SpatialInertia {
  double mass = 0;
  Vector3 first_moment = Vector3::Zero();  ///< mass * com [kg m]
  Matrix3 rotational = Matrix3::Zero();    ///< [kg m^2] about the reference point

  SpatialInertia() = default;
  /** @param com of the body, about the reference point; R_WB turns the body's inertia into world axes */
  SpatialInertia(const geometry::MassProperties& body, const Matrix3& R_WB, const Vector3& com)
      : mass(body.mass), first_moment(body.mass * com) {
    rotational.noalias() = R_WB * body.inertia * R_WB.transpose();
    rotational -= first_moment * com.transpose();
    rotational.diagonal().array() += first_moment.dot(com);
  }

  void add(const SpatialInertia& o) {
    mass += o.mass;
    first_moment += o.first_moment;
    rotational += o.rotational;
  }
  /** Momentum (angular about the reference point, linear) of a body that moves with twist v. */
  Vector6 times(const Vector6& v) const {
    const Vector3 w = angular(v), l = linear(v), hl = crossProduct(first_moment, l), hw = crossProduct(first_moment, w);
    Vector6 out;
    for (int i = 0; i < 3; ++i) {
      out[i] = rotational(i, 0) * w[0] + rotational(i, 1) * w[1] + rotational(i, 2) * w[2] + hl[i];
      out[3 + i] = mass * l[i] - hw[i];
    }
    return out;
  }
};

}  // namespace blem_sim::dynamics
