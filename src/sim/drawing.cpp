#include "blem_sim/sim/drawing.h"

#include <algorithm>
#include <iterator>

namespace blem_sim {

Colour contactColour(const ContactReport& contact) {
  if (contact.pierced || contact.of_layer > 1) return {1.0F, 0.0F, 0.1F};
  return {static_cast<float>(0.9 * std::clamp(contact.of_layer, 0.0, 1.0)), 0.8F, 0.1F};
}

Colour modelColour(ModelKind kind, int model) {
  // Pale stone, sand, clay, slate for environments, since rviz lights from the camera and floors are seen askew.
  static const Colour ENVIRONMENTS[] = {{0.95F, 0.94F, 0.90F}, {0.98F, 0.90F, 0.75F}, {0.95F, 0.80F, 0.72F}, {0.78F, 0.86F, 0.95F}};
  static const Colour OBJECTS[] = {
      {0.95F, 0.50F, 0.22F}, {0.30F, 0.62F, 0.90F}, {0.95F, 0.80F, 0.28F}, {0.50F, 0.80F, 0.45F}, {0.75F, 0.52F, 0.85F}};
  static const Colour ROBOT = {0.62F, 0.67F, 0.75F};
  const auto turn = static_cast<std::size_t>(model);
  if (kind == ModelKind::ROBOT) return ROBOT;
  return kind == ModelKind::ENVIRONMENT ? ENVIRONMENTS[turn % std::size(ENVIRONMENTS)] : OBJECTS[turn % std::size(OBJECTS)];
}

Vector3 forceOnMovingSide(const ContactReport& contact) { return contact.body_a == WORLD_BODY ? Vector3(-contact.force) : contact.force; }

double movingWeight(const Simulator& simulator) {
  double mass = 0;
  for (const ModelInfo& model : simulator.models()) {
    for (const int body : model.bodies) {
      if (body != WORLD_BODY) mass += simulator.world().bodySpec(body).inertial.mass;
    }
  }
  return mass * std::max(1.0, simulator.gravity().norm());
}

}  // namespace blem_sim
