#include "state/state_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "numbers/content_hash.h"

namespace blem_sim::sim {
namespace {

/** Hash of a geometry's content, worked out once for all colliders that share it. */
class GeometryHashes {
 public:
  std::uint64_t of(const contact::CollisionGeometry& geometry) {
    const auto [known, is_new] = hashes_.try_emplace(&geometry, 0);
    if (is_new) known->second = hashOf(geometry);
    return known->second;
  }

 private:
  static std::uint64_t hashOf(const contact::CollisionGeometry& geometry) {
    ContentHash hash;
    if (geometry.isHalfSpace()) return hash.add(geometry.planeNormal()).add(geometry.planeOffset()).value();
    return hash.add(geometry.mesh().vertices).add(geometry.mesh().elements).value();
  }

  std::map<const contact::CollisionGeometry*, std::uint64_t> hashes_;
};

class LayoutWriter {
 public:
  /** Adds the line of a thing's property: body 'cube::link': mass. */
  void line(const std::string& thing, const std::string& name, const std::string& property, const ContentHash& content) {
    line(fmt::format("{} '{}': {}", thing, inOneLine(name), property), ContentHash(content).add(name));
  }
  void line(const std::string& what, const ContentHash& content) { lines_ += fmt::format("{}\t{:016x}\n", what, content.value()); }
  std::string take() { return std::move(lines_); }

 private:
  static std::string inOneLine(std::string name) {
    for (char& c : name)
      if (static_cast<unsigned char>(c) < ' ') c = '?';
    return name;
  }

