#include "lanes/joint_lanes.h"

#include <algorithm>

namespace blem_sim::dynamics {

void setLane(const JointTerm* term, int lane, JointBlock* b) {
  const JointTerm t = term ? *term : JointTerm();
  b->dof[lane] = t.dof;
  b->motor_gain[lane] = t.motor_gain;
  b->motor_velocity[lane] = t.motor_velocity;
  b->motor_bound[lane] = t.motor_bound;
  b->velocity_gain[lane] = t.velocity_gain;
  b->min_velocity[lane] = t.min_velocity;
  b->max_velocity[lane] = t.max_velocity;
  b->viscous[lane] = t.viscous;
  b->dry_gain[lane] = t.dry_gain / t.softness;
  b->dry_previous[lane] = t.dry_previous;
  b->dry_bound[lane] = t.dry_bound;
  b->limit_gain[lane] = t.limit_gain / t.softness;
  b->lower_velocity[lane] = t.lower_velocity;
  b->lower_previous[lane] = t.lower_previous;
  b->upper_velocity[lane] = t.upper_velocity;
  b->upper_previous[lane] = t.upper_previous;
}

void expect(const JointTerm* term, int lane, JointBlock* b) {
  const JointResponse response = term ? term->expect(b->velocity[lane]) : JointResponse();
  b->impulse[lane] = response.impulse;
  b->stiffness[lane] = response.stiffness;
}

BLEM_SIM_LANES void respond(double a, JointBlock* begin, JointBlock* end, double* first, double* second) {
  Lanes slope = {}, curvature = {};
  for (JointBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const double d = b->step[lane], v = b->velocity[lane] + a * d;
      const double law = b->motor_gain[lane] * (b->motor_velocity[lane] - v), motor_bound = b->motor_bound[lane];
      const double to_max = b->velocity_gain[lane] * (b->max_velocity[lane] - v);
      const double to_min = b->velocity_gain[lane] * (b->min_velocity[lane] - v);
      const bool too_fast = law > to_max, too_slow = law < to_min;
      const double motor = too_fast ? to_max : too_slow ? to_min : law;
      const double motor_gain = too_fast || too_slow ? b->velocity_gain[lane] : b->motor_gain[lane];
      const double dry = b->dry_previous[lane] - b->dry_gain[lane] * v, dry_bound = b->dry_bound[lane];
      const double limit = b->limit_gain[lane];
      const double lower = b->lower_previous[lane] + limit * (b->lower_velocity[lane] - v);
      const double upper = b->upper_previous[lane] + limit * (v - b->upper_velocity[lane]);
      const bool drives = motor > -motor_bound && motor<motor_bound, holds = dry> - dry_bound && dry < dry_bound;
      const double motor_most = motor > 0 ? motor_bound : -motor_bound, dry_most = dry > 0 ? dry_bound : -dry_bound;
      const double motor_stiffness = drives ? motor_gain : 0, dry_stiffness = holds ? b->dry_gain[lane] : 0;
      const double lower_stiffness = lower > 0 ? limit : 0, upper_stiffness = upper > 0 ? limit : 0;
      const double lower_impulse = lower > 0 ? lower : 0, upper_impulse = upper > 0 ? upper : 0;
      const double impulse =
          (drives ? motor : motor_most) + (holds ? dry : dry_most) + (lower_impulse - upper_impulse) - b->viscous[lane] * v;
      const double stiffness = b->viscous[lane] + motor_stiffness + dry_stiffness + (lower_stiffness + upper_stiffness);
      b->impulse[lane] = impulse;
      b->stiffness[lane] = stiffness;
      slope[lane] -= impulse * d;
      curvature[lane] += stiffness * d * d;
    }
  }
  *first += sum(slope);
  *second += sum(curvature);
}

BLEM_SIM_LANES double creep(const JointBlock* begin, const JointBlock* end) {
  Lanes worst = {};
  for (const JointBlock* b = begin; b != end; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const double v = b->velocity[lane], limit = b->limit_gain[lane], bound = b->dry_bound[lane];
      const double dry = b->dry_previous[lane] - b->dry_gain[lane] * v;
      const double below = b->lower_velocity[lane] - v, above = v - b->upper_velocity[lane];
      const double stuck = dry > -bound && dry < bound ? v : 0;
      const double low = b->lower_previous[lane] + limit * below > 0 ? below : 0;
      const double high = b->upper_previous[lane] + limit * above > 0 ? above : 0;
      const auto larger = [&](double x) {
        const double size = x < 0 ? -x : x;
        worst[lane] = size > worst[lane] ? size : worst[lane];
      };
      larger(stuck);
      larger(low);
      larger(high);
    }
  }
  return std::max({worst[0], worst[1], worst[2], worst[3]});
}

}  // namespace blem_sim::dynamics
