#include "trust_record.h"

namespace blem_sim {

void TrustRecord::add(const sim::StepReport& report) {
  gained_ += report.energy_gained;
  if (report.energy_gained > worst_gain_) {
    worst_gain_ = report.energy_gained;
    worst_gain_time_ = report.time;
  }
  event_count_ += report.layer_events.size();
  for (const sim::LayerEventReport& event : report.layer_events)
    if (events_.size() < MOST_EVENTS) events_.push_back(event);
}

void TrustRecord::write(const sim::Simulator& simulator, JsonWriter& json) const {
  json.key("energy").openObject();
  json.key("gained_j").value(gained_);
  json.key("most_in_a_step_j").value(worst_gain_);
  json.key("most_in_a_step_time_s").value(worst_gain_time_);
  json.closeObject();
  json.key("layer_event_count").value(event_count_);
  json.key("layer_events").openList();
  for (const sim::LayerEventReport& event : events_) {
    json.openObject();
    json.key("time_s").value(event.time);
    json.key("pair").openList();
    for (const int collider : {event.collider_a, event.collider_b})
      json.value(simulator.colliders()[static_cast<std::size_t>(collider)].name);
    json.closeList();
    json.key("outside").boolean(event.outside);
    json.key("depth_m").value(event.depth);
    json.key("of_layer").value(event.of_layer);
    json.key("pierced").boolean(event.pierced);
    json.closeObject();
  }
  json.closeList();
}

}  // namespace blem_sim
