// Memory of the articulated stepper from one step to the next: reactions, as forces, so that a step of another length can use them.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "lanes/spatial.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {

struct ContactRecord {
  std::uint64_t id = 0;
  Vector3 force = Vector3::Zero();  ///< [N] on A, world axes
  double slip = 0;                  ///< [m/s]
};

inline void turnOver(ContactRecord* record) { record->force = -record->force; }

/** [N m or N] */
struct JointRecord {
  double dry = 0, lower = 0, upper = 0;
  double dry_change = 0;           ///< of dry friction that stuck, in the last step
  Vector6 loop = Vector6::Zero();  ///< of a joint that closes a loop: along its forbidden directions
};

struct StepMemory {
  std::vector<ContactRecord> contacts;  ///< sorted by id; index() after they were changed
  std::vector<JointRecord> joints;      ///< one per joint slot

  /** Record of a contact; null if there was no such contact in the last step. */
  const ContactRecord* find(std::uint64_t id) const;
  void index();
  /** A record per joint slot; that of a slot with another joint than before is empty. */
  void resize(const Scene& scene);
  /** @param ids ascending @param go_on as World::forgetContacts has it */
  void forgetContacts(const std::vector<std::uint64_t>& ids, const ContactRenames& go_on);
  void save(const Scene& scene, geometry::StateWriter* writer) const;
  void restore(const Scene& scene, geometry::StateReader* reader);

 private:
  bool knows(const Scene& scene, std::size_t joint) const;

  std::vector<std::uint64_t> occupants_;  // JointSlot::occupant that a record is of
  int shift_ = 63;                        // bits of an id below those that choose its bucket
  std::vector<int> first_;                // per bucket, as many as there are records or up to four times so: its first record
};

}  // namespace blem_sim::dynamics
