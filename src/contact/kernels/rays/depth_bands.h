// Rows of a depth image while meshes are drawn into them. Included by kernels_code.h only.
#pragma once

#include "kernels/rays/pixel_plane.h"

namespace blem_sim::contact::kernels {
namespace {

template <typename Number>
inline VectorsOf<Number> turned(const double (&R)[9], const VectorsOf<Number>& d) {
  return {R[0] * d.x + R[1] * d.y + R[2] * d.z, R[3] * d.x + R[4] * d.y + R[5] * d.z, R[6] * d.x + R[7] * d.y + R[8] * d.z};
}

/** Places of pixels in a band's arrays, in groups of as many as a vector has. */
class BandPixels {
 public:
  explicit BandPixels(const DepthBand& band) : band_(band) {}

  int placeOf(int row, int column) const { return (row - band_.first_row) * band_.stride + column; }
  PixelRange all() const { return {{0, band_.columns - 1}, {band_.first_row, band_.first_row + band_.rows - 1}}; }

  /** Calls visit(place) for each group that has pixels of a row's range. */
  template <typename Visit>
  void visitGroups(const PixelRange& row, Visit&& visit) const {
    for (int column = row.columns.first / LANES * LANES; column <= row.columns.last; column += LANES)
      visit(placeOf(row.rows.first, column));
  }

  static Doubles read(const double* from) {
    Doubles v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
  }
  static void write(const Doubles& v, double* to) { __builtin_memcpy(to, &v, sizeof v); }

 private:
  const DepthBand& band_;
};

/** The farthest depth below any pixel of a range, from tiles. */
class DepthTiles {
 public:
  explicit DepthTiles(const DepthBand& band) : band_(band), row_of_tiles_(band.stride / TILE) {}

  void wrote(int row, int column) { ++at((row - band_.first_row) / TILE, column / TILE).writes; }

  /** Whether all pixels of a small range are nearer than something. */
  bool hide(const PixelRange& range, double near) {
    if (range.count() <= FEW) return allNearer(range, near);
    const int left = range.columns.first / TILE, right = range.columns.last / TILE;
    const int top = (range.rows.first - band_.first_row) / TILE, bottom = (range.rows.last - band_.first_row) / TILE;
    if ((right - left + 1) * (bottom - top + 1) > LARGEST) return false;
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        if (!(farthest(y, x, near) < near)) return false;
    return true;
  }

 private:
  static constexpr int FEW = 16;                   // [pixels] of a range that are looked at one by one
  static constexpr int LARGEST = 16;               // [tiles] of a range that is looked at
  static constexpr std::uint32_t MANY_WRITES = 8;  // after which it pays to look at a tile again

  bool allNearer(const PixelRange& range, double near) const {
    for (int row = range.rows.first; row <= range.rows.last; ++row) {
      const double* const depths = band_.depths + (row - band_.first_row) * band_.stride;
      for (int column = range.columns.first; column <= range.columns.last; ++column)
        if (!(depths[column] < near)) return false;
    }
    return true;
  }
  DepthTile& at(int y, int x) { return band_.tiles[y * row_of_tiles_ + x]; }
  double farthest(int y, int x, double near) {
    DepthTile& tile = at(y, x);
    if (tile.farthest < near || tile.writes < MANY_WRITES) return tile.farthest;
    const int rows = band_.rows - y * TILE < TILE ? band_.rows - y * TILE : TILE;
    Doubles most = all(0);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < TILE; column += LANES)
        most = maximum(most, BandPixels::read(band_.depths + (y * TILE + row) * band_.stride + x * TILE + column));
    tile = {most[0], 0};
    for (int i = 1; i < LANES; ++i)
      if (most[i] > tile.farthest) tile.farthest = most[i];
    return tile.farthest;
  }

  const DepthBand& band_;
  const int row_of_tiles_;
};

/** Rays of a range of pixels, sheared along their longest coordinate in the mesh's frame. */
class PixelShears {
 public:
  PixelShears(const PixelRays& rays, const DepthBand& band) : rays_(rays), band_(band), pixels_(band) {}

  void fill(const PixelRange& range) const {
    for (int row = range.rows.first; row <= range.rows.last; ++row) {
      const double down = (row - rays_.middle_v) / rays_.focal_length;
      for (int column = range.columns.first / TILE * TILE; column <= range.columns.last; column += TILE) {
        unsigned axes = 0;
        for (int part = 0; part < TILE; part += LANES) axes |= fillGroup(down, column + part, pixels_.placeOf(row, column + part));
        band_.tile_axes[pixels_.placeOf(row, column) / TILE] = AXIS_OF_BITS[axes];
      }
    }
  }

 private:
  static constexpr std::uint8_t AXIS_OF_BITS[8] = {0, 0, 1, MIXED_AXES, 2, MIXED_AXES, MIXED_AXES, MIXED_AXES};

  /** @return a bit for each axis that is a ray's longest */
  unsigned fillGroup(double down, int column, int place) const {
    Doubles columns;
    for (int i = 0; i < LANES; ++i) columns[i] = column + i;
    const Vectors d_S{all(1), -((columns - rays_.middle_u) / rays_.focal_length), all(-down)};
    const Vectors d = turned(rays_.R_CW, turned(rays_.R_WS, d_S));
    const Doubles x = absolute(d.x), y = absolute(d.y), z = absolute(d.z);
    const Mask by_z = z > maximum(x, y), by_y = ~by_z & (y > x);
    const Doubles dx = by_z ? d.x : by_y ? d.z : d.y, dy = by_z ? d.y : by_y ? d.x : d.z, dz = by_z ? d.z : by_y ? d.y : d.x;
    BandPixels::write(dx / dz, band_.shears[0] + place);
    BandPixels::write(dy / dz, band_.shears[1] + place);
    BandPixels::write(1 / dz, band_.shears[2] + place);
    const unsigned bits_z = bitsOf(by_z), bits_y = bitsOf(by_y);
    for (int i = 0; i < LANES; ++i) band_.axes[place + i] = static_cast<std::uint8_t>(bits_z >> i & 1 ? 2 : bits_y >> i & 1);
    const unsigned lanes = (1u << LANES) - 1;
    return ((bits_z | bits_y) != lanes) | (bits_y != 0) << 1 | (bits_z != 0) << 2;
  }

  const PixelRays& rays_;
  const DepthBand& band_;
  const BandPixels pixels_;
};

}  // namespace
}  // namespace blem_sim::contact::kernels
