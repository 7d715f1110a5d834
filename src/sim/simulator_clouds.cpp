// Live environments: clouds that are exchanged between steps.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "build/contact_settings.h"
#include "clouds/inner_points.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

constexpr double TOUCH = 1e-5;          // [m] largest gap of a point that something stands on
constexpr std::size_t MOST_LEFT = 200;  // points of a pair without a choice of the last step

/** Points that fade by vertex, one each: of two bodies the deeper one's. */
std::vector<SunkPoint> byVertex(std::vector<SunkPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const SunkPoint& a, const SunkPoint& b) { return std::make_tuple(a.vertex, -a.sink) < std::make_tuple(b.vertex, -b.sink); });
  points.erase(std::unique(points.begin(), points.end(), [](const SunkPoint& a, const SunkPoint& b) { return a.vertex == b.vertex; }),
               points.end());
  return points;
}

}  // namespace

void Simulator::Impl::addLive(const EnvironmentConfig& environment) {
  if (environment.live.topic.empty()) return;
  const ContactSettings settings = contactSettings(BoundaryWidth(), config_.contact, {&environment.contact});
  live_[environment.name] = {settings.surface, environment.live.fade_speed, -1};
}

/** Adds the points of one collider of a pair that the other one stands on: those that the last step chose, if it chose some. */
void Simulator::Impl::addStoodOn(const contact::ContactManifold& manifold, bool is_a, std::vector<LeavingPoint>* points) const {
  const int index = is_a ? manifold.a : manifold.b;
  const contact::Collider& collider = world_.colliders[index];
  const reduction::ContactIds& chosen = constraint_maker_.memory().of(manifold);
  const std::size_t most = points->size() + MOST_LEFT;
  for (const contact::Contact& contact : manifold.contacts) {
    const int vertex = contact::vertexOf(contact.id, is_a);
    if (vertex < 0 || contact.pierced || contact.depth < -TOUCH) continue;
    if (chosen.empty() ? points->size() == most : !std::binary_search(chosen.begin(), chosen.end(), contact.id)) continue;
    points->push_back({collider.X_BC * collider.geometry->mesh().vertices[vertex], fading_.sinkOf(index, vertex)});
  }
}

std::vector<Simulator::Impl::LeavingPoint> Simulator::Impl::pointsStoodOn(int model) const {
  std::vector<LeavingPoint> points;
  for (const contact::ContactManifold& manifold : at_hand_.manifolds)
    for (const bool is_a : {true, false})
      if (world_.colliders[is_a ? manifold.a : manifold.b].model == model) addStoodOn(manifold, is_a, &points);
  const auto key = [](const LeavingPoint& p) { return std::make_tuple(p.p_W.x(), p.p_W.y(), p.p_W.z(), p.sink); };
  std::sort(points.begin(), points.end(), [&](const LeavingPoint& a, const LeavingPoint& b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end(), [](const LeavingPoint& a, const LeavingPoint& b) { return a.p_W == b.p_W; }),
               points.end());
  return points;
}

void Simulator::Impl::addLeaving(int model, const std::vector<LeavingPoint>& points, double speed) {
  if (points.empty()) return;
  const LiveGround& live = live_.at(world_.models[model].name);
  contact::Collider leaving = world_.colliders[live.cloud];
  leaving.name += "::leaving";
  std::vector<Vector3> places;
  std::vector<SunkPoint> sunk;
  for (const LeavingPoint& point : points) {
    sunk.push_back({static_cast<int>(places.size()), std::max(point.sink, speed * config_.time_step)});
    places.push_back(leaving.X_BC.inverse() * point.p_W);
  }
  geometry::MeshReport report;
  leaving.geometry = std::make_shared<const contact::CollisionGeometry>(
      std::make_shared<const geometry::TriangleMesh>(geometry::pointCloudMesh(places, &report)));
  report.source = "points that sink away below what stood on them";
  const int collider = world_.addCollider(leaving, leaving.radius, leaving.surface, report);
  layer_watch_.forget(collider);
  fading_.add(collider, speed, std::move(sunk));
}

std::vector<SunkPoint> Simulator::Impl::sunkIntoTouch(int cloud) const {
  std::vector<SunkPoint> sunk = innerPoints(world_, bodies_, cloud);
  for (const contact::ContactManifold& manifold : found_.manifolds) {
    if (manifold.a != cloud && manifold.b != cloud) continue;
    for (const contact::Contact& contact : manifold.contacts) {
      const int vertex = contact::vertexOf(contact.id, manifold.a == cloud);
      if (vertex >= 0 && !contact.pierced && contact.depth > 0) sunk.push_back({vertex, contact.depth});
    }
  }
  return byVertex(std::move(sunk));
}

void Simulator::Impl::updateCloud(const std::string& environment, CloudSurface* surface) {
  const auto known = live_.find(environment);
  if (known == live_.end()) throw InputError(fmt::format("environments: {}: is no live one, or was unloaded", environment));
  LiveGround& live = known->second;
  const int model = world_.modelIndex(environment);
  world_.bodyStates(&bodies_);
  if (!at_hand_.known) findFirstContacts();
  const std::vector<LeavingPoint> leaving = pointsStoodOn(model);
  CloudSurface before;
  if (live.cloud >= 0) before.geometry = world_.colliders[live.cloud].geometry;
  forgetContacts(world_.collidersOf(model));
  for (const int collider : world_.removeShapes(model)) fading_.forget(collider);

  contact::Collider cloud;
  cloud.name = environment;
  cloud.model = model;
  cloud.X_BC = makePose(surface->origin);
  cloud.geometry = surface->geometry;
  live.cloud = world_.addCollider(cloud, surface->radius, live.surface, surface->report);
  layer_watch_.forget(live.cloud);
  addLeaving(model, leaving, live.fade_speed);

  pair_watch_.find({world_, bodies_, nullptr, config_.time_step}, &pairs_);
  pair_searches_.find(world_, at_hand_, fading_, &pairs_, &found_);
  fading_.add(live.cloud, -live.fade_speed, sunkIntoTouch(live.cloud));
  at_hand_.known = false;
  layout_.clear();
  *surface = std::move(before);
}

void Simulator::Impl::endFading() {
  fading_.clear();
  for (const auto& [name, live] : live_) {
    const int model = world_.modelIndex(name);
    for (const int collider : world_.collidersOf(model)) {
      if (collider == live.cloud) continue;
      forgetContacts({collider});
      world_.removeShape(collider);
    }
  }
}

}  // namespace blem_sim::sim
