// Contacts of a flat patch that are deeper than its corners tell.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "lanes/reduction_lanes.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

/** [m] A corner that stands out less is none: where vertices coincide, merging moves points about. */
constexpr double FLATNESS = 1e-7;

/** A contact seen along the normal. */
struct PlanePoint {
  double x, y, depth;
  int contact;
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
   * @param members contacts of the places, by their index @param corners of the hull of the places, counter-clockwise */
  void keepDeeper(const std::vector<contact::Contact>& contacts, const int* members, const PlanePlaces& places,
                  const std::vector<PlanePoint>& corners, std::vector<int>* kept);

 private:
  static constexpr int NO_PLACE = -1;

  /** A triangle of kept points, a segment if c is b, and the places in it that are above it. */
  struct Facet {
    Facet(const PlanePoint& first_corner, const PlanePoint& second_corner, const PlanePoint& third_corner)
        : a(first_corner), b(second_corner), c(third_corner) {
      const double area = cross(a, b, c);
      per_area = area > 0 ? 1 / area : 0;
    }
    bool isSegment() const { return b.contact == c.contact; }
    double depthAt(const PlanePoint& p) const {
      if (per_area > 0) {
        const double weight_a = std::clamp(cross(b, c, p) * per_area, 0.0, 1.0);
        const double weight_b = std::clamp(cross(c, a, p) * per_area, 0.0, 1.0 - weight_a);
        return weight_a * a.depth + weight_b * b.depth + (1 - weight_a - weight_b) * c.depth;
      }
      const double along = (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y), length = distance(a, b);
      const double weight_b = length > 0 ? std::clamp(along / (length * length), 0.0, 1.0) : 0.0;
      return (1 - weight_b) * a.depth + weight_b * b.depth;
    }
    PlanePoint a, b, c;
    double per_area;  // 0 if there is none: then it is a segment, too
    int first = NO_PLACE, highest = NO_PLACE;
    double most = 0;  // [m] that the highest is above it
  };

  PlanePoint pointAt(int place) const { return {places_->x[place], places_->y[place], places_->depth[place], members_[place]}; }
  int deepestPlace() const;
  /** Opens triangles from one point to all sides: the deepest if no corner is as deep, else the deepest corner. */
  void openFan(const std::vector<PlanePoint>& corners, const PlanePoint& deepest, std::vector<int>* kept);
  void handToFan(double shallowest);
  /** Puts a place onto the facet's list if it is above it. */
  void hand(int place, const PlanePoint& point, Facet* facet);
  /** Raises a facet to its highest place: opens the facets that it falls into, and hands them its places. */
  void raise(const Facet& facet, std::vector<int>* kept);
  void raiseTriangle(const Facet& facet, const PlanePoint& top, std::vector<int>* kept);

  const std::vector<contact::Contact>* contacts_ = nullptr;
  const int* members_ = nullptr;
  const PlanePlaces* places_ = nullptr;
  Fan fan_;
  std::vector<Facet> open_;
  std::vector<PlanePoint> ring_;
  std::vector<int> next_, sectors_;  // by place
};

}  // namespace blem_sim::reduction
