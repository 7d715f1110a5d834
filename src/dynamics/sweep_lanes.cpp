#include "sweep_lanes.h"

#include <algorithm>
#include <cmath>

#include "lane_vectors.h"

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
      // What nothing can move, or moves only along one line, needs no inverse of its own.
      const bool regular = determinant > 1e-12 * largest * largest;
      const double inverse = regular ? 1 / determinant : 0, along = largest > 0 ? 1 / largest : 0;
      c->normal_gain[lane] = w_n > 0 ? 1 / w_n : 0;
      c->mixed[0][lane] = dot(s, by_n);
      c->mixed[1][lane] = dot(t, by_n);
      c->tangent[0][lane] = w11;
      c->tangent[1][lane] = w12;
      c->tangent[2][lane] = w22;
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

BLEM_SIM_LANES void sweep(const SweepGroup& group, const SweepContact* begin, const SweepContact* end, SweepImpulse* impulses,
                          const TwistLanes& start, TwistLanes* wrench, SweepChange* change) {
  // Copies of its own, so that the compiler knows that nothing else is written through them.
  Lanes squared = {}, largest = {}, strongest = {};
  TwistLanes twist, given_so_far = {};
  double response[21][LANES];
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < LANES; ++lane) twist[i][lane] = start[i][lane];
  for (int i = 0; i < 21; ++i)
    for (int lane = 0; lane < LANES; ++lane) response[i][lane] = group.response[i][lane];
  SweepImpulse* __restrict impulse = impulses;
  for (const SweepContact* __restrict c = begin; c != end; ++c, ++impulse) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple p = at(c->point, lane), n = at(c->axis[0], lane), s = at(c->axis[1], lane), t = at(c->axis[2], lane);
      const Six motion = at(twist, lane);
      const Triple u = motion.linear + cross(motion.angular, p);
      const double g_n = impulse->now[0][lane], g_s = impulse->now[1][lane], g_t = impulse->now[2][lane];
      const double miss = dot(n, u) + c->compliance[lane] * g_n - c->target[lane];
      const double wanted = g_n - c->normal_gain[lane] * miss, push = wanted > 0 ? wanted : 0, pushed = push - g_n;
      const double u_s = dot(s, u) + c->offset[0][lane] + c->mixed[0][lane] * pushed;
      const double u_t = dot(t, u) + c->offset[1][lane] + c->mixed[1][lane] * pushed;
      // Friction that sticks ends the slip. Where that is beyond the cone it is led against the slip, and back onto the cone.
      const double stick_s = g_s - (c->tangent_inverse[0][lane] * u_s + c->tangent_inverse[1][lane] * u_t);
      const double stick_t = g_t - (c->tangent_inverse[1][lane] * u_s + c->tangent_inverse[2][lane] * u_t);
      const double most = c->friction[lane] * push;
      const double slide_s = g_s - c->slide_gain[lane] * u_s, slide_t = g_t - c->slide_gain[lane] * u_t;
      const double size = __builtin_sqrt(slide_s * slide_s + slide_t * slide_t), back = size > most ? most / size : 1;
      const bool sticks = stick_s * stick_s + stick_t * stick_t <= most * most;
      const double change_s = (sticks ? stick_s : back * slide_s) - g_s, change_t = (sticks ? stick_t : back * slide_t) - g_t;
      const Triple f = pushed * n + change_s * s + change_t * t;
      const Six given = {cross(p, f), f};
      add(given, lane, &given_so_far);
      add(respond(response, lane, given), lane, &twist);
      const double now_s = g_s + change_s, now_t = g_t + change_t;
      impulse->now[0][lane] = push;
      impulse->now[1][lane] = now_s;
      impulse->now[2][lane] = now_t;
      impulse->change[0][lane] = pushed;
      impulse->change[1][lane] = change_s;
      impulse->change[2][lane] = change_t;
      const double here = pushed * pushed + change_s * change_s + change_t * change_t;
      const double strength = push * push + now_s * now_s + now_t * now_t;
      squared[lane] += here;
      largest[lane] = here > largest[lane] ? here : largest[lane];
      strongest[lane] = strength > strongest[lane] ? strength : strongest[lane];
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < LANES; ++lane) (*wrench)[i][lane] = given_so_far[i][lane];
  change->squared = sum(squared);
  change->largest = std::max({largest[0], largest[1], largest[2], largest[3]});
  change->impulse = std::max({strongest[0], strongest[1], strongest[2], strongest[3]});
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