  std::string lines_;
};

void writeSettings(const SimulationConfig& config, LayoutWriter* writer) {
  const dynamics::SolverSettings& s = config.solver;
  ContentHash solver;
  solver.add(s.stepper).add(s.quick_step_iterations).add(s.cfm).add(s.correction_fraction).add(s.max_correction_speed);
  writer->line("time_step", ContentHash().add(config.time_step));
  writer->line("solver settings", solver.add(s.joint_erp).add(s.joint_cfm));
  writer->line("contact settings", ContentHash().add(static_cast<int>(config.contact.friction_rule)).add(config.contact.reduction));
}

void writeModels(const SimulatedWorld& world, LayoutWriter* writer) {
  for (std::size_t i = 0; i < world.models.size(); ++i) {
    const ModelInfo& model = world.models[i];
    if (!model.alive) continue;
    const bool self_collides = world.filter.selfCollides(static_cast<int>(i));
    ContentHash hash;
    hash.add(static_cast<int>(model.kind)).add(world.budgets[i].max_contacts).add(self_collides);
    for (const int link : world.filter.selfCollidingLinks(static_cast<int>(i))) hash.add(link);
    for (const WeightlessPart& part : model.weightless) hash.add(part.body).add(part.link);
    writer->line("model", model.name, "kind or settings", hash.add(model.bodies).add(model.joints));
  }
}

void writeBodies(const dynamics::World& world, LayoutWriter* writer) {
  for (int body = 0; body < world.bodyCount(); ++body) {
    if (!world.hasBody(body)) continue;
    const dynamics::BodySpec& spec = world.bodySpec(body);
    writer->line("body", spec.name, "mass", ContentHash().add(spec.inertial.mass));
    writer->line("body", spec.name, "centre of mass or inertia", ContentHash().add(spec.inertial.com).add(spec.inertial.inertia));
  }
}

ContentHash hashOf(const dynamics::JointSpec& spec) {
  ContentHash hash;
  hash.add(static_cast<int>(spec.kind)).add(spec.parent).add(spec.child).add(spec.X_PJ).add(spec.axis);
  hash.add(spec.lower).add(spec.upper).add(spec.mimic_joint).add(spec.mimic_multiplier).add(spec.mimic_offset);
  return hash;
}

ContentHash hashOf(const JointGains& gains) { return ContentHash().add(gains.p).add(gains.i).add(gains.d).add(gains.i_clamp); }

ContentHash hashOf(const MotorSettings& motor) {
  ContentHash hash;
  hash.add(static_cast<int>(motor.law)).add(motor.friction.dry).add(motor.friction.viscous);
  hash.add(motor.effort_limit).add(motor.velocity_limit).add(motor.command_timeout);
  const model::SafetyController safety = motor.safety.value_or(model::SafetyController());
  hash.add(safety.lower).add(safety.upper).add(safety.k_position).add(safety.k_velocity);
  return hash.add(motor.continuous).add(motor.commanded);
}

void writeJoints(const SimulatedWorld& world, LayoutWriter* writer) {
  for (int joint = 0; joint < world.world.jointCount(); ++joint) {
    if (!world.world.hasJoint(joint)) continue;
    const dynamics::JointSpec& spec = world.world.jointSpec(joint);
    const MotorSettings& motor = world.motors[joint].settings();
    writer->line("joint", spec.name, "kind, place or limits", hashOf(spec));
    writer->line("joint", spec.name, "armature", ContentHash().add(spec.armature));
    writer->line("joint", spec.name, "gains", hashOf(motor.gains));
    writer->line("joint", spec.name, "motor or friction", hashOf(motor));
  }
}

void writeColliders(const SimulatedWorld& world, LayoutWriter* writer) {
  GeometryHashes geometries;
  for (std::size_t i = 0; i < world.colliders.size(); ++i) {
    const contact::Collider& c = world.colliders[i];
    if (!c.enabled) continue;
    const std::string thing = fmt::format("collider {}", i);
    const auto line = [&](const char* property, const ContentHash& hash) { writer->line(thing, c.name, property, hash); };
    line("mesh", ContentHash().add(geometries.of(*c.geometry)));
    line("place", ContentHash().add(c.body).add(c.model).add(c.link).add(c.X_BC));
    ContentHash surface;
    surface.add(c.radius).add(c.surface.friction).add(c.surface.restitution).add(c.surface.impact_friction_factor);
    line("layer or surface", surface.add(c.surface.impact_friction_speed).add(c.surface.stiffness).add(c.surface.damping));
  }
  ContentHash pairs;
  for (const auto& [a, b] : world.disabled_pairs) pairs.add(a).add(b);
  writer->line("colliders that never touch", pairs);
}

std::uint64_t raysHash(const RangeSensorConfig& rays) {
  ContentHash hash;
  hash.add(rays.nearest).add(rays.farthest).add(static_cast<int>(rays.noise)).add(rays.stddev).add(rays.width).add(rays.height);
  hash.add(rays.hfov).add(rays.beams).add(rays.layers).add(rays.first_angle).add(rays.last_angle);
  return hash.add(rays.lowest_angle).add(rays.highest_angle).value();
}

void writeAttachments(const SimulatedWorld& world, LayoutWriter* writer) {
  for (const AttachedModel& weld : world.attachments)
    writer->line("attachment", weld.object, "limits", ContentHash().add(weld.max_force).add(weld.max_torque));
}

void writeSensors(const SimulatedWorld& world, LayoutWriter* writer) {
  for (const SensorInfo& sensor : world.sensors) {
    const SensorConfig& c = sensor.config;
    ContentHash hash;
    hash.add(sensor.robot).add(static_cast<int>(c.type)).add(c.joint).add(c.frame).add(c.measure).add(c.link).add(c.X_LS).add(c.rate);
    for (const QuantityNoise& noise : c.noise) hash.add(noise.stddev).add(noise.bias_stddev).add(noise.bias).add(noise.bias_spread);
    for (const auto& [joint, constant] : c.torque_constant) hash.add(joint).add(constant);
    if (c.delay > 0 || c.limits[0].any() || c.limits[1].any())
      for (const QuantityLimits& limits : c.limits) hash.add(c.delay).add(limits.saturation).add(limits.resolution);
    hash.add(c.threshold);
    if (c.type == SensorType::ODOMETRY) hash.add(c.twist).add(c.X_offset);
    if (isRangeSensor(c.type)) hash.add(raysHash(c.rays));
    writer->line("sensor", c.name, "kind or settings", hash);
  }
}

using Lines = std::vector<std::pair<std::string, std::string>>;

/** Name of a thing's property and its hash, line by line. */
Lines linesOf(const std::string& layout) {
  Lines lines;
  for (std::size_t from = 0; from < layout.size();) {
    const std::size_t end = std::min(layout.find('\n', from), layout.size()), tab = std::min(layout.find('\t', from), end);
    lines.emplace_back(layout.substr(from, tab - from), layout.substr(tab, end - tab));
    from = end + 1;
  }
  return lines;
}

bool has(const Lines& lines, const std::string& what) {
  return std::any_of(lines.begin(), lines.end(), [&](const auto& line) { return line.first == what; });
}

/** In words, the first difference between two layouts that are not the same. */
std::string differenceOf(const Lines& saved, const Lines& here) {
  const auto [s, h] = std::mismatch(saved.begin(), saved.end(), here.begin(), here.end());
  const bool saved_ends = s == saved.end(), here_ends = h == here.end();
  if (!saved_ends && !here_ends && s->first == h->first) return s->first + " is not the same";
  if (!saved_ends && !has(here, s->first)) return s->first + " is not here";
  if (!here_ends && !has(saved, h->first)) return h->first + " was not there";
  return (saved_ends ? h->first : s->first) + " is at another place";
}

}  // namespace

std::string layoutOf(const SimulationConfig& config, const SimulatedWorld& world) {
  LayoutWriter writer;
  writeSettings(config, &writer);
  writeModels(world, &writer);
  writeBodies(world.world, &writer);
  writeJoints(world, &writer);
  writeColliders(world, &writer);
  writeAttachments(world, &writer);
  writeSensors(world, &writer);
  return writer.take();
}

void checkLayout(const std::string& saved, const std::string& here) {
  if (saved == here) return;
  throw InputError("restore: the state belongs to other models or settings: " + differenceOf(linesOf(saved), linesOf(here)) +
                   "; restore it where the same are loaded");
}

}  // namespace blem_sim::sim
