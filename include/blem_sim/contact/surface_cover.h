// Surfaces of one body that meet flush have the contacts of one mesh.
#pragma once

#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"

namespace blem_sim {

/**
 * Would a contact be there if its surface and others of the same body were one mesh? Not if another one, on which its place lies (within
 * 1 um), leads along its direction from there; nor that of an edge or a vertex that is flat in what they are together; and a vertex above
 * several that lie in each other has one. Room is kept.
 */
class SurfaceCover {
 public:
  /** @param own_is_a is the contact's A the surface? */
  void begin(const Contact& contact, bool own_is_a, const Collider& own, const Pose& X_WO);
  /** @param other its layer is no thinner @param comes_first does its contact stay, if both have the same one? */
  void add(const Collider& other, const Pose& X_WO, bool comes_first);
  /** After all others were added. */
  bool isCovered();

 private:
  /** A face that the place lies on. */
  struct Face {
    Vector3 ways[3];  // unit, to its corners; world
    int count;        // of them: not to one that is the place
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
  double flat_ = 0;            // [rad] gap between faces of what is flat
  bool is_of_vertex_ = false;  // of the other body: it has a contact with whichever face it is over
  bool is_met_ = false;        // by another surface
  bool leads_along_ = false;   // another one
  std::vector<Face> faces_;
  Vector3 normal_, across_[2];   // of the plane that the place lies in
  std::vector<Sector> sectors_;  // in it
};

}  // namespace blem_sim
