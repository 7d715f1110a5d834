// From the witness points of two features to the contact that is handed on.
#pragma once

#include <cstddef>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/roomy.h"
#include "features/mesh_pair.h"
#include "kernels/records.h"

namespace blem_sim::contact {

/** The middle of the overlap of the layers [Hauser 2013, 3.2]. @param p, q witness points @param normal from B to A */
inline Vector3 placeOf(const ContactRoles& roles, const Vector3& p, const Vector3& q, const Vector3& normal) {
  return 0.5 * (p + q) + roles.shift() * normal;
}

/** Point of A's bare mesh, or of B's, of radius r [m], at a contact. */
inline Vector3 witnessOf(const Contact& contact, double radius, bool of_a) {
  return contact.point + (of_a ? 1 : -1) * (radius - 0.5 * contact.depth) * contact.normal_BA;
}

/** Id of a contact of a feature of a side with one of the other. */
inline std::uint64_t contactId(const ContactRoles& roles, Side side, const Feature& first, const Feature& second) {
  return side == roles.a ? contactId(first, second) : contactId(second, first);
}

/** The contact in the frame of its points. */
inline Contact contactOf(const ContactRoles& roles, const FeatureContact& found) {
  Contact contact;
  contact.normal_BA = roles.normalBA(found.normal);
  contact.point = placeOf(roles, found.point_M, found.point_F, contact.normal_BA);
  contact.depth = roles.layer() - found.gap;
  contact.id = contactId(roles, Side::MOVING, found.moving, found.fixed);
  contact.pierced = found.pierced;
  return contact;
}

/** The contact in the world. */
inline void placeInWorld(const MeshPair& pair, const FeatureContact& found, Contact* out) {
  const ContactRoles& roles = pair.roles;
  const Vector3 normal_BA = roles.normalBA(found.normal);
  out->point = pair.X_WF * placeOf(roles, found.point_M, found.point_F, normal_BA);
  out->normal_BA = pair.X_WF.linear() * normal_BA;
  out->depth = roles.layer() - found.gap;
  out->id = contactId(roles, Side::MOVING, found.moving, found.fixed);
  out->weight = 1;
  out->pierced = found.pierced;
}

static_assert(offsetof(Contact, point) == offsetof(kernels::ContactNumbers, point) &&
                  offsetof(Contact, normal_BA) == offsetof(kernels::ContactNumbers, normal) &&
                  offsetof(Contact, depth) == offsetof(kernels::ContactNumbers, depth) &&
                  offsetof(Contact, id) == offsetof(kernels::ContactNumbers, id) &&
                  offsetof(Contact, weight) == offsetof(kernels::ContactNumbers, weight) &&
                  offsetof(Contact, pierced) == offsetof(kernels::ContactNumbers, pierced) &&
                  sizeof(Contact) == sizeof(kernels::ContactNumbers),
              "kernels write contacts as they are");

/** A list of contacts that is written anew, over those that it holds: none is made only to be overwritten. */
class ContactWriter {
 public:
  void overwrite(std::vector<Contact>* contacts) {
    contacts_ = contacts;
    count_ = 0;
  }
  /** Room for `more` contacts; whoever takes it writes every number. */
  Contact* room(std::size_t more) {
    if (contacts_->size() < count_ + more) geometry::resizeRoomy(count_ + more, contacts_);
    return contacts_->data() + count_;
  }
  kernels::ContactNumbers* rows(std::size_t more) { return reinterpret_cast<kernels::ContactNumbers*>(room(more)); }
  /** Counts contacts that were written. */
  void advance(std::size_t written) { count_ += written; }
  /** Drops so many of the last contacts. */
  void retreat(std::size_t dropped) { count_ -= dropped; }
  /** Cuts the list to the contacts that were written. */
  void finish() { contacts_->resize(count_); }

  std::size_t size() const { return count_; }
  const Contact* begin() const { return contacts_ ? contacts_->data() : nullptr; }
  const Contact* end() const { return begin() + count_; }

 private:
  std::vector<Contact>* contacts_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace blem_sim::contact
