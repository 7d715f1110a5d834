// Depth images of meshes: triangles are drawn pixel by pixel, each pixel's ray by the arithmetic of geometry::castRay, bit by bit.
// Included by kernels_code.h only.
#pragma once

#include "kernels/rays/depth_bands.h"

namespace blem_sim::contact::kernels {
namespace {

/** Draws the triangles of a mesh, nearer ones first; leaves out what lies outside of the image or behind what is drawn. */
class TriangleDrawing {
 public:
  TriangleDrawing(const PixelMesh& mesh, const PixelRays& rays, const DepthBand& band)
      : mesh_(mesh), rays_(rays), band_(band), pixels_(band), plane_(rays, mesh), tiles_(band) {}

  void draw() {
    const FanNode root = node(0);
    const PixelPlane::Boxes boxes = plane_.boxesOf(root, root);
    push(0, boxes, 0, pixels_.all());
    if (depth_ == 0) return;
    PixelShears(rays_, band_).fill(stack_[0].range);
    while (depth_ > 0) {
      const Entry entry = stack_[--depth_];
      if (tiles_.hide(entry.range, entry.near)) continue;
      const FanNode at = node(entry.node);
      if (at.count != 0)
        drawLeaf(at, entry);
      else
        pushChildren(at.first, entry.range);
    }
  }

 private:
  static constexpr int PIXELS_PER_TRIANGLE =
      8;  // up to which each pixel takes all triangles of a leaf, instead of each triangle its pixels

  struct Entry {
    std::uint32_t node;
    double near;  // [m] ahead
    PixelRange range;
  };

  FanNode node(std::uint32_t index) const {
    FanNode node;
    __builtin_memcpy(&node, mesh_.nodes + sizeof node * index, sizeof node);
    return node;
  }

  void pushChildren(std::uint32_t first, const PixelRange& range) {
    const PixelPlane::Boxes boxes = plane_.boxesOf(node(first), node(first + 1));
    const std::uint32_t nearer = boxes.near[1] < boxes.near[0];
    push(first + 1 - nearer, boxes, static_cast<int>(1 - nearer), range);
    push(first + nearer, boxes, static_cast<int>(nearer), range);
  }

  void push(std::uint32_t index, const PixelPlane::Boxes& boxes, int which, const PixelRange& within) {
    if (boxes.far[which] < rays_.nearest) return;
    const PixelRange range = plane_.pixelsOf(boxes, which, within);
    if (!range.empty()) stack_[depth_++] = {index, boxes.near[which], range};
  }

  void drawLeaf(const FanNode& leaf, const Entry& entry) {
    const bool few = entry.range.count() <= PIXELS_PER_TRIANGLE * static_cast<int>(leaf.count);
    for (std::uint32_t done = 0; done < leaf.count; done += LANES) {
      const int count = static_cast<int>(leaf.count - done < LANES ? leaf.count - done : LANES);
      Vectors corners[3];
      gather(leaf.first + done, count, &corners);
      if (few)
        meetPixels(corners, entry);
      else
        drawTriangles(corners, count, entry.range);
    }
  }

  /** Corners of triangles as they lie in the tree's order, seen from the origin; the last one fills the lanes that are left. */
  void gather(std::uint32_t first, int count, Vectors (*corners)[3]) const {
    double numbers[3][3][LANES];  // by corner and coordinate
    for (int lane = 0; lane < LANES; ++lane) {
      const int* const e =
          mesh_.elements + 3 * std::int64_t{mesh_.order[first + static_cast<std::uint32_t>(lane < count ? lane : count - 1)]};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) numbers[i][k][lane] = mesh_.vertices[3 * std::int64_t{e[i]} + k];
    }
    for (int i = 0; i < 3; ++i) {
      const auto seen = [&](int k) { return BandPixels::read(numbers[i][k]) - rays_.origin[k]; };
      (*corners)[i] = {seen(0), seen(1), seen(2)};
    }
  }

  /** Each ray of a few pixels with all triangles at once, if it may meet one. */
  void meetPixels(const Vectors (&corners)[3], const Entry& entry) {
    const PixelRange& range = entry.range;
    PixelPlane::Sides sides;
    plane_.sidesOf(corners, range, &sides);
    for (int row = range.rows.first; row <= range.rows.last; ++row) {
      LaneFloats rest[3];
      for (int i = 0; i < 3; ++i) rest[i] = sides.v[i] * static_cast<float>(row - range.rows.first) + sides.rest[i];
      const double* const depths = band_.depths + pixels_.placeOf(row, 0);
      for (int column = range.columns.first; column <= range.columns.last; ++column) {
        const auto distance = [&](int i) { return sides.u[i] * static_cast<float>(column - range.columns.first) + rest[i]; };
        if (bitsNotNegative(smaller(smaller(distance(0), distance(1)), distance(2))) == 0) continue;
        if (depths[column] >= entry.near) meetPixel(corners, row, column);
      }
    }
  }

