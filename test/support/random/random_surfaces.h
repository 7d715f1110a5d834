// What cameras send while a simulation runs: random clouds and meshes of live environments, sound ones and ones that must be refused.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"
#include "support/random/random_events.h"

namespace blem_sim {

/** Draws surfaces from a seed, near the models and about as large. */
class RandomSurfaces {
 public:
  /** @param size [m] of a body, typically */
  RandomSurfaces(std::uint64_t seed, double size) : numbers_(seed), size_(size) {}

  /** Adds a cloud and a mesh that are live. */
  void addTo(sim::SimulationConfig* config) {
    sim::EnvironmentConfig cloud;
    cloud.name = "live_cloud";
    cloud.live.topic = "/points";
    cloud.cloud.auto_radius = numbers_.chance(0.5);
    if (!cloud.cloud.auto_radius) cloud.cloud.point_radius = 0.02 * size_;
    sim::EnvironmentConfig mesh;
    mesh.name = "live_mesh";
    mesh.live.topic = "/mesh";
    mesh.live.type = sim::LiveConfig::Type::MESH;
    mesh.contact.boundary_width = sim::BoundaryWidth(numbers_.chance(0.3) ? 0 : 0.01 * size_);
    live_ = {cloud, mesh};
    config->environments.insert(config->environments.end(), live_.begin(), live_.end());
  }

  /** Exchanges a surface, or takes its environment away. */
  Event happen(sim::Simulator* simulator) {
    const sim::EnvironmentConfig& live = live_[numbers_.count(0, 1)];
    try {
      if (numbers_.chance(0.04)) return comeOrGo(live, simulator);
      sim::CloudSurface surface = surfaceOf(live, placeIn(*simulator));
      std::vector<sim::SearchedAhead> ahead;
      if (surface.geometry && numbers_.chance(0.3)) ahead = sim::searchAhead(simulator->cloudNeighbours(live.name), surface);
      simulator->updateCloud(live.name, &surface, std::move(ahead));
    } catch (const InputError&) {
      return {live.name, true, false};
    }
    return {live.name, false, false};
  }

 private:
  Event comeOrGo(const sim::EnvironmentConfig& live, sim::Simulator* simulator) {
    if (numbers_.chance(0.5)) {
      simulator->unloadEnvironment(live.name);
      return {live.name + " unloaded", false, false};
    }
    simulator->loadEnvironment(live);
    return {live.name + " loaded", false, false};
  }

  /** Near the root of a model, or a little below it. */
  Vector3 placeIn(const sim::Simulator& simulator) {
    const std::vector<sim::ModelInfo>& models = simulator.models();
    const sim::ModelInfo& model = models[numbers_.count(0, static_cast<int>(models.size()) - 1)];
    const bool stands = model.alive && !model.bodies.empty() && model.bodies[0] != dynamics::WORLD_BODY;
    const Vector3 root = stands ? Vector3(simulator.world().bodyState(model.bodies[0]).X_WB.translation()) : Vector3(Vector3::Zero());
    return root - Vector3(0, 0, numbers_.uniform(0, 0.8) * size_) + numbers_.within(0.2 * size_);
  }

  sim::CloudSurface surfaceOf(const sim::EnvironmentConfig& live, const Vector3& place) {
    const Pose X_WS = makePose(place, numbers_.direction() * (numbers_.chance(0.7) ? 0 : numbers_.uniform(0, M_PI)));
    if (live.live.type != sim::LiveConfig::Type::MESH) return sim::makeCloudSurface(points(X_WS), live.cloud, live.name);
    if (numbers_.chance(0.1)) return {};
    geometry::TriangleMesh seen = mesh();
    for (Vector3& vertex : seen.vertices) vertex = X_WS * vertex;
    return sim::makeMeshSurface(std::move(seen), live.name);
  }

  /** A rough square of points, in one of ten with none, another one too many, or some that are none. */
  std::vector<Vector3> points(const Pose& X_WS) {
    const int kind = numbers_.count(0, 9), half = numbers_.count(2, 12);
    if (kind == 0) return {};
    if (kind == 1) return {X_WS.translation()};
    const double spacing = size_ * numbers_.spread(0.03, 0.3), noise = numbers_.chance(0.5) ? 0 : spacing * numbers_.uniform(0, 0.3);
    std::vector<Vector3> seen;
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half; ++j) seen.push_back(X_WS * Vector3(spacing * i, spacing * j, noise * numbers_.uniform(-1, 1)));
    if (kind == 2) seen.resize(seen.size() + 50, seen.front());
    if (kind == 3) seen.insert(seen.end(), {Vector3::Constant(NAN), Vector3(0, INFINITY, 0), Vector3(1e9, 0, 0)});
    if (kind == 4)
      for (int i = 0; i < 200; ++i) seen.push_back(X_WS.translation() + numbers_.within(size_));  // in bodies as well
    return seen;
  }

  geometry::TriangleMesh mesh() {
    const int kind = numbers_.count(0, 5), cells = numbers_.count(1, 16);
    if (kind == 0) return geometry::boxMesh(Vector3::Constant(size_ * numbers_.spread(0.1, 3)));
    if (kind == 1) return geometry::icosphereMesh(size_, 2);
    geometry::TriangleMesh seen = geometry::gridMesh(4 * size_, 4 * size_, cells, cells);
    for (Vector3& vertex : seen.vertices) vertex.z() += kind == 2 ? 0 : 0.05 * size_ * numbers_.uniform(-1, 1);
    if (kind == 3) seen.vertices[numbers_.count(0, static_cast<int>(seen.vertices.size()) - 1)] = Vector3::Constant(NAN);
    for (Vector3i& element : seen.elements)
      if (kind == 4 && numbers_.chance(0.3)) element[2] = element[0];
    return seen;
  }

  SceneNumbers numbers_;
  double size_;
  std::vector<sim::EnvironmentConfig> live_;
};

}  // namespace blem_sim
