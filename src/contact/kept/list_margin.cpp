#include "kept/list_margin.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kept/list_schedule.h"

namespace blem_sim::contact {
namespace {

/** Box in the moving mesh's frame that is near the fixed mesh: where that mesh's own box, wider by the range, meets the fixed one's, wider
 * by twice the range. */
Box commonRegion(const MeshPair& pair) {
  const Pose X_MF = pair.X_FM.inverse();
  const Box& fixed = pair.fixed.bounds;
  const Vector3 half = X_MF.linear().cwiseAbs() * (0.5 * fixed.sizes()) + Vector3::Constant(2 * pair.range), centre = X_MF * fixed.center();
  const Vector3 wider = Vector3::Constant(pair.range);
  return Box(centre - half, centre + half).intersection(Box(pair.moving.bounds.min() - wider, pair.moving.bounds.max() + wider));
}

double part(double of, double whole) {
  if (of <= 0) return 0;
  return whole > 0 ? of / whole : std::numeric_limits<double>::infinity();
}

}  // namespace

double largestTurn(const Pose& X, const Pose& Y) { return (X.linear() - Y.linear()).norm() / std::sqrt(2.0); }

double usedMargin(const ListOrigin& origin, double range, double motion, double turn) {
  const double wider = std::max(range - origin.range, 0.0);
  return std::max(part(motion + wider, origin.margin.motion), part(turn, origin.margin.turn));
}

NearRegion::NearRegion(const MeshPair& pair) {
  const Box region = commonRegion(pair);
  empty_ = region.isEmpty();
  for (int i = 0; i < 8; ++i) corners_.col(i) = region.corner(static_cast<Box::CornerType>(i));
}

NearRegion::Motions NearRegion::motions(const Pose& X, const Pose& Y) const {
  if (empty_) return Motions::Zero();
  return ((X.linear() - Y.linear()) * corners_).colwise() + (X.translation() - Y.translation());
}

double NearRegion::largestMotion(const Pose& X, const Pose& Y, const DirectionBall& directions) const {
  const Motions all = motions(X, Y);
  double most = 0;
  for (int i = 0; i < all.cols(); ++i) most = std::max(most, directions.most(all.col(i)));
  return most;
}

double NearRegion::used(const ListOrigin& origin, const Pose& X_FM, double range) const {
  const Matrix3& ways = origin.margin.ways;
  if (ways.isZero(0)) return usedMargin(origin, range, largestMotion(X_FM, origin.X_FM), largestTurn(X_FM, origin.X_FM));
  const Vector3 along = (ways * motions(X_FM, origin.X_FM)).cwiseAbs().rowwise().maxCoeff(), most = ways.rowwise().squaredNorm();
  return std::max({part(along.x(), most.x()), part(along.y(), most.y()), part(along.z(), most.z())});
}

ListMargin marginAlong(const NearRegion::Motions& step, double steps, double least) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> spread(step * step.transpose());
  const Matrix3 axes = spread.eigenvectors().transpose();
  const double bend = ListSchedule::BEND * std::sqrt(step.colwise().squaredNorm().maxCoeff());
  const Vector3 farthest = (axes * step).cwiseAbs().rowwise().maxCoeff();
  const Vector3 lengths = steps * (farthest + Vector3::Constant(bend)) + Vector3::Constant(least);
  return {lengths.norm(), 0, lengths.asDiagonal() * axes};
}

}  // namespace blem_sim::contact
