// A live environment of triangles, what stands on it, and a camera that sees it.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {

using Mesher = model::CloudOptions::Mesher;

constexpr double ROUGHNESS = 0.001;  // [m]
constexpr double CUBE_WIDTH = 0.0025;

/** A camera that sees a square floor about z = 0 from 1 m above, with fresh noise. */
class SeenFloor {
 public:
  explicit SeenFloor(double size, double noise = ROUGHNESS, double spacing = 0.005) : size_(size), spacing_(spacing), noise_(0, noise) {}
  model::SensedCloud next(double height = 0) {
    std::vector<Vector3> points;
    const int half = static_cast<int>(0.5 * size_ / spacing_);
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half; ++j) points.emplace_back(spacing_ * i, spacing_ * j, height + noise_(random_));
    model::SensedCloud cloud(points);
    cloud.width = cloud.height = 2 * half + 1;
    cloud.viewpoint = Vector3(0, 0, 1);
    return cloud;
  }

 private:
  double size_, spacing_;
  std::mt19937 random_{7};
  std::normal_distribution<double> noise_;
};

inline EnvironmentConfig liveMesh(Mesher mesher = Mesher::AUTO) {
  EnvironmentConfig environment;
  environment.name = "live";
  environment.live.topic = "/points";
  environment.cloud.as = model::CloudOptions::As::MESH;
  environment.cloud.mesher = mesher;
  return environment;
}

inline SimulationConfig cubeAboveMesh(double height = 0.06) {
  SimulationConfig config;
  config.environments = {liveMesh()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.001, 0.002, height})};
  return config;
}

inline void exchange(Simulator* simulator, const model::SensedCloud& cloud, Mesher mesher = Mesher::AUTO) {
  CloudSurface surface = makeCloudSurface(cloud, liveMesh(mesher).cloud, "live");
  simulator->updateCloud("live", &surface);
}

/** Upward force of all contacts on bodies [N]. */
inline double carriedBy(const StepReport& report) {
  double force = 0;
  for (const ContactReport& contact : report.contacts) force += (contact.body_a != dynamics::WORLD_BODY ? 1 : -1) * contact.force.z();
  return force;
}

inline double weightOf(const dynamics::World& world) {
  double mass = 0;
  for (int body = 0; body < world.bodyCount(); ++body) mass += world.bodySpec(body).inertial.mass;
  return mass * G;
}

}  // namespace blem_sim::sim
