#include "blem_sim/sim/drawing.h"

#include <algorithm>
#include <iterator>

namespace blem_sim::sim {

namespace {

const Colour LOW{0.20F, 0.38F, 0.70F}, MIDDLE{0.42F, 0.74F, 0.58F}, HIGH{0.97F, 0.82F, 0.35F};

/** @param height 0 to 1 of the range; beyond, the colour of the end */
Colour heightColour(double height) {
  const double h = std::clamp(height, 0.0, 1.0);
  return h < 0.5 ? mixed(LOW, MIDDLE, 2 * h) : mixed(MIDDLE, HIGH, 2 * h - 1);
}

/** The value that a share of all others is below. */
double quantile(std::vector<double>* values, double share) {
  const auto place = values->begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values->size() - 1));
  std::nth_element(values->begin(), place, values->end());
  return *place;
}

}  // namespace

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

Vector3 upwards(const Vector3& gravity) { return gravity.norm() > 0 ? Vector3(-gravity.normalized()) : Vector3::UnitZ(); }

Colour mixed(const Colour& a, const Colour& b, double share) {
  const auto s = static_cast<float>(share);
  return {a.r + s * (b.r - a.r), a.g + s * (b.g - a.g), a.b + s * (b.b - a.b)};
}

std::vector<Colour> coloursByHeight(const std::vector<Vector3>& points, const Vector3& up) {
  std::vector<Colour> colours;
  if (points.empty()) return colours;
  std::vector<double> heights;
  heights.reserve(points.size());
  for (const Vector3& point : points) heights.push_back(up.dot(point));
  std::vector<double> ranked = heights;
  const double low = quantile(&ranked, 0.05), range = std::max(1e-9, quantile(&ranked, 0.95) - low);
  colours.reserve(points.size());
  for (const double height : heights) colours.push_back(heightColour((height - low) / range));
  return colours;
}

Vector3 forceOnMovingSide(const ContactReport& contact) {
  return contact.body_a == dynamics::WORLD_BODY ? Vector3(-contact.force) : contact.force;
}

double movingWeight(const Simulator& simulator) {
  double mass = 0;
  for (const ModelInfo& model : simulator.models()) {
    for (const int body : model.bodies) {
      if (body != dynamics::WORLD_BODY) mass += simulator.world().bodySpec(body).inertial.mass;
    }
  }
  return mass * std::max(1.0, simulator.gravity().norm());
}

}  // namespace blem_sim::sim
