// Points and triangles of a live environment that come or go below the bodies that stand on them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::sim {

/** A vertex that lies deeper than the surface has it. */
struct SunkPoint {
  int vertex;   ///< of its collider's mesh
  double sink;  ///< [m] by which its contacts are less deep than its place says; infinite: it has none
};

/** Place of a static collider, points or a mesh, where a contact touches it. @param is_a the collider is the contact's A */
contact::MeshPlace touchedPlace(const contact::Collider& collider, const contact::Contact& contact, bool is_a);

/**
 * Sinks of vertices, by collider; between the vertices of a triangle the sink is their mean. What comes rises to where it is, what leaves
 * sinks until nothing stands on it, so an environment that is exchanged for another neither throws what stands on it nor lets it fall. Part
 * of the saved state.
 */
class FadingPoints {
 public:
  static constexpr double UPWARDS = 0.5;  ///< cosine to the way up from which on a push bears

  bool empty() const { return fading_.empty() && crossings_.empty(); }
  /**
   * Points of a collider that has none yet. @param speed [m/s] at which sinks change: below 0 points come, above 0 they leave
   * @param points sorted by vertex, none twice
   */
  void add(int collider, double speed, std::vector<SunkPoint> points);
  /** Sinks vertices that fade already some more. @param more sorted by vertex, none twice */
  void deepen(int collider, const std::vector<SunkPoint>& more);
  /** A pair that crosses since an exchange, as a mesh that a camera saw of the robot does: its pierced contacts count for nothing. */
  void addCrossing(int a, int b);
  bool crosses(int a, int b) const { return std::binary_search(crossings_.begin(), crossings_.end(), std::make_pair(a, b)); }
  bool fades(int collider) const { return of(collider) != nullptr; }
  /** [m] Sink of a vertex, 0 if it does not fade. */
  double sinkOf(int collider, int vertex) const;
  /** [m] Sink of a contact with a collider, as apply takes it off. @param is_a the collider is the contact's A */
  double sinkOf(const contact::Collider& collider, int index, const contact::Contact& contact, bool is_a) const;
  /**
   * Makes contacts of what fades as much less deep as it is sunk; those that touch a vertex that has sunk away are dropped. What comes
   * pushes nothing but upwards: elsewhere its contacts touch at most, so that it holds a body and never squeezes it.
   */
  void apply(const std::vector<contact::Collider>& colliders, contact::ContactManifold* manifold) const;
  /** Tells the way up, zero where there is none. */
  void setUp(const Vector3& up) { up_ = up; }
  /** Lets time pass [s]. What comes and may not push waits where it touches. @param manifolds as apply left them */
  void advance(double dt, const std::vector<contact::Collider>& colliders, const std::vector<contact::ContactManifold>& manifolds);
  void forget(int collider);
  void clear() { *this = FadingPoints(); }
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
  bool mayPush(const contact::Contact& contact, bool is_a) const;
  std::vector<std::pair<int, int>> waiting(double dt, const std::vector<contact::Collider>& colliders,
                                           const std::vector<contact::ContactManifold>& manifolds) const;
  static Fading fadingFrom(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

  std::vector<Fading> fading_;                  // sorted by collider, none without points
  std::vector<std::pair<int, int>> crossings_;  // sorted, the smaller collider first
  Vector3 up_ = Vector3::Zero();
};

}  // namespace blem_sim::sim
