// Triangles that stay below what stands on them when their mesh is exchanged.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"
#include "clouds/fading_points.h"

namespace blem_sim::sim {

/** A surface and how far it is sunk. */
struct SunkSurface {
  geometry::TriangleMesh mesh;
  double radius = 0;            ///< [m] of its layer
  std::vector<SunkPoint> sunk;  ///< of all vertices, sorted
};

/**
 * Calls visit(element) for the triangles of a mesh that a contact touches.
 * @param mesh static collider @param way [m] that what touches it may go while they are needed, world: triangles along it count as well
 */
void visitTouched(const contact::Collider& mesh, const contact::MeshPlace& place, const Vector3& way,
                  const std::function<void(int element)>& visit);

/** Gathers triangles of meshes that are touched. Vertices of different meshes stay apart, so that each keeps its sink. */
class LeavingTriangles {
 public:
  explicit LeavingTriangles(const std::vector<contact::Collider>& colliders) : colliders_(colliders) {}

  /** @param mesh static collider; place and way as visitTouched takes them @param sink [m] at that place */
  void addTouched(int mesh, const contact::MeshPlace& place, const Vector3& way, double sink);
  /**
   * All of them, each once, with the thickest of their layers: those of thinner ones are sunk by what is more. Around what is touched they
   * are sunk as much at least. @param X_CW from the world to the frame of the surface
   * @param fading vertices that were sunk before
   * @param least sink [m]
   */
  SunkSurface surface(const Pose& X_CW, const FadingPoints& fading, double least) const;

 private:
  const std::vector<contact::Collider>& colliders_;
  std::map<std::pair<int, int>, double> touched_;  // sinks [m] by collider and element
  std::set<std::pair<int, int>> held_;             // colliders and vertices whose sinks the contacts at hand know
};

}  // namespace blem_sim::sim
