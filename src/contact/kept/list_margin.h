// Margins of candidate lists: the motion of one mesh against the other for which they are good.
#pragma once

#include <cmath>

#include "features/mesh_pair.h"
#include "kept/direction_ball.h"

namespace blem_sim::contact {

/** Motion of one mesh against the other for which lists of candidates are good. */
struct ListMargin {
  double motion = 0;  ///< [m] of any point of either mesh near the other
  double turn = 0;    ///< of unit vectors: length of the difference
  /** Only in lists for crossings: rows square to each other, fixed mesh's frame; unless they are zero, no point moves along any of them by
   * more than its length [m]. */
  Matrix3 ways = Matrix3::Zero();
};

/** Pose and range that a list of candidates was made for: it is good while the meshes have not moved against each other by more than the
 * margin. */
struct ListOrigin {
  bool known = false;
  Pose X_FM = Pose::Identity();
  double range = 0;  ///< [m]
  ListMargin margin;
};

/** Longest way of the end of a unit vector from one orientation to the other. */
double largestTurn(const Pose& X, const Pose& Y);

/** Part of a list's margin that is used up where nothing has moved and turned farther than so, for contacts within the range: more than 1
 * where the list is not good. */
double usedMargin(const ListOrigin& origin, double range, double motion, double turn);

/** Region of the moving mesh near the fixed one. */
class NearRegion {
 public:
  using Motions = Eigen::Matrix<double, 3, 8>;

  explicit NearRegion(const MeshPair& pair);
  /** Motions of the corners of a box around the region from one pose to the other [m]: motions are linear in place, so no point goes
   * farther than these, in any direction. Zero where nothing is near. */
  Motions motions(const Pose& X, const Pose& Y) const;
  /** Longest way [m] of a point from one pose to the other. */
  double largestMotion(const Pose& X, const Pose& Y) const { return std::sqrt(motions(X, Y).colwise().squaredNorm().maxCoeff()); }
  /** The same along some directions only, or against them. */
  double largestMotion(const Pose& X, const Pose& Y, const DirectionBall& directions) const;
  /** Part of a list's margin that is used up at a pose, for contacts within the range: more than 1 where the list is not good. */
  double used(const ListOrigin& origin, const Pose& X_FM, double range) const;

 private:
  Eigen::Matrix<double, 3, 8> corners_;
  bool empty_;
};

/** Margin for a pair that goes on as it moved in a step, for `steps` of them: wide along its way, narrow beside it. @param least [m] */
ListMargin marginAlong(const NearRegion::Motions& step, double steps, double least);

}  // namespace blem_sim::contact
