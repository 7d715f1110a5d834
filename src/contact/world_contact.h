// From the witness points of two features to the contact that is handed on.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "kernels/records.h"
#include "mesh_pair.h"

namespace blem_sim {

/** Its place is the middle of the overlap of the layers [Hauser 2013, 3.2]; in the frame of the points. @param normal from second to first
 */
inline Contact contactOf(const ContactRoles& roles, const Feature& first, const Feature& second, const Vector3& point_first,
                         const Vector3& point_second, const Vector3& normal, double gap) {
  Contact contact;
  contact.normal_BA = roles.first_is_a ? normal : Vector3(-normal);
  contact.point = 0.5 * (point_first + point_second) + 0.5 * (roles.r_b - roles.r_a) * contact.normal_BA;
  contact.depth = roles.r_a + roles.r_b - gap;
  contact.id = roles.first_is_a ? contactId(first, second) : contactId(second, first);
  return contact;
}

/** What kernels wrote. */
inline void appendContacts(const kernels::ContactRow* rows, std::uint32_t count, std::vector<Contact>* out) {
  for (const kernels::ContactRow* row = rows; row != rows + count; ++row) {
    Contact& contact = out->emplace_back();
    contact.point = Vector3(row->point[0], row->point[1], row->point[2]);
    contact.normal_BA = Vector3(row->normal[0], row->normal[1], row->normal[2]);
    contact.depth = row->depth;
    contact.id = row->id;
  }
}

/** A contact of a pair in the world. */
inline Contact worldContact(const MeshPair& pair, const FeatureContact& c) {
  Contact contact = contactOf(pair.roles, c.moving, c.fixed, c.point_M, c.point_F, c.normal, c.gap);
  contact.point = pair.X_WF * contact.point;
  contact.normal_BA = pair.X_WF.linear() * contact.normal_BA;
  contact.pierced = c.pierced;
  return contact;
}

}  // namespace blem_sim
