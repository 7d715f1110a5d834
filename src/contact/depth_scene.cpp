#include "blem_sim/contact/depth_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/kernels.h"
#include "ray_turns.h"

namespace blem_sim::contact {
namespace {

constexpr double NO_DEPTH = std::numeric_limits<double>::infinity();
constexpr double PLACE_ROUNDING = 0x1p-46;  // of a place that is moved into another frame, relative to its coordinates

bool isDrawn(const RayTarget& target) { return target.geometry->hasOnlyTriangles(); }

std::vector<RayTarget> notDrawn(std::vector<RayTarget> targets) {
  targets.erase(std::remove_if(targets.begin(), targets.end(), isDrawn), targets.end());
  return targets;
}

void copyRows(const Matrix3& R, double (&to)[9]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) to[3 * i + j] = R(i, j);
}

kernels::PixelRays pixelRaysOf(const PinholeRays& rays, const Pose& X_CW, double nearest) {
  kernels::PixelRays numbers;
  copyRows(rays.X_WS.linear(), numbers.R_WS);
  copyRows(X_CW.linear(), numbers.R_CW);
  const Vector3 origin = X_CW * rays.X_WS.translation();
  std::copy(origin.data(), origin.data() + 3, numbers.origin);
  numbers.focal_length = rays.pinhole.focal_length;
  numbers.middle_u = rays.pinhole.middle_u;
  numbers.middle_v = rays.pinhole.middle_v;
  numbers.nearest = nearest;
  return numbers;
}

/** A band's arrays: first hits so far, and room for the kernels. */
class BandArrays {
 public:
  /** @param farthest [m] which still counts */
  BandArrays(const Pinhole& pinhole, int first_row, double farthest)
      : rows_(std::min(DepthScene::BAND_ROWS, pinhole.height - first_row)),
        stride_((pinhole.width + kernels::TILE - 1) / kernels::TILE * kernels::TILE),
        numbers_(new double[4 * pixels()]),
        axes_(new std::uint8_t[pixels() + pixels() / kernels::TILE]),
        tiles_((rows_ + kernels::TILE - 1) / kernels::TILE * (stride_ / kernels::TILE), {NO_DEPTH, 0}),
        first_row_(first_row),
        columns_(pinhole.width) {
    for (int row = 0; row < rows_; ++row) {
      double* const depths = numbers_.get() + row * stride_;
      std::fill(depths, depths + columns_, std::nextafter(farthest, NO_DEPTH));
      std::fill(depths + columns_, depths + stride_, -NO_DEPTH);  // nothing is drawn beyond the last column
    }
  }

  int rows() const { return rows_; }
  const double* row(int row) const { return numbers_.get() + row * stride_; }
  kernels::DepthBand numbers() {
    double* const d = numbers_.get();
    const std::size_t n = pixels();
    return {first_row_, rows_, columns_, stride_, d, tiles_.data(), {d + n, d + 2 * n, d + 3 * n}, axes_.get(), axes_.get() + n};
  }

 private:
  std::size_t pixels() const { return static_cast<std::size_t>(rows_) * stride_; }

  const int rows_, stride_;
  const std::unique_ptr<double[]> numbers_;
  const std::unique_ptr<std::uint8_t[]> axes_;
  std::vector<kernels::DepthTile> tiles_;
  const int first_row_, columns_;
};

/** Rows of an image. */
struct RowRange {
  int first, count;
};

/** Fans of four rays of two rows. @param depths of those rows, which come nearer where something is met */
void addFans(const RayScene& scene, const PinholeRays& rays, const RayScene::Query& query, const RowRange& rows, double* depths) {
  constexpr int ROWS = 2, COLUMNS = RayFan::WIDTH / ROWS;
  const int last_row = rows.first + rows.count - 1, last_column = rays.pinhole.width - 1;
  for (int top = rows.first; top <= last_row; top += ROWS)
    for (int left = 0; left <= last_column; left += COLUMNS) {
      const auto row = [&](int ray) { return std::min(top + ray / COLUMNS, last_row); };
      const auto column = [&](int ray) { return std::min(left + ray % COLUMNS, last_column); };
      RayFan fan{rays.X_WS.translation(), {}};
      for (int ray = 0; ray < RayFan::WIDTH; ++ray) fan.directions[ray] = rays.direction(row(ray), column(ray));
      const RayScene::Hits hits = scene.firstHits(fan, query);
      for (int ray = 0; ray < RayFan::WIDTH; ++ray) {
        double& depth = depths[static_cast<std::size_t>(row(ray) - rows.first) * rays.pinhole.width + column(ray)];
        depth = std::min(depth, hits[ray].t);
      }
    }
}

}  // namespace

Vector3 PinholeRays::direction(int row, int column) const {
  return turned(X_WS.linear(),
                {1, -((column - pinhole.middle_u) / pinhole.focal_length), -((row - pinhole.middle_v) / pinhole.focal_length)});
}

DepthScene::DepthScene(std::vector<RayTarget> targets) : others_(notDrawn(targets)) {
  std::copy_if(targets.begin(), targets.end(), std::back_inserter(meshes_), isDrawn);
  has_others_ = meshes_.size() < targets.size();
  for (const RayTarget& mesh : meshes_) {
    X_CW_.push_back(mesh.X_WC.inverse());
    const Box& bounds = mesh.geometry->bounds();
    slacks_.push_back(PLACE_ROUNDING * (bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs())).sum());
  }
}

void DepthScene::drawBand(const PinholeRays& rays, const RayScene::Query& query, int band, double* depths) const {
  const Pinhole& pinhole = rays.pinhole;
  const int first_row = band * BAND_ROWS;
  BandArrays arrays(pinhole, first_row, query.farthest);
  const kernels::DepthBand numbers = arrays.numbers();
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    const CollisionGeometry& geometry = *meshes_[i].geometry;
    const kernels::PixelRays seen = pixelRaysOf(rays, X_CW_[i], query.nearestOf(meshes_[i].model));
    const double slack = slacks_[i] + PLACE_ROUNDING * (std::abs(seen.origin[0]) + std::abs(seen.origin[1]) + std::abs(seen.origin[2]));
    const kernels::PixelMesh mesh{reinterpret_cast<const unsigned char*>(geometry.bvh().nodes().data()), geometry.bvh().order().data(),
                                  geometry.mesh().elements.data()->data(), geometry.mesh().vertices.data()->data(), slack};
    kernels::kernels().drawDepths(mesh, seen, numbers);
  }
  for (int row = 0; row < arrays.rows(); ++row)
    std::transform(arrays.row(row), arrays.row(row) + pinhole.width, depths + static_cast<std::size_t>(row) * pinhole.width,
                   [&](double depth) { return depth <= query.farthest ? depth : NO_DEPTH; });
  if (has_others_) addFans(others_, rays, query, {first_row, arrays.rows()}, depths);
}

}  // namespace blem_sim::contact
