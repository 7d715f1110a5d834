// Contacts of a flat patch that are deeper than its corners tell.
#pragma once

#include <cmath>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "patch_frame.h"

namespace blem_sim {

/** [m] A corner that stands out less is none: where vertices coincide, merging moves points about. */
constexpr double FLATNESS = 1e-7;
constexpr int NO_POINT = -1;

/** A contact seen along the normal; points form lists. */
struct PlanePoint {
  double x, y, depth;
  int contact, next;
};

/** Twice the area of a triangle, positive if counter-clockwise. */
inline double cross(const PlanePoint& o, const PlanePoint& a, const PlanePoint& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

inline double distance(const PlanePoint& a, const PlanePoint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::sqrt(dx * dx + dy * dy);
}

/** Interpolates depths over the corners of a patch, and raises the interpolation to its highest point, again and again, until no point is
 * above it. Keeps its memory. */
class PatchDepths {
 public:
  /** Appends the contacts that the interpolation was raised to.
   * @param corners of the hull of the points, counter-clockwise @param points their lists are overwritten */
  void keepDeeper(const std::vector<Contact>& contacts, const std::vector<PlanePoint>& corners, std::vector<PlanePoint>* points,
                  std::vector<int>* kept);

 private:
  /** Points that lie over one triangle of kept points (a segment if c is b). */
  struct Facet {
    Facet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c);
    bool isSegment() const { return b.contact == c.contact; }
    /** How far p lies inside the sides; negative outside. */
    double insideBy(const PlanePoint& p) const;
    PlanePoint a, b, c;
    int first = NO_POINT;         // of the list of its points
    double side_x[3], side_y[3];  // unit, along the sides from a, b, c
  };
  static double interpolatedDepth(const Facet& facet, const PlanePoint& p);
  /** Of the points of a facet only those stay that are above it. @return the highest */
  int highest(const std::vector<Contact>& contacts, Facet* facet);
  void split(const Facet& facet, const PlanePoint& p);
  void distribute(int first, std::size_t first_facet);
  void distributeOnSegments(const Facet& parent, const PlanePoint& at, int first, std::size_t first_facet);
  void hand(int point, Facet* facet);

  std::vector<PlanePoint>* points_ = nullptr;
  std::vector<Facet> open_;
  std::vector<int> corner_contacts_;
};

}  // namespace blem_sim
