#include "messages/contact_messages.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

std::string describe(const ContactState& state, double max_of_layer) {
  char text[160];
  std::snprintf(text, sizeof(text), " in %zu points, deepest %.3g of the boundary layers%s", state.depths.size(), max_of_layer,
                max_of_layer > 1 ? ": the bare meshes cross, not to be trusted" : "");
  return state.collision1_name + " touches " + state.collision2_name + text;
}

}  // namespace

ContactArray toContactArray(const sim::Simulator& simulator, const sim::StepReport& report) {
  const std::vector<contact::Collider>& colliders = simulator.colliders();
  ContactArray array;
  array.header.stamp = toStamp(report.time);
  array.header.frame_id = WORLD_FRAME;
  array.contacts.reserve(report.contacts.size());
  for (const sim::ContactReport& contact : report.contacts) {
    ContactPoint point;
    point.body_a = colliders[contact.collider_a].name;
    point.body_b = colliders[contact.collider_b].name;
    point.position = toPoint(contact.point);
    point.normal = toVector3(contact.normal_BA);
    point.depth = contact.depth;
    point.of_layer = contact.of_layer;
    point.within_layer = !contact.pierced && contact.of_layer <= 1;
    point.force = toVector3(contact.force);
    array.contacts.push_back(point);
  }
  return array;
}

ContactsState toContactsState(const sim::Simulator& simulator, const sim::StepReport& report, const sim::ContactReading& reading) {
  const std::vector<contact::Collider>& colliders = simulator.colliders();
  struct Pair {
    ContactState state;
    Wrench total;
    double max_of_layer = 0;
  };
  std::map<std::pair<int, int>, Pair> pairs;  // (own collider, other collider)
  for (std::size_t i = 0; i < reading.contacts.size(); ++i) {
    const sim::ContactReport& contact = report.contacts[reading.contacts[i]];
    const Wrench& wrench = reading.wrenches[i];
    const bool own_is_a = contact.body_a == reading.link_body;
    const double side = own_is_a ? 1 : -1;  // the report's normal is that of A
    Pair& pair =
        pairs[own_is_a ? std::make_pair(contact.collider_a, contact.collider_b) : std::make_pair(contact.collider_b, contact.collider_a)];
    pair.state.wrenches.push_back(toWrench(wrench.force, wrench.torque));
    pair.state.contact_positions.push_back(toVector3(contact.point));
    pair.state.contact_normals.push_back(toVector3(side * contact.normal_BA));
    pair.state.depths.push_back(contact.depth);
    pair.total.force += wrench.force;
    pair.total.torque += wrench.torque;
    pair.max_of_layer = std::max(pair.max_of_layer, contact.of_layer);
  }
  ContactsState message;
  message.header.stamp = toStamp(report.time);
  message.header.frame_id = WORLD_FRAME;
  for (auto& [key, pair] : pairs) {
    pair.state.collision1_name = colliders[key.first].name;
    pair.state.collision2_name = colliders[key.second].name;
    pair.state.total_wrench = toWrench(pair.total.force, pair.total.torque);
    pair.state.info = describe(pair.state, pair.max_of_layer);
    message.states.push_back(pair.state);
  }
  return message;
}

}  // namespace blem_sim::node
