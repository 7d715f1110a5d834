#include "newton/island_faults.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr double RESIDUAL_IS_TROUBLE = 0.01;  // of the largest impulse

double largestImpulse(const std::vector<ContactTerm>& contacts) {
  double largest = 0;
  for (const ContactTerm& c : contacts) largest = std::max(largest, c.impulse.squaredNorm());
  return std::sqrt(largest);
}

}  // namespace

double faults(const NewtonReport& report, const std::vector<ContactTerm>& contacts) {
  const double contact = report.contact_residual > 0 ? report.contact_residual / (RESIDUAL_IS_TROUBLE * largestImpulse(contacts)) : 0;
  const double worst = std::max({report.imbalance / BALANCED, report.joint_creep / CREEP_IS_TROUBLE, contact});
  return std::isfinite(report.imbalance + report.joint_creep + report.contact_residual) ? worst : INFINITY;
}

double faultsWithCreep(const NewtonReport& report, const std::vector<ContactTerm>& contacts) {
  return std::max(faults(report, contacts), report.contact_creep / CREEP_IS_TROUBLE);
}

}  // namespace blem_sim::dynamics
