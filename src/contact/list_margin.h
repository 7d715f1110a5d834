// For how much motion of one mesh against the other lists of candidates are good.
#pragma once

#include <cmath>

#include "direction_ball.h"
#include "mesh_pair.h"

namespace blem_sim {

/** For how much motion of one mesh against the other lists of candidates are good. */
struct ListMargin {
  double motion = 0;  ///< [m] of any point of either mesh near the other
  double turn = 0;    ///< of unit vectors: length of the difference
  /** Of lists for crossings: rows square to each other, fixed mesh's frame; unless they are zero, no point moves along any of them by more
   * than its length [m]. */
  Matrix3 ways = Matrix3::Zero();
};

/** Where a list of candidates was made: it is good while the meshes have not moved against each other by more than the margin. */
struct ListOrigin {
  bool known = false;
  Pose X_FM = Pose::Identity();
  double range = 0;  ///< [m]
  ListMargin margin;
};

/** How far the end of a unit vector moves at most from one orientation to the other. */
double largestTurn(const Pose& X, const Pose& Y);

/** How much of a list's margin is used up where nothing has moved and turned farther than so, for contacts within the range: more than 1
 * where it is not good. */
double usedMargin(const ListOrigin& origin, double range, double motion, double turn);

/** Where the moving mesh is near the fixed one. */
class NearRegion {
 public:
  using Motions = Eigen::Matrix<double, 3, 8>;

  explicit NearRegion(const MeshPair& pair);
  /** How the corners of a box around it move from one pose to the other [m]: motions are linear in place, so no point goes farther than
   * these, in any direction. Zero where nothing is near. */
  Motions motions(const Pose& X, const Pose& Y) const;
  /** How far [m] a point moves at most from one pose to the other. */
  double largestMotion(const Pose& X, const Pose& Y) const { return std::sqrt(motions(X, Y).colwise().squaredNorm().maxCoeff()); }
  /** The same along some directions only, or against them. */
  double largestMotion(const Pose& X, const Pose& Y, const DirectionBall& directions) const;
  /** How much of a list's margin is used up at a pose, for contacts within the range: more than 1 where it is not good. */
  double used(const ListOrigin& origin, const Pose& X_FM, double range) const;

 private:
  Eigen::Matrix<double, 3, 8> corners_;
  bool empty_;
};

/** For a pair that goes on as it moved in a step, for so many: wide along its way, narrow beside it. @param least [m] */
ListMargin marginAlong(const NearRegion::Motions& step, double steps, double least);

}  // namespace blem_sim
