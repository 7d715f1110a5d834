// The contacts of two meshes that do not move.
#pragma once

#include <cstdint>

#include "blem_sim/contact/manifold.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {

/** Contacts of a pair from search to search, for as long as it is the same to the last bit. Pierced ones are not kept: they depend on more
 *  than the pair. */
class StillPair {
 public:
  /** Whether the pair is the one that was asked for last. If not, contacts of that one are forgotten. */
  bool isSame(const MeshPair& pair);
  bool hasContacts() const { return known_; }
  /** @param out its contacts are overwritten */
  void recall(ContactManifold* out) const;
  void keep(const ContactManifold& found);

 private:
  std::uint64_t moving_ = 0, fixed_ = 0;  // identities of the geometries
  Pose X_FM_, X_WF_;
  double range_ = 0;
  ContactRoles roles_;
  bool known_ = false;
  std::vector<Contact> contacts_;
};

}  // namespace blem_sim::contact
