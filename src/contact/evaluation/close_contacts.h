// Contacts that may share a place or a name with others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "evaluation/world_contact.h"

namespace blem_sim::contact {

/** Contacts, placed in the world at once; where meshes cross, kept with their witness points, since retraction asks for those. */
class CloseContacts {
 public:
  void begin(bool keeps_witnesses) {
    keeps_witnesses_ = keeps_witnesses;
    witnessed_.clear();
    placed_.overwrite(&room_);
  }

  void add(const MeshPair& pair, const FeatureContact& contact) {
    if (keeps_witnesses_) return witnessed_.push_back(contact);
    placeInWorld(pair, contact, placed_.room(1));
    placed_.advance(1);
  }

  // Contacts that are in the world already, where no witnesses are kept: room for so many more, and the number that was written there.
  kernels::ContactNumbers* rows(std::size_t more) { return placed_.rows(more); }
  void advance(std::size_t written) { placed_.advance(written); }

  bool keepsWitnesses() const { return keeps_witnesses_; }

  /** Keeps those of the last `count` contacts for which is_kept(index among them) holds. */
  template <typename IsKept>
  void keepOfLast(std::size_t count, IsKept&& is_kept) {
    if (keeps_witnesses_) {
      witnessed_.resize(witnessed_.size() - count + moveForward(witnessed_.data() + witnessed_.size() - count, count, is_kept));
    } else {
      placed_.retreat(count);
      placed_.advance(moveForward(placed_.room(0), count, is_kept));
    }
  }

  /** Least distance [m] of the meshes at a contact; infinity if there is none. @param layer [m] rA + rB */
  double leastGap(double layer) const {
    double least = std::numeric_limits<double>::infinity();
    for (const FeatureContact& c : witnessed_) least = std::min(least, c.gap);
    for (const Contact& c : placed_) least = std::min(least, layer - c.depth);
    return least;
  }

  /** The contacts that were kept with their witness points; more may be added. */
  std::vector<FeatureContact>& witnessed() { return witnessed_; }
  /** All contacts, in the world. */
  const ContactWriter& placed(const MeshPair& pair) {
    for (const FeatureContact& c : witnessed_) {
      placeInWorld(pair, c, placed_.room(1));
      placed_.advance(1);
    }
    witnessed_.clear();
    return placed_;
  }

 private:
  template <typename Item, typename IsKept>
  static std::size_t moveForward(Item* items, std::size_t count, IsKept&& is_kept) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (is_kept(i)) items[kept++] = items[i];
    return kept;
  }

  bool keeps_witnesses_ = false;
  std::vector<FeatureContact> witnessed_;
  ContactWriter placed_;
  std::vector<Contact> room_;
};

}  // namespace blem_sim::contact
