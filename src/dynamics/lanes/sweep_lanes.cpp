#include "lanes/sweep_lanes.h"

#include <algorithm>
#include <cmath>

#include "lanes/eight_numbers.h"

namespace blem_sim::dynamics {
namespace {

/** A lane's relative twist or wrench. */
struct Six {
  Triple angular, linear;
};
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

/** Angular and linear velocities of eight bodies. */
template <typename Numbers>
struct EightBodies {
  TripleOf<Numbers> angular, linear;
};

template <typename Numbers>
BLEM_SIM_INLINE EightBodies<Numbers> gatherBodies(double* const (&from)[SWEEP_LANES]) {
  Numbers v[6];
  for (int i = 0; i < 6; ++i) gather(from, i, &v[i]);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

template <typename Numbers>
BLEM_SIM_INLINE void scatter(const EightBodies<Numbers>& v, double* const (&to)[SWEEP_LANES]) {
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
template <typename Numbers>
BLEM_SIM_INLINE void push(const BodyLanes& body, const TripleOf<Numbers>& torque, const TripleOf<Numbers>& force, EightBodies<Numbers>* v) {
  const auto part = [&body](int i) { return numbers<Numbers>(body.inverse_inertia[i]); };
  const Numbers xx = part(0), xy = part(1), yy = part(2), xz = part(3), yz = part(4), zz = part(5);
  v->angular.x += xx * torque.x + xy * torque.y + xz * torque.z;
  v->angular.y += xy * torque.x + yy * torque.y + yz * torque.z;
  v->angular.z += xz * torque.x + yz * torque.y + zz * torque.z;
  v->linear = v->linear + numbers<Numbers>(body.inverse_mass) * force;
}

/** SweepChange by lane. */
template <typename Numbers>
struct EightChanges {
  Numbers squared = {}, largest = {}, strongest = {};

  BLEM_SIM_INLINE void add(const Numbers& change, const Numbers& strength) {
    squared += change;
    largest = either(change > largest, change, largest);
    strongest = either(strength > strongest, strength, strongest);
  }
  BLEM_SIM_INLINE void put(SweepChange* out) const {
    sums(squared, &out->squared);
    out->largest = largestOf(largest);
    out->impulse = largestOf(strongest);
  }
};

/** An impulse moved on, which becomes the one before the visit. */
template <typename Numbers>
BLEM_SIM_INLINE Numbers movedOn(double lead, int axis, SweepImpulse* impulse) {
  const Numbers now = numbers<Numbers>(impulse->now[axis]), before = numbers<Numbers>(impulse->before[axis]);
  put(now, &impulse->before[axis]);
  return now + lead * (now - before);
}

/** Visits a contact of each lane, whose points have the relative velocity u. @return changes of the impulses that were moved on */
template <typename Numbers>
BLEM_SIM_INLINE TripleOf<Numbers> visit(const SweepContact& c, double lead, const TripleOf<Numbers>& u, SweepImpulse* impulse,
                                        EightChanges<Numbers>* changes) {
  const auto part = [](const SweepLanes& lanes) { return numbers<Numbers>(lanes); };
  const Numbers zero = {}, one = Numbers{} + 1.0;
  const TripleOf<Numbers> n = triples<Numbers>(c.normal), s = triples<Numbers>(c.across), t = cross(n, s);
  const Numbers g_n = movedOn<Numbers>(lead, 0, impulse), g_s = movedOn<Numbers>(lead, 1, impulse),
                g_t = movedOn<Numbers>(lead, 2, impulse);
  const Numbers miss = dot(n, u) + part(c.compliance) * g_n - part(c.target);
  const Numbers wanted = g_n - part(c.normal_gain) * miss, push = either(wanted > zero, wanted, zero), pushed = push - g_n;
  const Numbers u_s = dot(s, u) + part(c.offset[0]) + part(c.mixed[0]) * pushed;
  const Numbers u_t = dot(t, u) + part(c.offset[1]) + part(c.mixed[1]) * pushed;
  // Friction that sticks ends the slip. If that is beyond the cone it moves against the slip, and back onto the cone.
  const Numbers stick_s = g_s - (part(c.tangent_inverse[0]) * u_s + part(c.tangent_inverse[1]) * u_t);
  const Numbers stick_t = g_t - (part(c.tangent_inverse[1]) * u_s + part(c.tangent_inverse[2]) * u_t);
  const Numbers most = part(c.friction) * push;
  const Numbers slide_s = g_s - part(c.slide_gain) * u_s, slide_t = g_t - part(c.slide_gain) * u_t;
  const Numbers size = squareRoot(slide_s * slide_s + slide_t * slide_t), back = either(size > most, most / size, one);
  const auto sticks = stick_s * stick_s + stick_t * stick_t <= most * most;
  const Numbers change_s = either(sticks, stick_s, back * slide_s) - g_s, change_t = either(sticks, stick_t, back * slide_t) - g_t;
  const Numbers now_s = g_s + change_s, now_t = g_t + change_t;
  put(push, &impulse->now[0]);
  put(now_s, &impulse->now[1]);
  put(now_t, &impulse->now[2]);
  changes->add(pushed * pushed + change_s * change_s + change_t * change_t, push * push + now_s * now_s + now_t * now_t);
  return pushed * n + change_s * s + change_t * t;
}

template <typename Numbers>
BLEM_SIM_INLINE void sweepFreeAs(const SweepBodies& bodies, const SweptContacts& contacts, double* velocity, SweepChange* change) {
  SweepImpulse* impulse = contacts.impulses;
  double nothing[6] = {};
  double *of_a[SWEEP_LANES], *of_b[SWEEP_LANES];
  for (int lane = 0; lane < SWEEP_LANES; ++lane) {
    of_a[lane] = bodies.a.first[lane] < 0 ? nothing : velocity + bodies.a.first[lane];
    of_b[lane] = bodies.b.first[lane] < 0 ? nothing : velocity + bodies.b.first[lane];
  }
  EightChanges<Numbers> changes;
  EightBodies<Numbers> a = gatherBodies<Numbers>(of_a), b = gatherBodies<Numbers>(of_b);
  const TripleOf<Numbers> shift = triples<Numbers>(bodies.shift);
  for (const SweepContact* c = contacts.begin; c != contacts.end; ++c, ++impulse) {
    const TripleOf<Numbers> p_a = triples<Numbers>(c->point), p_b = p_a - shift;
    const TripleOf<Numbers> u = (a.linear + cross(a.angular, p_a)) - (b.linear + cross(b.angular, p_b));
    const TripleOf<Numbers> f = visit(*c, contacts.lead, u, impulse, &changes);
    push(bodies.a, cross(p_a, f), f, &a);
    push(bodies.b, cross(f, p_b), -f, &b);
  }
  scatter(a, of_a);
  scatter(b, of_b);
  changes.put(change);
}

BLEM_SIM_LANES void sweepFreeNarrow(const SweepBodies& bodies, const SweptContacts& contacts, double* velocity, SweepChange* change) {
  sweepFreeAs<TwoFours>(bodies, contacts, velocity, change);
}

#ifdef BLEM_SIM_AVX512
BLEM_SIM_AVX512 void sweepFreeWide(const SweepBodies& bodies, const SweptContacts& contacts, double* velocity, SweepChange* change) {
  sweepFreeAs<Eight>(bodies, contacts, velocity, change);
}
#endif

BLEM_SIM_INLINE Triple forceOf(const SweepContact& c, const SweepImpulse& impulse, int lane) {
  const Triple n = at(c.normal, lane), s = at(c.across, lane);
  return impulse.now[0][lane] * n + impulse.now[1][lane] * s + impulse.now[2][lane] * cross(n, s);
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
    contact->normal[i][lane] = axes[0][i];
    contact->across[i][lane] = axes[1][i];
    impulse->now[i][lane] = impulse->before[i][lane] = axes[i].dot(previous);
  }
  contact->friction[lane] = term ? term->friction : 0;
  contact->compliance[lane] = term ? term->compliance : 0;
  contact->target[lane] = term ? term->target : -1;
  for (int k = 0; k < 2; ++k) contact->offset[k][lane] = axes[1 + k].dot(bend);
}

BLEM_SIM_LANES void setGains(const SweepGroup& group, SweepContact* begin, SweepContact* end) {
  for (SweepContact* c = begin; c != end; ++c) {
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      const Triple p = at(c->point, lane), n = at(c->normal, lane), s = at(c->across, lane), t = cross(n, s);
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
  const Triple f = forceOf(contact, impulse, lane);
  return Vector3(f.x, f.y, f.z);
}

BLEM_SIM_LANES void wrenchOf(const SweptContacts& contacts, TwistLanes* wrench) {
  const SweepImpulse* impulse = contacts.impulses;
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < SWEEP_LANES; ++lane) (*wrench)[i][lane] = 0;
  for (const SweepContact* c = contacts.begin; c != contacts.end; ++c, ++impulse) {
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      const Triple f = forceOf(*c, *impulse, lane);
      add({cross(at(c->point, lane), f), f}, lane, wrench);
    }
  }
}

BLEM_SIM_LANES void sweep(const SweepGroup& group, const SweptContacts& contacts, const TwistLanes& start, TwistLanes* wrench,
                          SweepChange* change) {
  SweepImpulse* impulse = contacts.impulses;
  EightChanges<TwoFours> changes;
  TwistLanes twist, given_so_far = {};
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < SWEEP_LANES; ++lane) twist[i][lane] = start[i][lane];
  for (const SweepContact* c = contacts.begin; c != contacts.end; ++c, ++impulse) {
    const auto part = [&twist](int i) { return numbers<TwoFours>(twist[i]); };
    const TripleOf<TwoFours> p = triples<TwoFours>(c->point), w = {part(0), part(1), part(2)}, v = {part(3), part(4), part(5)};
    const TripleOf<TwoFours> f = visit(*c, contacts.lead, v + cross(w, p), impulse, &changes), m = cross(p, f);
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

void sweepFree(const SweepBodies& bodies, const SweptContacts& contacts, double* velocity, SweepChange* change) {
#ifdef BLEM_SIM_AVX512
  if (hasAvx512()) return sweepFreeWide(bodies, contacts, velocity, change);
#endif
  sweepFreeNarrow(bodies, contacts, velocity, change);
}

BLEM_SIM_LANES void scale(double factor, SweepImpulse* begin, SweepImpulse* end) {
  for (SweepImpulse* g = begin; g != end; ++g)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < SWEEP_LANES; ++lane) g->now[i][lane] *= factor;
}

}  // namespace blem_sim::dynamics
