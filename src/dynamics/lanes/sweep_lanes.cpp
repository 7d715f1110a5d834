#include "lanes/sweep_lanes.h"

#include <algorithm>
#include <cmath>

#include "lanes/lane_vectors.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // of functions that are always inlined

namespace blem_sim {
namespace {

/** A lane's relative twist or wrench. */
struct Six {
  Triple angular, linear;
};
BLEM_SIM_INLINE Six at(const TwistLanes& v, int lane) {
  return {{v[0][lane], v[1][lane], v[2][lane]}, {v[3][lane], v[4][lane], v[5][lane]}};
}
BLEM_SIM_INLINE void add(const Six& v, int lane, TwistLanes* to) {
  (*to)[0][lane] += v.angular.x;
  (*to)[1][lane] += v.angular.y;
  (*to)[2][lane] += v.angular.z;
  (*to)[3][lane] += v.linear.x;
  (*to)[4][lane] += v.linear.y;
  (*to)[5][lane] += v.linear.z;
}

BLEM_SIM_INLINE Six respond(const double (&r)[21][LANES], int l, const Six& w) {
  const Triple &a = w.angular, &f = w.linear;
  Six v;
  v.angular.x = (r[0][l] * a.x + r[1][l] * a.y + r[3][l] * a.z) + (r[6][l] * f.x + r[10][l] * f.y + r[15][l] * f.z);
  v.angular.y = (r[1][l] * a.x + r[2][l] * a.y + r[4][l] * a.z) + (r[7][l] * f.x + r[11][l] * f.y + r[16][l] * f.z);
  v.angular.z = (r[3][l] * a.x + r[4][l] * a.y + r[5][l] * a.z) + (r[8][l] * f.x + r[12][l] * f.y + r[17][l] * f.z);
  v.linear.x = (r[6][l] * a.x + r[7][l] * a.y + r[8][l] * a.z) + (r[9][l] * f.x + r[13][l] * f.y + r[18][l] * f.z);
  v.linear.y = (r[10][l] * a.x + r[11][l] * a.y + r[12][l] * a.z) + (r[13][l] * f.x + r[14][l] * f.y + r[19][l] * f.z);
  v.linear.z = (r[15][l] * a.x + r[16][l] * a.y + r[17][l] * a.z) + (r[18][l] * f.x + r[19][l] * f.y + r[20][l] * f.z);
  return v;
}

/** A number of each lane. Compilers lower it to the processor's own vectors. */
using Four = double __attribute__((vector_size(8 * LANES), aligned(8), may_alias));

BLEM_SIM_INLINE const Four& four(const Lanes& lanes) { return *reinterpret_cast<const Four*>(lanes); }
BLEM_SIM_INLINE Four& four(Lanes& lanes) { return *reinterpret_cast<Four*>(lanes); }

struct FourTriples {
  Four x, y, z;
};
BLEM_SIM_INLINE FourTriples all(const VectorLanes& v) { return {four(v[0]), four(v[1]), four(v[2])}; }
BLEM_SIM_INLINE Four dot(const FourTriples& a, const FourTriples& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BLEM_SIM_INLINE FourTriples cross(const FourTriples& a, const FourTriples& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BLEM_SIM_INLINE FourTriples operator+(const FourTriples& a, const FourTriples& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
BLEM_SIM_INLINE FourTriples operator-(const FourTriples& a, const FourTriples& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
BLEM_SIM_INLINE FourTriples operator-(const FourTriples& a) { return {-a.x, -a.y, -a.z}; }
BLEM_SIM_INLINE FourTriples operator*(const Four& s, const FourTriples& a) { return {s * a.x, s * a.y, s * a.z}; }

BLEM_SIM_INLINE Four squareRoot(const Four& x) {
  Four root;
  for (int lane = 0; lane < LANES; ++lane) root[lane] = __builtin_sqrt(x[lane]);
  return root;
}

/** Angular and linear velocities of four bodies. */
struct FourBodies {
  FourTriples angular, linear;
};

BLEM_SIM_INLINE FourBodies gather(const double* const (&from)[LANES]) {
  Four v[6];
  for (int i = 0; i < 6; ++i) v[i] = Four{from[0][i], from[1][i], from[2][i], from[3][i]};
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

BLEM_SIM_INLINE void scatter(const FourBodies& v, double* const (&to)[LANES]) {
  for (int lane = 0; lane < LANES; ++lane) {
    double* out = to[lane];
    out[0] = v.angular.x[lane];
    out[1] = v.angular.y[lane];
    out[2] = v.angular.z[lane];
    out[3] = v.linear.x[lane];
    out[4] = v.linear.y[lane];
    out[5] = v.linear.z[lane];
  }
}

/** Adds the changes of velocity by a torque about the centres of mass and a force. */
BLEM_SIM_INLINE void push(const BodyLanes& body, const FourTriples& torque, const FourTriples& force, FourBodies* v) {
  const auto& r = body.inverse_inertia;
  const Four xx = four(r[0]), xy = four(r[1]), yy = four(r[2]), xz = four(r[3]), yz = four(r[4]), zz = four(r[5]);
  v->angular.x += xx * torque.x + xy * torque.y + xz * torque.z;
  v->angular.y += xy * torque.x + yy * torque.y + yz * torque.z;
  v->angular.z += xz * torque.x + yz * torque.y + zz * torque.z;
  v->linear = v->linear + four(body.inverse_mass) * force;
}

/** SweepChange by lane. */
struct FourChanges {
  Four squared = {}, largest = {}, strongest = {};

  BLEM_SIM_INLINE void add(const Four& change, const Four& strength) {
    squared += change;
    largest = change > largest ? change : largest;
    strongest = strength > strongest ? strength : strongest;
  }
  BLEM_SIM_INLINE void put(SweepChange* out) const {
    out->squared = (squared[0] + squared[1]) + (squared[2] + squared[3]);
    out->largest = std::max({largest[0], largest[1], largest[2], largest[3]});
    out->impulse = std::max({strongest[0], strongest[1], strongest[2], strongest[3]});
  }
};

/** Visits a contact of each lane, whose points have the relative velocity u. @return changes of the impulses */
BLEM_SIM_INLINE FourTriples visit(const SweepContact& c, const FourTriples& u, SweepImpulse* impulse, FourChanges* changes) {
  const Four zero = {}, one = {1, 1, 1, 1};
  const FourTriples n = all(c.axis[0]), s = all(c.axis[1]), t = all(c.axis[2]);
  const Four g_n = four(impulse->now[0]), g_s = four(impulse->now[1]), g_t = four(impulse->now[2]);
  const Four miss = dot(n, u) + four(c.compliance) * g_n - four(c.target);
  const Four wanted = g_n - four(c.normal_gain) * miss, push = wanted > zero ? wanted : zero, pushed = push - g_n;
  const Four u_s = dot(s, u) + four(c.offset[0]) + four(c.mixed[0]) * pushed;
  const Four u_t = dot(t, u) + four(c.offset[1]) + four(c.mixed[1]) * pushed;
  // Friction that sticks ends the slip. If that is beyond the cone it moves against the slip, and back onto the cone.
  const Four stick_s = g_s - (four(c.tangent_inverse[0]) * u_s + four(c.tangent_inverse[1]) * u_t);
  const Four stick_t = g_t - (four(c.tangent_inverse[1]) * u_s + four(c.tangent_inverse[2]) * u_t);
  const Four most = four(c.friction) * push;
  const Four slide_s = g_s - four(c.slide_gain) * u_s, slide_t = g_t - four(c.slide_gain) * u_t;
  const Four size = squareRoot(slide_s * slide_s + slide_t * slide_t), back = size > most ? most / size : one;
  const auto sticks = stick_s * stick_s + stick_t * stick_t <= most * most;
  const Four change_s = (sticks ? stick_s : back * slide_s) - g_s, change_t = (sticks ? stick_t : back * slide_t) - g_t;
  const Four now_s = g_s + change_s, now_t = g_t + change_t;
  four(impulse->now[0]) = push;
  four(impulse->now[1]) = now_s;
  four(impulse->now[2]) = now_t;
  four(impulse->change[0]) = pushed;
  four(impulse->change[1]) = change_s;
  four(impulse->change[2]) = change_t;
  changes->add(pushed * pushed + change_s * change_s + change_t * change_t, push * push + now_s * now_s + now_t * now_t);
  return pushed * n + change_s * s + change_t * t;
}

}  // namespace

void setLane(const ContactTerm* term, int lane, SweepContact* contact, SweepImpulse* impulse) {
  Vector3 point = Vector3::Zero(), previous = Vector3::Zero(), bend = Vector3::Zero();
  Vector3 axes[3] = {Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  if (term) {
    point = term->point;
    previous = term->previous;
    bend = term->bend;
    axes[0] = term->normal;
    axes[1] = term->normal.unitOrthogonal();
    axes[2] = crossProduct(axes[0], axes[1]);
  }
  for (int i = 0; i < 3; ++i) {
    contact->point[i][lane] = point[i];
    for (int k = 0; k < 3; ++k) contact->axis[k][i][lane] = axes[k][i];
    impulse->now[i][lane] = axes[i].dot(previous);
    impulse->change[i][lane] = impulse->search[i][lane] = 0;
  }
  contact->friction[lane] = term ? term->friction : 0;
  contact->compliance[lane] = term ? term->compliance : 0;
  contact->target[lane] = term ? term->target : -1;
  for (int k = 0; k < 2; ++k) contact->offset[k][lane] = axes[1 + k].dot(bend);
}

BLEM_SIM_LANES void setGains(const SweepGroup& group, SweepContact* begin, SweepContact* end) {
  for (SweepContact* c = begin; c != end; ++c) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple p = at(c->point, lane), n = at(c->axis[0], lane), s = at(c->axis[1], lane), t = at(c->axis[2], lane);
      const auto velocity = [&](const Triple& f) {
        const Six v = respond(group.response, lane, {cross(p, f), f});
        return v.linear + cross(v.angular, p);
      };
      const Triple by_n = velocity(n), by_s = velocity(s), by_t = velocity(t);
      const double w_n = dot(n, by_n) + c->compliance[lane];
      const double w11 = dot(s, by_s), w12 = dot(t, by_s), w22 = dot(t, by_t);
      const double half = 0.5 * (w11 + w22), apart = 0.5 * (w11 - w22), largest = half + __builtin_sqrt(apart * apart + w12 * w12);
      const double determinant = w11 * w22 - w12 * w12;
      // Points that cannot move across the normal, or only along one line, need no inverse of their own.
      const bool regular = determinant > 1e-12 * largest * largest;
      const double inverse = regular ? 1 / determinant : 0, along = largest > 0 ? 1 / largest : 0;
      c->normal_gain[lane] = w_n > 0 ? 1 / w_n : 0;
      c->mixed[0][lane] = dot(s, by_n);
      c->mixed[1][lane] = dot(t, by_n);
      c->tangent_inverse[0][lane] = regular ? inverse * w22 : along;
      c->tangent_inverse[1][lane] = regular ? -inverse * w12 : 0;
      c->tangent_inverse[2][lane] = regular ? inverse * w11 : along;
      c->slide_gain[lane] = along;
    }
  }
}

Vector3 readLane(const SweepContact& contact, const SweepImpulse& impulse, int lane) {
  Vector3 out = Vector3::Zero();
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) out[i] += contact.axis[k][i][lane] * impulse.now[k][lane];
  return out;
}

BLEM_SIM_LANES void wrenchOf(const SweepContact* begin, const SweepContact* end, const SweepImpulse* impulse, TwistLanes* wrench) {
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < LANES; ++lane) (*wrench)[i][lane] = 0;
  for (const SweepContact* c = begin; c != end; ++c, ++impulse) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple f = impulse->now[0][lane] * at(c->axis[0], lane) + impulse->now[1][lane] * at(c->axis[1], lane) +
                       impulse->now[2][lane] * at(c->axis[2], lane);
      add({cross(at(c->point, lane), f), f}, lane, wrench);
    }
  }
}

BLEM_SIM_LANES void sweep(const SweepGroup& group, const SweepContact* begin, const SweepContact* end, SweepImpulse* impulse,
                          const TwistLanes& start, TwistLanes* wrench, SweepChange* change) {
  FourChanges changes;
  TwistLanes twist, given_so_far = {};
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < LANES; ++lane) twist[i][lane] = start[i][lane];
  for (const SweepContact* c = begin; c != end; ++c, ++impulse) {
    const FourTriples p = all(c->point), w = {four(twist[0]), four(twist[1]), four(twist[2])};
    const FourTriples v = {four(twist[3]), four(twist[4]), four(twist[5])};
    const FourTriples f = visit(*c, v + cross(w, p), impulse, &changes), m = cross(p, f);
    for (int lane = 0; lane < LANES; ++lane) {
      const Six given = {{m.x[lane], m.y[lane], m.z[lane]}, {f.x[lane], f.y[lane], f.z[lane]}};
      add(given, lane, &given_so_far);
      add(respond(group.response, lane, given), lane, &twist);
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < LANES; ++lane) (*wrench)[i][lane] = given_so_far[i][lane];
  changes.put(change);
}

BLEM_SIM_LANES void sweepFree(const SweepBodies& bodies, const SweepContact* begin, const SweepContact* end, SweepImpulse* impulse,
                              double* velocity, SweepChange* change) {
  double nothing[6] = {};
  double *of_a[LANES], *of_b[LANES];
  for (int lane = 0; lane < LANES; ++lane) {
    of_a[lane] = bodies.a.first_dof[lane] < 0 ? nothing : velocity + bodies.a.first_dof[lane];
    of_b[lane] = bodies.b.first_dof[lane] < 0 ? nothing : velocity + bodies.b.first_dof[lane];
  }
  FourChanges changes;
  FourBodies a = gather(of_a), b = gather(of_b);
  const FourTriples shift = all(bodies.shift);
  for (const SweepContact* c = begin; c != end; ++c, ++impulse) {
    const FourTriples p_a = all(c->point), p_b = p_a - shift;
    const FourTriples u = (a.linear + cross(a.angular, p_a)) - (b.linear + cross(b.angular, p_b));
    const FourTriples f = visit(*c, u, impulse, &changes);
    push(bodies.a, cross(p_a, f), f, &a);
    push(bodies.b, cross(f, p_b), -f, &b);
  }
  scatter(a, of_a);
  scatter(b, of_b);
  changes.put(change);
}

BLEM_SIM_LANES void moveOn(double share, SweepImpulse* begin, SweepImpulse* end) {
  for (SweepImpulse* g = begin; g != end; ++g)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < LANES; ++lane) {
        const double along = share * g->search[i][lane];
        g->now[i][lane] += along;
        g->search[i][lane] = along + g->change[i][lane];
      }
}

BLEM_SIM_LANES void scale(double factor, SweepImpulse* begin, SweepImpulse* end) {
  for (SweepImpulse* g = begin; g != end; ++g)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < LANES; ++lane) g->now[i][lane] *= factor;
}

}  // namespace blem_sim
