#include "part_reports.h"

#include <algorithm>

namespace blem_sim::sim {

void PartReports::startStep(std::size_t joints) {
  contacts_.clear();
  ids_.clear();
  added_.clear();
  wrenches_.assign(joints, Wrench());
  efforts_.assign(joints, 0);
}

void PartReports::startPart(double fraction) {
  fraction_ = fraction;
  known_.clear();
  for (std::size_t i = 0; i < ids_.size(); ++i) known_.push_back({ids_[i], i});
  std::sort(known_.begin(), known_.end());
  for (std::size_t i = added_.size(); i < contacts_.size(); ++i) {
    const ContactReport& first = contacts_[i];
    const double impulse = first.force.norm();
    added_.push_back({impulse, impulse, first.point, Vector3::Zero(), first.moment_a, first.moment_b});
  }
}

void PartReports::addContact(std::uint64_t id, const ContactReport& contact) {
  const auto known = std::lower_bound(known_.begin(), known_.end(), Known{id, 0});
  if (known != known_.end() && known->id == id) return join(contact, &added_[known->index], &contacts_[known->index]);
  contacts_.push_back(contact);
  ContactReport& whole = contacts_.back();
  for (Vector3* mean : {&whole.force, &whole.moment_a, &whole.moment_b}) *mean *= fraction_;
  ids_.push_back(id);
}

void PartReports::join(const ContactReport& contact, Added* added, ContactReport* whole) const {
  const Vector3 force = fraction_ * contact.force;
  whole->force += force;
  whole->depth = std::max(whole->depth, contact.depth);
  whole->of_layer = std::max(whole->of_layer, contact.of_layer);
  whole->pierced = whole->pierced || contact.pierced;
  const double impulse = force.norm();
  if (!(impulse > 0)) return;
  added->impulses += impulse;
  whole->point += impulse / added->impulses * (contact.point - whole->point);
  if (impulse > added->largest) whole->normal_BA = contact.normal_BA;
  added->largest = std::max(added->largest, impulse);
  added->torque += (contact.point - added->start).cross(force);
  added->moment_a += fraction_ * contact.moment_a;
  added->moment_b += fraction_ * contact.moment_b;
  const Vector3 missed = added->torque - (whole->point - added->start).cross(whole->force);
  whole->moment_a = added->moment_a + missed;
  whole->moment_b = added->moment_b - missed;
}

void PartReports::addJoints(const std::vector<Wrench>& wrenches, const std::vector<double>& efforts) {
  for (std::size_t j = 0; j < wrenches_.size(); ++j) {
    wrenches_[j].force += fraction_ * wrenches[j].force;
    wrenches_[j].torque += fraction_ * wrenches[j].torque;
    efforts_[j] += fraction_ * efforts[j];
  }
}

}  // namespace blem_sim::sim
