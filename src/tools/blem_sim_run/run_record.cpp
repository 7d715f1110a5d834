#include "run_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "blem_sim/sim/sensor_values.h"

namespace blem_sim {

namespace {

const double MILLISECONDS = 1e3;

void writeDistribution(JsonWriter& json, const Distribution& distribution) {
  json.openObject();
  json.key("mean").value(distribution.mean());
  json.key("p50").value(distribution.quantile(0.5));
  json.key("p99").value(distribution.quantile(0.99));
  json.key("max").value(distribution.maximum());
  json.closeObject();
}

}  // namespace

RunRecord::RunRecord(const sim::Simulator& simulator, double stats_from)
    : simulator_(simulator), stats_from_(stats_from), status_steps_(std::size(sim::STEP_STATUS)), sensors_(simulator.sensors().size()) {}

void RunRecord::add(const sim::StepReport& report) {
  ++steps_;
  for (std::size_t bit = 0; bit < status_steps_.size(); ++bit) status_steps_[bit] += (report.status >> bit) & 1u;
  for (std::size_t stage = 0; stage < stages_.size(); ++stage) stages_[stage].add(MILLISECONDS * report.profile.seconds[stage]);
  step_.add(MILLISECONDS * std::accumulate(report.profile.seconds.begin(), report.profile.seconds.end(), 0.0));
  raw_contacts_ += static_cast<std::uint64_t>(report.raw_contacts);
  reduced_contacts_ += static_cast<std::uint64_t>(report.reduced_contacts);
  most_reduced_contacts_ = std::max(most_reduced_contacts_, report.reduced_contacts);
  wrench_error_ = std::max(wrench_error_, report.wrench_error);
  addDepth(report);
  trust_.add(report);
  if (report.time <= stats_from_) return;
  for (const sim::SensorSample& sample : report.samples)
    sensors_[static_cast<std::size_t>(sample.sensor)].add(sim::sensorValues(sample.reading).values);
}

void RunRecord::stop(const std::string& name) {
  stopped_ = name;
  stop_time_ = simulator_.time();
}

void RunRecord::addDepth(const sim::StepReport& report) {
  const bool deeper =
      report.max_of_layer > deepest_.of_layer || (report.max_of_layer == deepest_.of_layer && report.max_depth > deepest_.depth);
  if (!deeper) return;
  deepest_ = {report.max_depth, report.max_of_layer, report.time, report.deepest_a, report.deepest_b};
  // The deepest contact need not be the one that used most of its layer.
  for (const sim::ContactReport& contact : report.contacts) {
    if (contact.of_layer != report.max_of_layer) continue;
    deepest_ = {contact.depth, contact.of_layer, report.time, contact.collider_a, contact.collider_b};
    return;
  }
}

void RunRecord::write(const RunFacts& facts, JsonWriter& json) const {
  const double simulated = static_cast<double>(steps_) * simulator_.config().time_step;
  json.openObject();
  if (!facts.name.empty()) json.key("name").value(facts.name);
  json.key("simulated_s").value(simulated);
  json.key("steps").value(steps_);
  json.key("cpu_s").value(facts.times.cpu);
  json.key("wall_s").value(facts.times.wall);
  json.key("real_time_factor").value(facts.times.wall > 0 ? simulated / facts.times.wall : 0);
  json.key("state_hash").value(fmt::format("{:016x}", simulator_.stateHash()));
  if (!stopped_.empty()) {
    json.key("stopped").openObject();
    json.key("name").value(stopped_);
    json.key("time_s").value(stop_time_);
    json.closeObject();
  }
  if (!interrupted_.empty()) json.key("interrupted").value(interrupted_);
  writeStatus(json);
  writeProfile(json);
  writeContacts(json);
  writeBodies(json);
  writeJoints(json);
  writeSensors(json);
  json.key("energy_J").value(simulator_.report().energy);
  trust_.write(simulator_, json);
  writeLoadReport(json);
  json.key("notes").value(facts.notes);
  json.closeObject();
}

void RunRecord::writeStatus(JsonWriter& json) const {
  json.key("status").openObject();
  for (std::size_t bit = 0; bit < status_steps_.size(); ++bit) json.key(sim::STEP_STATUS[bit].name).value(status_steps_[bit]);
  json.closeObject();
}

void RunRecord::writeProfile(JsonWriter& json) const {
  json.key("profile_ms").openObject();
  for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
    json.key(sim::STAGE_NAMES[stage]);
    writeDistribution(json, stages_[stage]);
  }
  json.key("step");
  writeDistribution(json, step_);
  json.closeObject();
}

