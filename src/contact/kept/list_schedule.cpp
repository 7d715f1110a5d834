#include "kept/list_schedule.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::contact {

double ListSchedule::partOf(const Pose& X_FM) {
  constexpr double GRAIN = 1e-7;  // [m]
  const double grains = X_FM.translation().sum() / GRAIN;
  return LEAST_PART + (1 - LEAST_PART) * (grains - std::floor(grains));
}

double ListSchedule::cheapestSteps(const ListFigures& now) {
  if (now.motion <= 0) return MOST_STEPS;
  const double nearby = now.candidates - now.growth * now.margin;
  const double anyway = LEAF_PAIR_COST * now.leaf_pairs + CANDIDATE_COST * std::max(nearby, 0.0);
  const double margin = std::sqrt(0.5 * anyway * now.motion * CHOICE_STEPS / now.growth);
  return std::clamp(margin / now.motion, FEWEST_STEPS, MOST_STEPS);
}

ListMargin ListSchedule::contactMargin(const ListFigures& now, double part) {
  if (!now.known) return {FIRST_MARGIN * now.range, FIRST_TURN};
  const bool grows = now.growth > 0 && !areMany(now);
  const double most = grows ? MOST_KNOWN_MARGIN * now.range : mostMargin(now);
  // Turning is allowed for as long as moving.
  double steps = (grows ? cheapestSteps(now) : MARGIN_STEPS) * part;
  if (steps * now.motion > most) steps = most / now.motion;
  return {std::max(steps * now.motion, LEAST_MARGIN * now.range), std::max(steps * now.turn, LEAST_TURN)};
}

double ListSchedule::crossingSteps(const ListFigures& now) {
  return CROSSING_STEPS * now.motion > mostMargin(now) ? mostMargin(now) / now.motion : CROSSING_STEPS;
}

double ListSchedule::stepsAhead(double margin, const ListFigures& now) {
  return now.motion > 0 ? std::min(AHEAD * margin / now.motion, AHEAD_STEPS) : 0;
}

double ListSchedule::nearestSteps(const ListFigures& now) {
  const double all = now.candidates, more_per_step = now.growth * now.motion;
  if (more_per_step <= 0) return NEAREST_STEPS;
  const double worth = MOST_NEAREST_PART * now.margin / now.motion;
  const double most = std::clamp(worth, FEWEST_NEAREST_STEPS, MOST_NEAREST_STEPS);
  return std::clamp(std::sqrt(0.5 * all / more_per_step), FEWEST_NEAREST_STEPS, most);
}

ListMargin ListSchedule::nearestMargin(const ListFigures& now) {
  const double steps = nearestSteps(now);
  return {std::clamp(steps * now.motion, LEAST_NEAREST_MARGIN * now.range, MOST_MARGIN * now.range),
          std::max(steps * now.turn, LEAST_NEAREST_TURN)};
}

double ListSchedule::growth(std::size_t near, double margin, const ListFigures& now) {
  const double more = static_cast<double>(now.candidates - near);
  return std::max(more, 1.0) / (now.margin - margin);
}

}  // namespace blem_sim::contact
