#include "lanes/contact_lanes.h"

#include <algorithm>
#include <cmath>

#include "lanes/lane_vectors.h"

namespace blem_sim::dynamics {
namespace {

constexpr double NO_FRICTION = 1e-9;   // of the push: below, the direction of friction is made of rounding errors
constexpr double STICKING = 1 - 1e-9;  // of friction's bound: friction that was remembered below it had stuck

/** Slope and curvature of a contact's potential along its step. */
struct LaneSlope {
  double first, second;
};

// Nearest point to normal * y_n + y_t in the cone |g_t| <= mu g_n, measured by w_n (g_n - y_n)^2 + w_t |g_t - y_t|^2, with
// w_n = compliance + rho, w_t = rho, w y = rho previous - (u - target of u) at the velocity u.
BLEM_SIM_INLINE LaneSlope respondLane(ContactBlock& b, int lane, const Triple& u, const Triple& step) {
  const Triple normal = at(b.normal, lane), y = b.rho[lane] * at(b.previous, lane) - u;
  const double mu = b.friction[lane], along = dot(normal, y), weighed = along + b.target[lane] - mu * b.slip[lane];
  const double y_n = weighed * b.inverse_normal[lane];
  const Triple y_t = b.inverse_rho[lane] * (y - along * normal);
  const double size = __builtin_sqrt(dot(y_t, y_t)), ridge = weighed + mu * b.rho[lane] * size;
  const bool sticks = size < mu * y_n, opens = !sticks && ridge <= 0;
  const double push = ridge * b.inverse_ridge[lane], inverse = size > 0 ? 1 / size : 0;
  const Triple direction = inverse * y_t, axis = either(sticks, normal, normal + mu * direction), side = cross(normal, direction);
  const Triple acting = either(sticks, y_n * normal + y_t, push * axis), impulse = either(opens, {0, 0, 0}, acting);
  const double normal_gain = opens ? 0 : sticks ? b.inverse_normal[lane] : b.inverse_ridge[lane];
  const double tangent_gain = opens ? 0 : sticks ? b.inverse_rho[lane] : mu * push * inverse * b.inverse_rho[lane];
  b.kind[lane] = opens ? ContactBlock::OPEN : sticks ? ContactBlock::STICK : ContactBlock::SLIP;
  b.normal_gain[lane] = normal_gain;
  b.tangent_gain[lane] = tangent_gain;
  put(impulse, lane, &b.impulse);
  put(axis, lane, &b.axis);
  put(side, lane, &b.side);
  const double on_axis = dot(axis, step), on_side = dot(side, step), squared = on_axis * on_axis;
  const double across = sticks ? dot(step, step) - squared : on_side * on_side;
  return {-dot(impulse, step), normal_gain * squared + tangent_gain * across};
}

double largestRoot(const Lanes& squares) { return std::sqrt(std::max({squares[0], squares[1], squares[2], squares[3]})); }

}  // namespace

void setLane(const ContactTerm* term, int lane, ContactBlock* b) {
  static const ContactTerm NEVER = [] {
    ContactTerm never;
    never.point = never.normal = Vector3::Zero();
    never.inverse_mass = 1;
    never.target = -1;  // and without friction: with it, points faster than that would be held
    return never;
  }();
  const ContactTerm& t = term ? *term : NEVER;
  for (int i = 0; i < 3; ++i) {
    b->point[i][lane] = t.point[i];
    b->normal[i][lane] = t.normal[i];
    b->previous[i][lane] = t.previous[i];
    b->step[i][lane] = b->impulse[i][lane] = 0;
    b->velocity[i][lane] = t.bend[i];
  }
  b->friction[lane] = t.friction;
  b->compliance[lane] = t.compliance;
  b->inverse_mass[lane] = t.inverse_mass;
  b->target[lane] = t.target;
  b->slip[lane] = t.slip;
}

void readLane(const ContactBlock& b, int lane, ContactTerm* term) {
  for (int i = 0; i < 3; ++i) {
    term->velocity[i] = b.velocity[i][lane];
    term->impulse[i] = b.impulse[i][lane];
  }
}

void soften(const ContactTerm* terms, int count, double softness, ContactBlock* b) {
  for (int lane = 0; lane < LANES; ++lane) {
    const double rho = b->rho[lane] = lane < count ? softness * terms[lane].stiffest_rho : 1;
    const double normal = b->compliance[lane] + rho;
    b->inverse_rho[lane] = 1 / rho;
    b->inverse_normal[lane] = 1 / normal;
    b->inverse_ridge[lane] = 1 / (normal + b->friction[lane] * b->friction[lane] * rho);
  }
}

BLEM_SIM_LANES void expect(ContactBlock* begin, ContactBlock* end) {
  for (ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple normal = at(b->normal, lane), previous = at(b->previous, lane), u = at(b->velocity, lane);
      const double push = dot(normal, previous);
      const Triple held = previous - push * normal;
      const double size = __builtin_sqrt(dot(held, held)), slip = b->slip[lane];
      // A slipping contact is on its cone, where De Saxce's term just undoes the slip's share. A sticking one creeps on as it did.
      const bool slipped = size >= STICKING * b->friction[lane] * push;
      const double u_n = b->target[lane] - (slipped ? 0 : b->friction[lane] * slip) - b->compliance[lane] * push;
      const double rubbed = NO_FRICTION * (push > 0 ? push : 0);
      const Triple past = u_n * normal - (size > rubbed ? slip / size : 0) * held, change = u - past;
      respondLane(*b, lane, past, {0, 0, 0});
      const bool acts = push > 0, sticks = b->kind[lane] == ContactBlock::STICK;
      const double n = acts ? b->normal_gain[lane] : 0, t = acts ? b->tangent_gain[lane] : 0;
      const Triple axis = at(b->axis, lane), side = at(b->side, lane);
      const Triple stuck = ((n - t) * dot(axis, change)) * axis + t * change;
      const Triple slid = (n * dot(axis, change)) * axis + (t * dot(side, change)) * side;
      const Triple impulse = at(b->impulse, lane) - either(sticks, stuck, slid);
      b->kind[lane] = acts ? b->kind[lane] : ContactBlock::OPEN;
      b->normal_gain[lane] = n;
      b->tangent_gain[lane] = t;
      put(either(acts, impulse, {0, 0, 0}), lane, &b->impulse);
    }
  }
}

