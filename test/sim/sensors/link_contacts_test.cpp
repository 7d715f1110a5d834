// Contacts by link: each link's own, in order, whichever side it is on.
#include "sensors/types/link_contacts.h"

#include <gtest/gtest.h>

namespace blem_sim::sim {
namespace {

constexpr int MODELS = 40, LINKS = 25, CONTACTS = 5000;

/** A collider per link of every model, and contacts between any two of them. */
struct ManyLinks {
  ManyLinks() : world(Vector3::Zero(), dynamics::SolverSettings()) {
    for (int model = 0; model < MODELS; ++model) {
      for (int link = 0; link < LINKS; ++link) {
        contact::Collider collider;
        collider.model = model;
        collider.link = link;
        world.colliders.push_back(collider);
      }
    }
    for (int i = 0; i < CONTACTS; ++i) {
      ContactReport contact;
      contact.point = contact.normal_BA = Vector3::Zero();
      contact.collider_a = 7 * i % (MODELS * LINKS);
      contact.collider_b = (11 * i + 1) % (MODELS * LINKS);
      contacts.push_back(contact);
    }
  }
  SimulatedWorld world;
  std::vector<ContactReport> contacts;
};

TEST(LinkContacts, AreThoseThatASearchOfAllWouldFind) {
  const ManyLinks scene;
  LinkContacts found;
  found.index(scene.world, scene.contacts);
  int count = 0;
  for (int collider = 0; collider < MODELS * LINKS; ++collider) {
    std::vector<std::pair<int, bool>> expected, entries;
    for (int i = 0; i < CONTACTS; ++i) {
      const bool on_a = scene.contacts[i].collider_a == collider;
      if (on_a || scene.contacts[i].collider_b == collider) expected.emplace_back(i, on_a);
    }
    for (const LinkContacts::Entry& entry : found.of(collider / LINKS, collider % LINKS)) entries.emplace_back(entry.contact, entry.on_a);
    EXPECT_EQ(entries, expected) << collider;
    count += static_cast<int>(entries.size());
  }
  EXPECT_GT(count, 2 * CONTACTS - CONTACTS / 10);
}

TEST(LinkContacts, ForgetsTheLastStep) {
  const ManyLinks scene;
  LinkContacts found;
  found.index(scene.world, scene.contacts);
  found.index(scene.world, {});
  EXPECT_EQ(found.of(0, 0).begin(), found.of(0, 0).end());
}

}  // namespace
}  // namespace blem_sim::sim
