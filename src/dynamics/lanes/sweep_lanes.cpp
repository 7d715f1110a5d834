#include "lanes/sweep_lanes.h"

#include <algorithm>
#include <cmath>

#include "lanes/lane_vectors.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // of functions that are always inlined

namespace blem_sim::dynamics {
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

BLEM_SIM_INLINE Six respond(const double (&r)[21][SWEEP_LANES], int l, const Six& w) {
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

using Four = double __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
using FourFlags = decltype(Four() > Four());

/** A number of each lane: two of the vectors that most processors have, so that one works while the other waits. */
struct Wide {
  Four low, high;

  BLEM_SIM_INLINE double operator[](int lane) const { return lane < LANES ? low[lane] : high[lane - LANES]; }
};
/** Answers of comparisons, lane by lane. */
struct WideFlags {
  FourFlags low, high;
};
BLEM_SIM_INLINE Wide operator+(const Wide& a, const Wide& b) { return {a.low + b.low, a.high + b.high}; }
BLEM_SIM_INLINE Wide operator-(const Wide& a, const Wide& b) { return {a.low - b.low, a.high - b.high}; }
BLEM_SIM_INLINE Wide operator*(const Wide& a, const Wide& b) { return {a.low * b.low, a.high * b.high}; }
BLEM_SIM_INLINE Wide operator/(const Wide& a, const Wide& b) { return {a.low / b.low, a.high / b.high}; }
BLEM_SIM_INLINE Wide operator-(const Wide& a) { return {-a.low, -a.high}; }
BLEM_SIM_INLINE void operator+=(Wide& a, const Wide& b) { a = a + b; }
BLEM_SIM_INLINE WideFlags operator>(const Wide& a, const Wide& b) { return {a.low > b.low, a.high > b.high}; }
BLEM_SIM_INLINE WideFlags operator<=(const Wide& a, const Wide& b) { return {a.low <= b.low, a.high <= b.high}; }
BLEM_SIM_INLINE Wide either(const WideFlags& first, const Wide& a, const Wide& b) {
  return {first.low ? a.low : b.low, first.high ? a.high : b.high};
}
BLEM_SIM_INLINE Four squareRoot(const Four& x) {
  Four root;
  for (int lane = 0; lane < LANES; ++lane) root[lane] = __builtin_sqrt(x[lane]);
  return root;
}
BLEM_SIM_INLINE double sum(const Four& x) { return (x[0] + x[1]) + (x[2] + x[3]); }
BLEM_SIM_INLINE double largestOf(const Wide& x) {
  return std::max({x.low[0], x.low[1], x.low[2], x.low[3], x.high[0], x.high[1], x.high[2], x.high[3]});
}
BLEM_SIM_INLINE Wide squareRoot(const Wide& x) { return {squareRoot(x.low), squareRoot(x.high)}; }

BLEM_SIM_INLINE Wide wide(const SweepLanes& lanes) {
  return {*reinterpret_cast<const Four*>(lanes), *reinterpret_cast<const Four*>(lanes + LANES)};
}
BLEM_SIM_INLINE void put(const Wide& x, SweepLanes* lanes) {
  *reinterpret_cast<Four*>(*lanes) = x.low;
  *reinterpret_cast<Four*>(*lanes + LANES) = x.high;
}

struct WideTriples {
  Wide x, y, z;
};
BLEM_SIM_INLINE WideTriples all(const SweepVectors& v) { return {wide(v[0]), wide(v[1]), wide(v[2])}; }
BLEM_SIM_INLINE Wide dot(const WideTriples& a, const WideTriples& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BLEM_SIM_INLINE WideTriples cross(const WideTriples& a, const WideTriples& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BLEM_SIM_INLINE WideTriples operator+(const WideTriples& a, const WideTriples& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
BLEM_SIM_INLINE WideTriples operator-(const WideTriples& a, const WideTriples& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
BLEM_SIM_INLINE WideTriples operator-(const WideTriples& a) { return {-a.x, -a.y, -a.z}; }
BLEM_SIM_INLINE WideTriples operator*(const Wide& s, const WideTriples& a) { return {s * a.x, s * a.y, s * a.z}; }

/** Angular and linear velocities of eight bodies. */
struct WideBodies {
  WideTriples angular, linear;
};

BLEM_SIM_INLINE WideBodies gather(const double* const (&from)[SWEEP_LANES]) {
  Wide v[6];
  for (int i = 0; i < 6; ++i)
    v[i] = Wide{Four{from[0][i], from[1][i], from[2][i], from[3][i]}, Four{from[4][i], from[5][i], from[6][i], from[7][i]}};
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

BLEM_SIM_INLINE void scatter(const WideBodies& v, double* const (&to)[SWEEP_LANES]) {
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
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
BLEM_SIM_INLINE void push(const BodyLanes& body, const WideTriples& torque, const WideTriples& force, WideBodies* v) {
  const auto& r = body.inverse_inertia;
  const Wide xx = wide(r[0]), xy = wide(r[1]), yy = wide(r[2]), xz = wide(r[3]), yz = wide(r[4]), zz = wide(r[5]);
  v->angular.x += xx * torque.x + xy * torque.y + xz * torque.z;
  v->angular.y += xy * torque.x + yy * torque.y + yz * torque.z;
  v->angular.z += xz * torque.x + yz * torque.y + zz * torque.z;
  v->linear = v->linear + wide(body.inverse_mass) * force;
}

/** SweepChange by lane. */
struct WideChanges {
  Wide squared = {}, largest = {}, strongest = {};

  BLEM_SIM_INLINE void add(const Wide& change, const Wide& strength) {
    squared += change;
    largest = either(change > largest, change, largest);
    strongest = either(strength > strongest, strength, strongest);
  }
  BLEM_SIM_INLINE void put(SweepChange* out) const {
    out->squared[0] = sum(squared.low);
    out->squared[1] = sum(squared.high);
    out->largest = largestOf(largest);
    out->impulse = largestOf(strongest);
  }
};

/** Visits a contact of each lane, whose points have the relative velocity u. @return changes of the impulses */
BLEM_SIM_INLINE WideTriples visit(const SweepContact& c, const WideTriples& u, SweepImpulse* impulse, WideChanges* changes) {
  const Wide zero = {}, one = {Four{1, 1, 1, 1}, Four{1, 1, 1, 1}};
  const WideTriples n = all(c.axis[0]), s = all(c.axis[1]), t = all(c.axis[2]);
  const Wide g_n = wide(impulse->now[0]), g_s = wide(impulse->now[1]), g_t = wide(impulse->now[2]);
  const Wide miss = dot(n, u) + wide(c.compliance) * g_n - wide(c.target);
  const Wide wanted = g_n - wide(c.normal_gain) * miss, push = either(wanted > zero, wanted, zero), pushed = push - g_n;
  const Wide u_s = dot(s, u) + wide(c.offset[0]) + wide(c.mixed[0]) * pushed;
  const Wide u_t = dot(t, u) + wide(c.offset[1]) + wide(c.mixed[1]) * pushed;
  // Friction that sticks ends the slip. If that is beyond the cone it moves against the slip, and back onto the cone.
  const Wide stick_s = g_s - (wide(c.tangent_inverse[0]) * u_s + wide(c.tangent_inverse[1]) * u_t);
  const Wide stick_t = g_t - (wide(c.tangent_inverse[1]) * u_s + wide(c.tangent_inverse[2]) * u_t);
  const Wide most = wide(c.friction) * push;
  const Wide slide_s = g_s - wide(c.slide_gain) * u_s, slide_t = g_t - wide(c.slide_gain) * u_t;
  const Wide size = squareRoot(slide_s * slide_s + slide_t * slide_t), back = either(size > most, most / size, one);
  const WideFlags sticks = stick_s * stick_s + stick_t * stick_t <= most * most;
  const Wide change_s = either(sticks, stick_s, back * slide_s) - g_s, change_t = either(sticks, stick_t, back * slide_t) - g_t;
  const Wide now_s = g_s + change_s, now_t = g_t + change_t;
  put(push, &impulse->now[0]);
  put(now_s, &impulse->now[1]);
  put(now_t, &impulse->now[2]);
  put(pushed, &impulse->change[0]);
  put(change_s, &impulse->change[1]);
  put(change_t, &impulse->change[2]);
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
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
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

BLEM_SIM_LANES void wrenchOf(const SweptContacts& contacts, TwistLanes* wrench) {
  const SweepImpulse* impulse = contacts.impulses;
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < SWEEP_LANES; ++lane) (*wrench)[i][lane] = 0;
  for (const SweepContact* c = contacts.begin; c != contacts.end; ++c, ++impulse) {
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      const Triple f = impulse->now[0][lane] * at(c->axis[0], lane) + impulse->now[1][lane] * at(c->axis[1], lane) +
                       impulse->now[2][lane] * at(c->axis[2], lane);
      add({cross(at(c->point, lane), f), f}, lane, wrench);
    }
  }
}

BLEM_SIM_LANES void sweep(const SweepGroup& group, const SweptContacts& contacts, const TwistLanes& start, TwistLanes* wrench,
                          SweepChange* change) {
  SweepImpulse* impulse = contacts.impulses;
  WideChanges changes;
  TwistLanes twist, given_so_far = {};
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < SWEEP_LANES; ++lane) twist[i][lane] = start[i][lane];
  for (const SweepContact* c = contacts.begin; c != contacts.end; ++c, ++impulse) {
    const WideTriples p = all(c->point), w = {wide(twist[0]), wide(twist[1]), wide(twist[2])};
    const WideTriples v = {wide(twist[3]), wide(twist[4]), wide(twist[5])};
    const WideTriples f = visit(*c, v + cross(w, p), impulse, &changes), m = cross(p, f);
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      const Six given = {{m.x[lane], m.y[lane], m.z[lane]}, {f.x[lane], f.y[lane], f.z[lane]}};
      add(given, lane, &given_so_far);
      add(respond(group.response, lane, given), lane, &twist);
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < SWEEP_LANES; ++lane) (*wrench)[i][lane] = given_so_far[i][lane];
  changes.put(change);
}

BLEM_SIM_LANES void sweepFree(const SweepBodies& bodies, const SweptContacts& contacts, double* velocity, SweepChange* change) {
  SweepImpulse* impulse = contacts.impulses;
  double nothing[6] = {};
  double *of_a[SWEEP_LANES], *of_b[SWEEP_LANES];
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    of_a[lane] = bodies.a.first[lane] < 0 ? nothing : velocity + bodies.a.first[lane];
    of_b[lane] = bodies.b.first[lane] < 0 ? nothing : velocity + bodies.b.first[lane];
  }
  WideChanges changes;
  WideBodies a = gather(of_a), b = gather(of_b);
  const WideTriples shift = all(bodies.shift);
  for (const SweepContact* c = contacts.begin; c != contacts.end; ++c, ++impulse) {
    const WideTriples p_a = all(c->point), p_b = p_a - shift;
    const WideTriples u = (a.linear + cross(a.angular, p_a)) - (b.linear + cross(b.angular, p_b));
    const WideTriples f = visit(*c, u, impulse, &changes);
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
      for (int lane = 0; lane < SWEEP_LANES; ++lane) {
        const double along = share * g->search[i][lane];
        g->now[i][lane] += along;
        g->search[i][lane] = along + g->change[i][lane];
      }
}

BLEM_SIM_LANES void scale(double factor, SweepImpulse* begin, SweepImpulse* end) {
  for (SweepImpulse* g = begin; g != end; ++g)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < SWEEP_LANES; ++lane) g->now[i][lane] *= factor;
}

}  // namespace blem_sim::dynamics