BLEM_SIM_LANES PotentialSlope respond(double a, ContactBlock* begin, ContactBlock* end) {
  Lanes first = {}, second = {};
  for (ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple step = at(b->step, lane);
      const LaneSlope slope = respondLane(*b, lane, at(b->velocity, lane) + a * step, step);
      first[lane] += slope.first;
      second[lane] += slope.second;
    }
  }
  return {sum(first), sum(second)};
}

BLEM_SIM_LANES Vector6 wrenchOf(const ContactBlock* begin, const ContactBlock* end) {
  VectorLanes torque = {}, force = {};
  for (const ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple g = at(b->impulse, lane);
      put(at(torque, lane) + cross(at(b->point, lane), g), lane, &torque);
      put(at(force, lane) + g, lane, &force);
    }
  }
  Vector6 out;
  for (int i = 0; i < 3; ++i) {
    out[i] = sum(torque[i]);
    out[3 + i] = sum(force[i]);
  }
  return out;
}

BLEM_SIM_LANES bool stiffnessOf(const ContactBlock* begin, const ContactBlock* end, Matrix6* out) {
  // Columns of the symmetric linear part, of point x linear, and of the symmetric angular part.
  VectorLanes linear[3] = {}, mixed[3] = {}, angular[3] = {};
  Lanes acting = {};
  for (const ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const bool sticks = b->kind[lane] == ContactBlock::STICK;
      const double n = b->normal_gain[lane], t = b->tangent_gain[lane];
      const double on_axis = sticks ? n - t : n, on_side = sticks ? 0 : t, everywhere = sticks ? t : 0;
      const Triple axis = at(b->axis, lane), side = at(b->side, lane), p = at(b->point, lane);
      acting[lane] += n;
      const Triple k0 = (on_axis * axis.x) * axis + (on_side * side.x) * side + Triple{everywhere, 0, 0};
      const Triple k1 = (on_axis * axis.y) * axis + (on_side * side.y) * side + Triple{0, everywhere, 0};
      const Triple k2 = (on_axis * axis.z) * axis + (on_side * side.z) * side + Triple{0, 0, everywhere};
      const Triple m0 = cross(p, k0), m1 = cross(p, k1), m2 = cross(p, k2);
      put(at(linear[0], lane) + k0, lane, &linear[0]);
      put(at(linear[1], lane) + k1, lane, &linear[1]);
      put(at(linear[2], lane) + k2, lane, &linear[2]);
      put(at(mixed[0], lane) + m0, lane, &mixed[0]);
      put(at(mixed[1], lane) + m1, lane, &mixed[1]);
      put(at(mixed[2], lane) + m2, lane, &mixed[2]);
      put(at(angular[0], lane) + cross(p, {m0.x, m1.x, m2.x}), lane, &angular[0]);
      put(at(angular[1], lane) + cross(p, {m0.y, m1.y, m2.y}), lane, &angular[1]);
      put(at(angular[2], lane) + cross(p, {m0.z, m1.z, m2.z}), lane, &angular[2]);
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      const int low = std::min(r, c), high = std::max(r, c);
      (*out)(r, c) = sum(angular[low][high]);
      (*out)(3 + r, 3 + c) = sum(linear[low][high]);
      (*out)(r, 3 + c) = (*out)(3 + c, r) = sum(mixed[c][r]);
    }
  }
  return sum(acting) > 0;
}

