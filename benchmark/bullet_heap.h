// A heap in Bullet: boxes or spheres in a bin of static boxes, 50 sequential-impulse sweeps a step.
#pragma once

#include <memory>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim {

/** Equal pieces in a bin whose floor's middle is the origin. */
struct HeapScene {
  bool spheres = false;  ///< of diameter `size`; else cubes
  double size = 0;       ///< [m]
  double mass = 0;       ///< [kg]
  double friction = 0;
  double time_step = 0.001;              ///< [s]
  double bin_width = 0, bin_height = 0;  ///< [m]
  std::vector<Pose> poses;               ///< at the start
};

class BulletHeap {
 public:
  virtual ~BulletHeap() = default;
  virtual void step() = 0;
  virtual double deepest() const = 0;  ///< [m] penetration of the last step's contacts
  virtual double fastest() const = 0;  ///< [m/s] of the centres
};

/** A heap in Bullet; null in a build without Bullet. */
std::unique_ptr<BulletHeap> makeBulletHeap(const HeapScene& scene);

}  // namespace blem_sim
