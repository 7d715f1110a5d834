// Contacts, joint wrenches and efforts of a step, out of those of the parts it was made in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/sim/step_report.h"

namespace blem_sim::sim {

/**
 * Means over a step: forces, wrenches and efforts count by the length of their parts, so times the length of the step they are impulses. Of
 * a step of one part they are the part's own, bit for bit. Warm steps allocate nothing.
 */
class PartReports {
 public:
  /** Forgets the last step. @param joints number of joints */
  void startStep(std::size_t joints);
  /** Call before an accepted part's contacts and joints. @param fraction of the step that the part takes, above 0; those of a step sum up
   * to 1 */
  void startPart(double fraction);
  /**
   * A contact of the part. Contacts of one id are one contact of the step: depth, of_layer and pierced are the worst of its parts; the
   * point is their mean, weighted with the impulses; the normal is that of the part of the largest impulse, the earlier of equals; the
   * moments make up for the torque that the mean point misses. Without any impulse, point and normal are those of the first of its parts.
   * @param id as in ContactConstraint, unique in the part
   */
  void addContact(std::uint64_t id, const ContactReport& contact);
  /** Adds the wrenches of all joints and the efforts of their motors in the part. */
  void addJoints(const std::vector<Wrench>& wrenches, const std::vector<double>& efforts);

  const std::vector<ContactReport>& contacts() const { return contacts_; }  ///< of the step so far, in the order they were first added
  /** Swaps contacts() out; the vector swapped in is only memory for the next step. */
  void takeContacts(std::vector<ContactReport>* contacts) { contacts_.swap(*contacts); }
  void clearContacts() { contacts_.clear(); }
  const std::vector<Wrench>& jointWrenches() const { return wrenches_; }  ///< as SolveResult has them
  const std::vector<double>& efforts() const { return efforts_; }         ///< [N m or N] of motors

 private:
  /** Sums of the contact of the same index, once the part it was first added in is over. */
  struct Added {
    double impulses, largest;    // sum of their sizes, and largest of them, over the length of the step [N]
    Vector3 start;               // [m] point of the first part
    Vector3 torque;              // [N m] on A about `start`
    Vector3 moment_a, moment_b;  // [N m] means of those of the parts
  };
  struct Known {
    std::uint64_t id;
    std::size_t index;
    bool operator<(const Known& other) const { return id < other.id; }
  };
  void join(const ContactReport& contact, Added* added, ContactReport* whole) const;

  double fraction_ = 1;
  std::vector<ContactReport> contacts_;
  std::vector<std::uint64_t> ids_;  // of contacts_
  std::vector<Added> added_;
  std::vector<Known> known_;  // contacts of earlier parts, sorted
  std::vector<Wrench> wrenches_;
  std::vector<double> efforts_;
};

}  // namespace blem_sim::sim
