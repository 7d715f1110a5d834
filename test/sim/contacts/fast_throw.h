// A body thrown down at another that stands still or comes up, and the outcome.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "guard/step_guard.h"
#include "sim/simulation_scene.h"
#include "support/bare_meshes.h"

namespace blem_sim::sim {

/** The thrown body, or the one it is thrown at: mesh, and its extent over and under its frame [m]. */
struct ThrowBody {
  std::string uri;
  double half_height = 0;  ///< [m] of its box; of the thrown body's, turned any way
  double half_width = 0;   ///< [m] of a sheet: within it no centre may get below it; 0: not a sheet
};

struct ThrowScene {
  ThrowBody thrown, hit;
  double speed = 20;                 ///< [m/s] of approach
  Vector3 turn = Vector3::Zero();    ///< [rad] roll, pitch, yaw of the thrown body
  Vector3 spin = Vector3::Zero();    ///< [rad/s] of it
  Vector3 beside = Vector3::Zero();  ///< [m] by which it is thrown off the middle
  bool both_move = false;            ///< the body that is hit is free too, of the same mass, and comes up at half the speed
  double at_rest = 0;                ///< [kg] of the body that is hit, free too and at rest; 0: it is not
};

struct ThrowOutcome {
  bool passed = false;  ///< bare meshes crossed at the end of a step, or the thrown body's centre went through the other mesh in one
  int pierced_steps = 0, most_substeps = 0, most_redone = 0, redone_steps = 0;
  double max_of_layer = 0;

  void join(const ThrowOutcome& o) {
    passed = passed || o.passed;
    pierced_steps += o.pierced_steps;
    most_substeps = std::max(most_substeps, o.most_substeps);
    most_redone = std::max(most_redone, o.most_redone);
    redone_steps += o.redone_steps;
    max_of_layer = std::max(max_of_layer, o.max_of_layer);
  }
};

constexpr double THROWN_TURNS[][3] = {{0, 0, 0},        {0.3, 0.09, 0},    {0.7, 0.21, 0},  {M_PI / 4, 0, 0}, {0.9553, 0, M_PI / 4},
                                      {0.2, -0.5, 1.1}, {0.01, 0.02, 0.4}, {1.2, 0.6, -0.8}};  // [rad]

inline ThrowBody cubeThrown() { return {meshFile("thrown_cube", geometry::boxMesh(Vector3::Constant(0.1))), 0.0867, 0}; }
inline ThrowBody plateThrown() {
  return {meshFile("thrown_plate", geometry::transformed(geometry::gridMesh(0.1, 0.1, 1, 1), makePose(Vector3::Zero(), {M_PI / 2, 0, 0}))),
          0.071, 0};
}
inline ThrowBody mugThrown() { return {std::string(BLEM_SIM_SOURCE_DIR) + "/meshes/shell_mug.stl", 0.12, 0}; }
inline ThrowBody sheetHit(double size, int cells) {
  return {meshFile("sheet" + std::to_string(cells), geometry::gridMesh(size, size, cells, cells)), 0, 0.5 * size};
}
inline ThrowBody boxHit() { return {meshFile("hit_box", geometry::boxMesh(Vector3::Constant(0.1))), 0.05, 0}; }
/** A plate to be hit, upright, across the plate that is thrown. */
inline ThrowBody plateHit() {
  return {
      meshFile("hit_plate", geometry::transformed(geometry::gridMesh(0.1, 0.1, 1, 1), makePose(Vector3::Zero(), {M_PI / 2, 0, M_PI / 2}))),
      0.05, 0};
}
inline ThrowBody mugHit() { return {std::string(BLEM_SIM_SOURCE_DIR) + "/meshes/shell_mug.stl", 0.12, 0}; }

inline SimulationConfig configOf(const ThrowScene& scene) {
  SimulationConfig config;
  ObjectConfig thrown;
  thrown.name = "thrown";
  thrown.uri = scene.thrown.uri;
  thrown.mass = 1;
  thrown.X_WO = makePose(scene.beside + Vector3(0.013, 0.007, scene.hit.half_height + scene.thrown.half_height + 0.03), scene.turn);
  thrown.angular_velocity = scene.spin;
  thrown.linear_velocity = {0, 0, scene.both_move ? -scene.speed / 2 : -scene.speed};
  config.objects = {thrown};
  if (scene.both_move || scene.at_rest > 0) {
    ObjectConfig hit;
    hit.name = "hit";
    hit.uri = scene.hit.uri;
    hit.mass = scene.both_move ? 1 : scene.at_rest;
    hit.linear_velocity = {0, 0, scene.both_move ? scene.speed / 2 : 0};
    config.objects.push_back(hit);
  } else {
    EnvironmentConfig hit;
    hit.name = "hit";
    hit.uri = scene.hit.uri;
    config.environments = {hit};
  }
  return config;
}

/** Makes 40 ms of the throw. @param aroundStep is called with the function that makes a step */
template <typename AroundStep>
ThrowOutcome throwIt(const ThrowScene& scene, const dynamics::SolverSettings& solver, AroundStep&& aroundStep) {
  SimulationConfig config = configOf(scene);
  config.solver = solver;
  Simulator simulator(config, model::UriResolver());
  ThrowOutcome outcome;
  const int thrown = colliderOf(simulator, "thrown"), hit = colliderOf(simulator, "hit");
  CentrePath centre(thrown, hit);
  for (int i = 0; i < 40; ++i) {
    aroundStep([&simulator] { simulator.step(); });
    const StepReport& report = simulator.report();
    outcome.pierced_steps += (report.status & CONTACT_UNRELIABLE) != 0;
    outcome.most_substeps = std::max(outcome.most_substeps, report.substeps);
    outcome.most_redone = std::max(outcome.most_redone, report.redone_solves);
    outcome.redone_steps += report.redone_solves > 0;
    outcome.max_of_layer = std::max(outcome.max_of_layer, report.max_of_layer);
    EXPECT_FALSE(report.status & STATE_NOT_FINITE);
    const Vector3 p = bodyOf(simulator, "thrown").X_WB.translation();
    if (std::max(std::abs(p.x()), std::abs(p.y())) < scene.hit.half_width && p.z() < 0) outcome.passed = true;
    outcome.passed = centre.goesThrough(simulator) || meshesCross(simulator, thrown, hit) || outcome.passed;
  }
  return outcome;
}

}  // namespace blem_sim::sim