  void meetPixel(const Vectors (&corners)[3], int row, int column) {
    const int place = pixels_.placeOf(row, column), axis = band_.axes[place];
    const auto alongAxes = [&](int i) {
      const Vectors& c = corners[i];
      return axis == 0 ? Vectors{c.y, c.z, c.x} : axis == 1 ? Vectors{c.z, c.x, c.y} : c;
    };
    const auto shear = [&](int k) { return all(band_.shears[k][place]); };
    Doubles there = all(0);
    const Mask passes = passThrough({shear(0), shear(1), shear(2)}, {alongAxes(0), alongAxes(1), alongAxes(2)}, &there);
    if (bitsOf(passes) == 0) return;
    double& first = band_.depths[place];
    const unsigned takes = bitsOf(passes & (there >= rays_.nearest) & (there < first));
    if (takes == 0) return;
    for (int lane = 0; lane < LANES; ++lane)
      if (takes >> lane & 1 && there[lane] < first) first = there[lane];
    tiles_.wrote(row, column);
  }

  void drawTriangles(const Vectors (&corners)[3], int count, const PixelRange& within) {
    PixelPlane::Triangle triangles[LANES];
    plane_.trianglesOf(corners, triangles);
    for (int lane = 0; lane < count; ++lane) {
      if (triangles[lane].far < rays_.nearest) continue;
      const PixelRange range = plane_.pixelsOf(triangles[lane], within);
      if (!range.empty()) drawTriangle(corners, lane, TriangleRows(triangles[lane], range), range);
    }
  }

  void drawTriangle(const Vectors (&corners)[3], int lane, const TriangleRows& rows, const PixelRange& range) {
    double one[3][3];
    for (int i = 0; i < 3; ++i) {
      one[i][0] = corners[i].x[lane];
      one[i][1] = corners[i].y[lane];
      one[i][2] = corners[i].z[lane];
    }
    for (int row = range.rows.first; row <= range.rows.last; ++row)
      pixels_.visitGroups(rows.row(row), [&](int place) { meetGroup(one, row, place); });
  }

  /** One triangle with as many pixels as there are lanes. */
  void meetGroup(const double (&corners)[3][3], int row, int place) {
    const std::uint8_t axis = band_.tile_axes[place / TILE];
    if (axis != MIXED_AXES) return meetAlong(axis, ~Mask{}, corners, row, place);
    for (int each = 0; each < 3; ++each) {
      Mask along;
      for (int i = 0; i < LANES; ++i) along[i] = -(band_.axes[place + i] == each);
      if (bitsOf(along) != 0) meetAlong(each, along, corners, row, place);
    }
  }

  /** @param rays of the group that are longest along the axis */
  void meetAlong(int axis, const Mask& rays, const double (&corners)[3][3], int row, int place) {
    const int kx = (axis + 1) % 3, ky = (axis + 2) % 3;
    const auto corner = [&](int i) { return Corner<double>{corners[i][kx], corners[i][ky], corners[i][axis]}; };
    const auto shear = [&](int k) { return BandPixels::read(band_.shears[k] + place); };
    Doubles there = all(0);
    const Mask passes = rays & passThrough({shear(0), shear(1), shear(2)}, {corner(0), corner(1), corner(2)}, &there);
    if (bitsOf(passes) == 0) return;
    const Doubles first = BandPixels::read(band_.depths + place);
    const Mask takes = passes & (there >= rays_.nearest) & (there < first);
    if (bitsOf(takes) == 0) return;
    BandPixels::write(takes ? there : first, band_.depths + place);
    tiles_.wrote(row, place % band_.stride);
  }

  const PixelMesh& mesh_;
  const PixelRays& rays_;
  const DepthBand& band_;
  const BandPixels pixels_;
  const PixelPlane plane_;
  DepthTiles tiles_;
  Entry stack_[DEEPEST_TREE + 2];
  int depth_ = 0;
};

void drawDepths(const PixelMesh& mesh, const PixelRays& rays, const DepthBand& band) { TriangleDrawing(mesh, rays, band).draw(); }

}  // namespace
}  // namespace blem_sim::contact::kernels
