#include "gazebo/gazebo_values.h"

#include <fmt/format.h>

#include "gazebo/gazebo_reader.h"

namespace blem_sim::sim {
namespace {

constexpr double RIGID_FROM = 1e6;     // [N/m] from here on, as URDF's limits are none from 1e6 on
constexpr double GAZEBOS_DAMPING = 1;  // [N s/m] of a surface whose <kd> is left out

std::optional<bool> either(GazeboReader* reader, const char* path, const char* other_path) {
  std::optional<bool> value;
  reader->read(path, &value);
  reader->read(other_path, &value);
  return value;
}

void readFriction(GazeboReader* reader, ContactOverrides* surface) {
  std::optional<double> other;
  reader->read("mu1", &surface->friction, NumberRange::notNegative());
  reader->read("mu2", &other, NumberRange::notNegative());
  if (!other) return;
  if (!surface->friction) surface->friction = other;
  if (*surface->friction != *other) reader->notes().anisotropic(reader->block().reference);
}

void readStiffness(GazeboReader* reader, ContactOverrides* surface) {
  std::optional<double> stiffness, damping;
  reader->read("kp", &stiffness, NumberRange::positive());
  reader->read("kd", &damping, NumberRange::notNegative());
  if (!stiffness) return;
  const bool rigid = *stiffness >= RIGID_FROM;
  surface->stiffness = rigid ? contact::SurfaceProperties().stiffness : *stiffness;
  surface->damping = rigid ? contact::SurfaceProperties().damping : damping.value_or(GAZEBOS_DAMPING);
}

/** Takes what is given over what an earlier block said. */
void replace(const ContactOverrides& given, ContactOverrides* surface) {
  if (given.friction) surface->friction = given.friction;
  if (given.stiffness) surface->stiffness = given.stiffness;
  if (given.damping) surface->damping = given.damping;
}

void readLink(GazeboReader* reader, RobotConfig* config) {
  const std::string& link = reader->block().reference;
  ContactOverrides surface;
  readFriction(reader, &surface);
  readStiffness(reader, &surface);
  replace(surface, &config->described_links[link]);
  if (either(reader, "selfCollide", "self_collide").value_or(false)) config->self_colliding_links.insert(link);
  std::optional<bool> gravity;
  reader->read("gravity", &gravity);
  if (either(reader, "turnGravityOff", "turn_gravity_off").value_or(!gravity.value_or(true))) config->weightless_links.insert(link);
  reader->skip({"material", "visual", "laserRetro", "laser_retro"});
  reader->skipWithoutEffect({"minDepth", "min_depth", "maxVel", "max_vel", "maxContacts", "max_contacts"});
}

void readJoint(GazeboReader* reader) {
  reader->skip({"disableFixedJointLumping", "preserveFixedJoint"});
  reader->skipWithoutEffect(
      {"provideFeedback", "provide_feedback", "implicitSpringDamper", "cfmDamping", "stopErp", "stop_erp", "stopCfm", "stop_cfm"});
  reader->skipZeros({"springStiffness", "springReference", "stopKd", "stopKp"});
}

void readRobotValues(GazeboReader* reader, RobotConfig* config) {
  const std::optional<bool> self_collision = either(reader, "selfCollide", "self_collide");
  if (!config->self_collision && self_collision.value_or(false)) config->self_collision = true;
  std::optional<bool> is_static;
  reader->read("static", &is_static);
  if (is_static.value_or(false) && !config->fixed_base)
    reader->fault("static", "a robot is fixed by its root link; it is left out: set fixed_base, or name the root link world and spawn it");
}

}  // namespace

void readGazeboValues(const model::GazeboBlock& block, const model::RobotModel& model, GazeboNotes* notes, RobotConfig* config) {
  GazeboReader reader(block, notes);
  if (block.reference.empty()) {
    readRobotValues(&reader, config);
  } else if (model.linkIndex(block.reference) >= 0) {
    readLink(&reader, config);
  } else if (model.jointIndex(block.reference) >= 0) {
    readJoint(&reader);
  } else {
    notes->fault(fmt::format("<gazebo reference=\"{}\">", block.reference),
                 "there is no such link or joint; it is left out: correct the name");
    return;
  }
  reader.finish();
}

}  // namespace blem_sim::sim
