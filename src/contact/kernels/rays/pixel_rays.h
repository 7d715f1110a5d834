// Rays through the pixels of a pinhole camera, and the image they make: plain numbers, the same for every instruction set.
#pragma once

#include <cstdint>

namespace blem_sim::contact::kernels {

/** A pinhole that looks along x of its own frame, z is up; whole numbers of pixels are their middles. */
struct PixelRays {
  double R_WS[9], R_CW[9];                  ///< camera to world to the mesh's frame, row by row: directions take both turns
  double origin[3];                         ///< [m] in the mesh's frame
  double focal_length, middle_u, middle_v;  ///< [pixels]
  double nearest;                           ///< [m] depth where all rays begin to count
};

/** Elements of a mesh below a tree's leaves. */
struct PixelMesh {
  const unsigned char* nodes;  ///< of a geometry::Bvh, as they lie in memory
  const std::uint32_t* order;
  const int* elements;     ///< three indices each
  const double* vertices;  ///< [m] three coordinates each
  double slack;            ///< [m] rounding of a place as the camera sees it, at most
};

constexpr int TILE = 8;        // columns and rows of a tile; images lie in rows of whole tiles
constexpr int MIXED_AXES = 3;  // of pixels side by side

/** Depths below a tile's pixels. */
struct DepthTile {
  double farthest;       ///< [m] no pixel's depth is larger
  std::uint32_t writes;  ///< groups of pixels that came nearer since then
};

/** Rows of an image that are drawn together. Arrays have rows * stride numbers. */
struct DepthBand {
  int first_row, rows;      ///< of the image
  int columns, stride;      ///< the latter in whole tiles
  double* depths;           ///< [m] first hit so far, less than which counts
  DepthTile* tiles;         ///< row by row
  double* shears[3];        ///< room for what the rays' directions make of a mesh [Woop 2013]
  std::uint8_t* axes;       ///< room for each ray's longest coordinate
  std::uint8_t* tile_axes;  ///< room for that of TILE pixels side by side, or MIXED_AXES
};

}  // namespace blem_sim::contact::kernels
