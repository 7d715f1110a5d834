// Search for contacts that lie close to another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim::contact {

/** Places of contacts by the slab of space that they lie in: few share one, since it is thin and no mesh lies along it. Room is kept
 * between calls. */
class NearPlaces {
 public:
  /** Starts with none of these contacts added. @param contacts stay where they are */
  void begin(const Contact* contacts, std::size_t count);

  /**
   * Calls visit(number, place) for every place that was added within MERGE_DISTANCE of this contact's, and others, until it returns true;
   * adds this one, as the next number, if it never does. @return whether visit returned true
   */
  template <typename Visit>
  bool visitOrAdd(std::uint32_t index, Visit&& visit) {
    const Slots slots = slots_[index];
    const std::uint32_t own = last_[slots.own], beside = last_[slots.beside];
    if ((own | beside) != NONE && (visitBackFrom(own, visit) || (slots.beside != slots.own && visitBackFrom(beside, visit)))) return true;
    added_[count_] = {index, own};
    last_[slots.own] = ++count_;
    return false;
  }

 private:
  static constexpr std::uint32_t NONE = 0;
  /** Slots of a contact's slab, and of the one beside it if that is within reach. */
  struct Slots {
    std::uint32_t own, beside;
  };
  struct Added {
    std::uint32_t contact;
    std::uint32_t before;  ///< the one before in its slot, counted from 1
  };

  template <typename Visit>
  bool visitBackFrom(std::uint32_t last, Visit&& visit) const {
    for (std::uint32_t i = last; i != NONE; i = added_[i - 1].before)
      if (visit(i - 1, contacts_[added_[i - 1].contact].point)) return true;
    return false;
  }

  const Contact* contacts_ = nullptr;
  std::vector<Slots> slots_;         // per contact
  std::vector<std::uint32_t> last_;  // added to each slot, counted from 1
  std::vector<Added> added_;
  std::uint32_t count_ = 0;  // number of those added
};

}  // namespace blem_sim::contact
