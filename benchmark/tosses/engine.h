// Engines that replay recorded tosses of a cube onto a floor, one toss after the other.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim {

/** The cube, the floor {z = floor} and the step. Units m, kg, s. */
struct TossScene {
  double time_step = 0, floor = 0, side = 0, mass = 0;
  Vector3 gravity = Vector3::Zero();
  Vector3 com = Vector3::Zero();          ///< from the cube's middle, its axes
  Vector3 inertia = Vector3::Zero();      ///< [kg m^2] about the centre of mass, along the cube's axes
  std::map<std::string, double> surface;  ///< parameters that are fitted, by the engine's own names
};

/** Pose of the cube's middle; velocities of the centre of mass, world axes. */
struct TossMotion {
  Pose X_WM = Pose::Identity();
  Vector3 v_WCom = Vector3::Zero(), w_WM = Vector3::Zero();
};

class TossEngine {
 public:
  virtual ~TossEngine() = default;
  /** Begins a toss, with nothing remembered of the last one. */
  virtual void start(const TossMotion& motion) = 0;
  virtual void step() = 0;
  /** Pose of the cube's middle. */
  virtual Pose pose() const = 0;
};

using MakeTossEngine = std::unique_ptr<TossEngine> (*)(const TossScene& scene);

std::unique_ptr<TossEngine> makeOdeToss(const TossScene& scene);
std::unique_ptr<TossEngine> makeBulletToss(const TossScene& scene);
std::unique_ptr<TossEngine> makeMujocoToss(const TossScene& scene);

}  // namespace blem_sim
