// Surfaces of one body that meet flush have the contacts of one mesh.
#pragma once

#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"

namespace blem_sim::contact {

/**
 * Whether other surfaces of the same body cover a contact: it would not exist if all were one mesh. It is covered if another one, on which
 * its place lies (within 1 um), leads along its direction from there; or if it is of an edge or a vertex that is flat in that mesh; and a
 * vertex above several that lie in each other keeps one contact. Room is kept.
 */
class SurfaceCover {
 public:
  /** @param own_is_a whether the surface is the contact's A */
  void begin(const Contact& contact, bool own_is_a, const Collider& own, const Pose& X_WO);
  /** @param other of no thinner layer @param comes_first whether its contact stays if both have the same one */
  void add(const Collider& other, const Pose& X_WO, bool comes_first);
  /** After all others were added. */
  bool isCovered();

 private:
  /** A face that the place lies on. */
  struct Face {
    Vector3 ways[3];  // unit, to its corners; world
    int count;        // ways; none to a corner that is the place
    bool comes_first;
  };
  /** Directions from the place into a face. */
  struct Sector {
    double first, width;  // [rad]
  };
  void addFaces(const Collider& surface, const Pose& X_WS, bool comes_first);
  bool findPlane(std::size_t first_own);
  void addSector(const Face& face);
  double widestGap();

  const Collider* own_ = nullptr;
  Pose X_WO_;
  Vector3 place_, away_;       // world; away from the surface
  double flat_ = 0;            // [rad] largest gap between faces around a flat place
  bool is_of_vertex_ = false;  // whether it is of a vertex of the other body: that has one with whichever face it is over
  bool is_met_ = false;        // whether the place lies on another surface
  bool leads_along_ = false;   // whether another one leads along `away_`
  std::vector<Face> faces_;
  Vector3 normal_, across_[2];   // unit: normal of the plane that the place lies in, axes in it
  std::vector<Sector> sectors_;  // in that plane
};

}  // namespace blem_sim::contact
