// Points of a static cloud that come or go below the bodies that stand on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::sim {

/** A point that lies deeper than the cloud has it. */
struct SunkPoint {
  int vertex;   ///< of its collider's mesh
  double sink;  ///< [m] by which its contacts are less deep than its place says; infinite: it has none
};

/**
 * Sinks of points, by collider. Points that come rise to where they are, points that leave sink until nothing stands on them, so a cloud
 * that is exchanged for another neither throws what stands on it nor lets it fall. Part of the saved state.
 */
class FadingPoints {
 public:
  bool empty() const { return fading_.empty(); }
  /**
   * Points of a collider that has none yet. @param speed [m/s] at which sinks change: below 0 points come, above 0 they leave
   * @param points sorted by vertex, none twice
   */
  void add(int collider, double speed, std::vector<SunkPoint> points);
  /** [m] Sink of a vertex, 0 if it does not fade. */
  double sinkOf(int collider, int vertex) const;
  /** Makes contacts of points that fade as much less deep as they are sunk; those of points that have sunk away are dropped. */
  void apply(contact::ContactManifold* manifold) const;
  /** Lets time pass [s]. */
  void advance(double dt);
  void forget(int collider);
  void clear() { fading_.clear(); }
  void save(geometry::StateWriter* writer) const;
  /** @param colliders whose points they may be */
  void restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

 private:
  struct Fading {
    int collider;
    double speed;
    std::vector<SunkPoint> points;
  };
  const Fading* of(int collider) const;
  static Fading fadingFrom(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

  std::vector<Fading> fading_;  // sorted by collider, none without points
};

}  // namespace blem_sim::sim
