// A scan of rolling ground in a surveyor's coordinates, and cubes that slide on it.
#pragma once

#include <cmath>
#include <string>

#include "sim/simulation_scene.h"

namespace blem_sim {

const Vector3 EASTING_NORTHING(400000, 5000000, 300);  // [m]

/** Ground of (2 half + 1)^2 points, 6.25 cm apart. Places in the file are multiples of 2^-10 m, which doubles hold there as at the origin.
 * @param offset [m] of the file's coordinates; the environment's pose takes it off again */
inline sim::EnvironmentConfig surveyedScan(const std::string& name, const Vector3& offset, int half) {
  sim::EnvironmentConfig environment;
  environment.name = "scan";
  environment.cloud.as = model::CloudOptions::As::MESH;
  environment.cloud.max_edge = 0.2;
  environment.X_WE = makePose(-offset);
  environment.uri = sim::sceneFile(name + ".pcd", [&](std::ofstream& out) {
    const int side = 2 * half + 1;
    out << std::setprecision(17) << "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << side << "\nHEIGHT " << side
        << "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << side * side << "\nDATA ascii\n";
    for (int i = -half; i <= half; ++i) {
      for (int j = -half; j <= half; ++j) {
        const Vector3 p = Vector3(0.0625 * j, 0.0625 * i, std::round(1024 * 0.05 * std::sin(0.4 * i) * std::cos(0.3 * j)) / 1024) + offset;
        out << p.x() << " " << p.y() << " " << p.z() << "\n";
      }
    }
  });
  return environment;
}

/** The scan at the world's origin, and a grid of cubes of 0.2 m and 1 kg, 0.5 m apart, that slide over it. */
inline sim::SimulationConfig cubesOnSurveyedScan(const std::string& name, const Vector3& offset, int half, int cubes) {
  sim::SimulationConfig config;
  config.environments = {surveyedScan(name, offset, half)};
  const int columns = static_cast<int>(std::ceil(std::sqrt(cubes)));
  for (int i = 0; i < cubes; ++i) {
    const Vector3 place(0.03 + 0.5 * (i % columns), 0.04 + 0.5 * (i / columns), 0.2);
    config.objects.push_back(sim::box("cube" + (i == 0 ? "" : std::to_string(i)), Vector3::Constant(0.2), 1, place));
    config.objects[i].linear_velocity = {0.5, 0.2, 0};
  }
  return config;
}

/** Puts all that a scene has where the scan's coordinates are. */
inline sim::SimulationConfig movedTo(const Vector3& offset, sim::SimulationConfig config) {
  for (sim::EnvironmentConfig& environment : config.environments) environment.X_WE = makePose(offset) * environment.X_WE;
  for (sim::ObjectConfig& object : config.objects) object.X_WO = makePose(offset) * object.X_WO;
  return config;
}

}  // namespace blem_sim