BLEM_SIM_LANES void setSteps(const Vector6& twist, ContactBlock* begin, ContactBlock* end) {
  const Triple spin = {twist[0], twist[1], twist[2]}, v = {twist[3], twist[4], twist[5]};
  for (ContactBlock* b = begin; b != end; ++b)
    for (int lane = 0; lane < LANES; ++lane) put(v + cross(spin, at(b->point, lane)), lane, &b->step);
}

BLEM_SIM_LANES void take(double a, ContactBlock* begin, ContactBlock* end) {
  for (ContactBlock* b = begin; b != end; ++b)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < LANES; ++lane) b->velocity[i][lane] += a * b->step[i][lane];
}

BLEM_SIM_LANES void startSlips(ContactBlock* begin, ContactBlock* end) {
  for (ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple normal = at(b->normal, lane), u = at(b->velocity, lane), g = at(b->previous, lane);
      const double along = dot(normal, u);
      const Triple u_t = u - along * normal;
      const bool open = along >= b->target[lane] && !(dot(g, g) > 0);
      b->slip[lane] = open ? __builtin_sqrt(dot(u_t, u_t)) : b->slip[lane];
    }
  }
}

BLEM_SIM_LANES void remember(ContactBlock* begin, ContactBlock* end) {
  for (ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple normal = at(b->normal, lane), u = at(b->velocity, lane), u_t = u - dot(normal, u) * normal;
      b->slip[lane] = __builtin_sqrt(dot(u_t, u_t));
      put(at(b->impulse, lane), lane, &b->previous);
    }
  }
}

BLEM_SIM_LANES ContactResidual residual(const ContactBlock* begin, const ContactBlock* end) {
  Lanes worst = {}, worst_speed = {};
  for (const ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple normal = at(b->normal, lane), u = at(b->velocity, lane), g = at(b->impulse, lane);
      const double mu = b->friction[lane], along = dot(normal, u), g_n = dot(normal, g);
      const Triple u_t = u - along * normal;
      const double u_n = along - b->target[lane] + b->compliance[lane] * g_n + mu * __builtin_sqrt(dot(u_t, u_t));
      const double inverse = 1 / (b->inverse_mass[lane] + b->compliance[lane]), y_n = g_n - inverse * u_n;
      const Triple y_t = g - g_n * normal - inverse * u_t;
      const double size = __builtin_sqrt(dot(y_t, y_t)), push = (y_n + mu * size) / (1 + mu * mu);
      const bool sticks = size < mu * y_n, opens = !sticks && push <= 0;
      const Triple ridge = normal + (size > 0 ? mu / size : 0) * y_t;
      const Triple lawful = either(opens, {0, 0, 0}, either(sticks, y_n * normal + y_t, push * ridge)), miss = lawful - g;
      const double squared = dot(miss, miss);
      const double speed = b->inverse_mass[lane] * b->inverse_mass[lane] * squared;
      worst[lane] = squared > worst[lane] ? squared : worst[lane];
      worst_speed[lane] = speed > worst_speed[lane] ? speed : worst_speed[lane];
    }
  }
  return {largestRoot(worst), largestRoot(worst_speed)};
}

BLEM_SIM_LANES double fastest(const ContactBlock* begin, const ContactBlock* end) {
  Lanes worst = {};
  for (const ContactBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const Triple u = at(b->velocity, lane);
      const double squared = dot(u, u);
      worst[lane] = squared > worst[lane] ? squared : worst[lane];
    }
  }
  return largestRoot(worst);
}

}  // namespace blem_sim::dynamics
