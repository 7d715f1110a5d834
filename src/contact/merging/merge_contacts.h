#pragma once

#include <cstddef>

#include "blem_sim/contact/manifold.h"
#include "merging/id_order.h"
#include "merging/near_places.h"

namespace blem_sim::contact {

/** Makes one of contacts that say the same; room that is kept between calls. */
class ContactMerge {
 public:
  /**
   * Sorts by id; contacts of one id, and contacts at one place with one normal, become the deepest of them under their smallest id.
   * Pierced contacts are kept apart from those that are not, unless they have one id: then the pierced one stays.
   * @param merged room for as many @return number of contacts left
   */
  std::size_t run(const Contact* contacts, std::size_t count, Contact* merged);

 private:
  IdOrder by_id_;
  NearPlaces places_;  // of the contacts that each of the merged ones began with
};

}  // namespace blem_sim::contact
