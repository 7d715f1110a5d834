#include "problem/contact_work.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

// Rigid contacts end with their target. Compliant ones are booked with their springs.
double lostDeparture(const ContactTerm& c, double before) { return c.compliance > 0 ? 0 : std::max(0.0, before - std::max(0.0, c.target)); }

}  // namespace

double apparentWork(const ContactTerm& c, const Vector3& before) {
  const double push = std::max(0.0, c.normal.dot(c.impulse)), departure = c.normal.dot(before);
  const Vector3 friction = c.impulse - c.normal.dot(c.impulse) * c.normal;
  return 0.5 * (push * lostDeparture(c, departure) + std::max(0.0, friction.dot(before - c.bend)));
}

}  // namespace blem_sim::dynamics
