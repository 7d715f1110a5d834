#include "blem_sim/dynamics/world.h"
#include "blem_sim/reduction/reduction.h"
#include "config/config_sections.h"

namespace blem_sim::sim {
namespace {

std::optional<BoundaryWidth> readWidth(YamlReader* reader) {
  const YAML::Node node = reader->node("boundary_width");
  if (node.IsDefined() && node.IsScalar() && node.Scalar() == "auto") return BoundaryWidth::chosen();
  NumberRange range = NumberRange::notNegative();
  range.words = "a finite number of at least 0, or auto";
  std::optional<double> metres;
  reader->read("boundary_width", &metres, range);
  if (!metres) return std::nullopt;
  return BoundaryWidth(*metres);
}

std::optional<int> readThreads(YamlReader* reader) {
  const YAML::Node node = reader->node("threads");
  std::optional<int> number;
  if (!node.IsDefined() || (node.IsScalar() && node.Scalar() == "auto")) return number;
  reader->read("threads", &number, 1, "a whole number of at least 1, or auto");
  return number;
}

}  // namespace

ContactConfig readContact(YamlReader reader) {
  ContactConfig contact;
  contact.boundary_width = readWidth(&reader).value_or(contact.boundary_width);
  reader.read("shrink", &contact.shrink);
  reader.read("friction", &contact.surface.friction, NumberRange::notNegative());
  reader.read("restitution", &contact.surface.restitution, NumberRange::fraction());
  reader.read("impact_friction_factor", &contact.surface.impact_friction_factor, NumberRange::fraction());
  reader.read("impact_friction_speed", &contact.surface.impact_friction_speed, NumberRange::notNegative());
  reader.read("stiffness", &contact.surface.stiffness, NumberRange::positiveOrInfinite());
  reader.read("damping", &contact.surface.damping, NumberRange::notNegativeOrInfinite());
  reader.read("max_contacts_per_robot", &contact.max_contacts_per_robot, 1);
  reader.read("max_contacts_per_object", &contact.max_contacts_per_object, 1);
  const std::vector<contact::FrictionRule> rules = {contact::FrictionRule::MIN, contact::FrictionRule::HARMONIC_MEAN,
                                                    contact::FrictionRule::MEAN, contact::FrictionRule::PRODUCT};
  if (const auto rule = reader.choice("friction_rule", {"min", "harmonic_mean", "mean", "product"})) contact.friction_rule = rules[*rule];
  bool mend = true;
  reader.read("mend_meshes", &mend);
  contact.mending = mend ? model::Mending::ON : model::Mending::OFF;
  std::vector<std::string> reductions;
  for (const reduction::Reduction& reduction : reduction::reductionTable()) reductions.push_back(reduction.name);
  if (const auto reduction = reader.choice("reduction", reductions)) contact.reduction = reductions[*reduction];
  reader.finish();
  return contact;
}

dynamics::SolverSettings readSolver(YamlReader reader) {
  dynamics::SolverSettings solver;
  const std::vector<std::string> steppers = dynamics::stepperNames();
  if (const auto stepper = reader.choice("stepper", steppers)) solver.stepper = steppers[*stepper];
  solver.threads = readThreads(&reader);
  reader.read("quick_step_iterations", &solver.quick_step_iterations, 1);
  reader.read("cfm", &solver.cfm, NumberRange::notNegative());
  reader.read("correction_fraction", &solver.correction_fraction, NumberRange::fraction());
  reader.read("max_correction_speed", &solver.max_correction_speed, NumberRange::notNegative());
  reader.read("joint_erp", &solver.joint_erp, NumberRange::fraction());
  reader.read("joint_cfm", &solver.joint_cfm, NumberRange::notNegative());
  reader.finish();
  return solver;
}

ContactOverrides readContactOverrides(YamlReader& reader) {
  ContactOverrides contact;
  contact.boundary_width = readWidth(&reader);
  reader.read("shrink", &contact.shrink);
  reader.read("friction", &contact.friction, NumberRange::notNegative());
  reader.read("restitution", &contact.restitution, NumberRange::fraction());
  reader.read("impact_friction_factor", &contact.impact_friction_factor, NumberRange::fraction());
  reader.read("impact_friction_speed", &contact.impact_friction_speed, NumberRange::notNegative());
  reader.read("stiffness", &contact.stiffness, NumberRange::positiveOrInfinite());
  reader.read("damping", &contact.damping, NumberRange::notNegativeOrInfinite());
  return contact;
}

}  // namespace blem_sim::sim