void RunRecord::writeContacts(JsonWriter& json) const {
  const double steps = std::max<double>(1, static_cast<double>(steps_));
  json.key("contacts").openObject();
  json.key("raw_mean").value(static_cast<double>(raw_contacts_) / steps);
  json.key("reduced_mean").value(static_cast<double>(reduced_contacts_) / steps);
  json.key("reduced_max").value(most_reduced_contacts_);
  json.key("wrench_error_max").value(wrench_error_);
  json.closeObject();
  json.key("max_penetration").openObject();
  json.key("depth_m").value(deepest_.depth);
  json.key("of_layer").value(deepest_.of_layer);
  json.key("pair").openList();
  for (const int collider : {deepest_.collider_a, deepest_.collider_b})
    if (collider >= 0) json.value(simulator_.colliders()[static_cast<std::size_t>(collider)].name);
  json.closeList();
  json.key("time_s").value(deepest_.time);
  json.closeObject();
}

void RunRecord::writeBodies(JsonWriter& json) const {
  const sim::StepReport& report = simulator_.report();
  json.key("bodies").openObject();
  for (const sim::ModelInfo& model : simulator_.models()) {
    if (!model.alive) continue;
    for (const int body : model.bodies) {
      if (body == dynamics::WORLD_BODY) continue;
      const dynamics::BodyState& state = report.bodies[static_cast<std::size_t>(body)];
      const Vector3 com_from_origin = state.X_WB.linear() * simulator_.world().bodySpec(body).inertial.com;
      json.key(simulator_.bodyName(body)).openObject();
      json.key("xyz").value(Vector3(state.X_WB.translation()));
      json.key("quat_xyzw").value(Quaternion(state.X_WB.linear()));
      // Velocity of the frame's origin, whose position is xyz; the state holds that of the centre of mass.
      json.key("linear_velocity").value(Vector3(state.v_WCom - state.w_WB.cross(com_from_origin)));
      json.key("angular_velocity").value(state.w_WB);
      json.closeObject();
    }
  }
  json.closeObject();
}

void RunRecord::writeJoints(JsonWriter& json) const {
  const sim::StepReport& report = simulator_.report();
  json.key("joints").openObject();
  for (const sim::RobotInfo& robot : simulator_.robots()) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const dynamics::JointState& state = report.joints[static_cast<std::size_t>(robot.joints[j])];
      json.key(robot.name + "::" + robot.joint_names[j]).openObject();
      json.key("position").value(state.position);
      json.key("velocity").value(state.velocity);
      json.key("effort").value(state.effort);
      json.closeObject();
    }
  }
  json.closeObject();
}

void RunRecord::writeSensors(JsonWriter& json) const {
  const std::vector<std::string> names = sim::sensorNames(simulator_);
  json.key("sensors").openObject();
  for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
    const VectorStatistics& statistics = sensors_[sensor];
    json.key(names[sensor]).openObject();
    json.key("fields").value(sim::sensorFields(simulator_, simulator_.sensors()[sensor]));
    json.key("samples").value(statistics.count());
    json.key("mean").value(statistics.mean());
    json.key("std").value(statistics.standardDeviation());
    json.key("min").value(statistics.minimum());
    json.key("max").value(statistics.maximum());
    json.closeObject();
  }
  json.closeObject();
}

void RunRecord::writeLoadReport(JsonWriter& json) const {
  json.key("load").openList();
  for (const geometry::MeshReport& mesh : simulator_.loadReport()) {
    json.openObject();
    json.key("name").value(mesh.name);
    json.key("source").value(mesh.source);
    json.key("triangles").value(mesh.triangles);
    json.key("points").value(mesh.points);
    json.key("bytes").value(static_cast<std::uint64_t>(mesh.bytes));
    json.key("degenerate").value(mesh.degenerate);
    json.key("duplicate").value(mesh.duplicate);
    json.key("nonfinite").value(mesh.nonfinite);
    json.key("invalid").value(mesh.invalid);
    json.key("open_edges").value(mesh.open_edges);
    json.key("boundary_width").value(mesh.boundary_width);
    json.key("notes").value(mesh.notes);
    json.closeObject();
  }
  json.closeList();
}

}  // namespace blem_sim
