// Contacts of a live environment's next surface, before it is exchanged.
#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/sim/simulator_types.h"
#include "clouds/turned_box.h"

namespace blem_sim::sim {
namespace {

constexpr double MARGIN = 0.001;  // [m] beyond the layers

}  // namespace

std::vector<SearchedAhead> searchAhead(const CloudNeighbours& neighbours, const CloudSurface& surface) {
  std::vector<SearchedAhead> all;
  if (!surface.geometry) return all;
  contact::Collider own, other;
  own.geometry = surface.geometry;
  own.radius = surface.isMesh() ? neighbours.width : surface.radius;
  const Pose X_WC = makePose(surface.origin);
  const Box box = turned(own.geometry->bounds(), X_WC);
  contact::NarrowPhaseWorkspace workspace;
  contact::ContactManifold found;
  for (const CloudNeighbours::Neighbour& neighbour : neighbours.colliders) {
    other.geometry = neighbour.geometry;
    other.radius = neighbour.radius;
    const Vector3 reach = Vector3::Constant(own.radius + other.radius + MARGIN);
    const Box near = turned(other.geometry->bounds(), neighbour.X_WC);
    if (!box.intersects(Box(near.min() - reach, near.max() + reach))) continue;
    SearchedAhead searched{neighbour.collider, {}};
    // The second search chooses the nearest candidates, and so the next one need not.
    for (int search = 0; search < 2; ++search)
      contact::narrowPhase({own, X_WC}, {other, neighbour.X_WC}, {MARGIN, nullptr, &searched.memory}, &workspace, &found);
    all.push_back(std::move(searched));
  }
  return all;
}

}  // namespace blem_sim::sim
