// Closes cracks and flattens nearly planar patches, so that contact does not depend on how a mesh is broken.
#pragma once

#include "blem_sim/geometry/mesh_topology.h"
#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** Changes that mendMesh made. */
struct MeshMending {
  int cracks = 0;           ///< pairs of border edges joined end to end
  double widest_crack = 0;  ///< [m] largest distance between ends that were joined
  int split_edges = 0;      ///< border edges split where corners of other triangles lie on them (T-junctions)
  bool given_up = false;    ///< T-junctions stay: too many border edges lie across each other to look at all pairs
  int planes = 0;           ///< nearly planar patches made planar
  int flattened = 0;        ///< vertices moved for that
  double farthest = 0;      ///< [m] the longest such move
};

/** Ends of border edges this close [m] may be joined: cracks of +-10 um in each coordinate, 35 um at most, with some air. */
constexpr double CRACK_WIDTH = 4e-5;

/**
 * A patch is taken as a plane if no vertex is farther from it than this [m]: cracks of +-10 um with the tilt of a fitted plane. Far below
 * the least that sensors see (0.5 mm) and the width of layers (mm), so that no relief that matters goes.
 */
constexpr double PLANE_DEVIATION = 2e-5;

/**
 * Mends a mesh that cleanMesh has left:
 * - cracks: border edges (one triangle each) that lie side by side within CRACK_WIDTH and a quarter of their length are joined where their
 *   ends meet, unless their triangles lie on one another (two sheets), share two corners (a ribbon), or have nearer partners; joined
 *   vertices go to the mean of their places;
 * - T-junctions: a border edge along which such a partner begins or ends is split there;
 * - planes: a patch of triangles that bend by no more than PLANE_DEVIATION explains, ends at true creases (not gradually, as a curved
 *   surface does), does not bulge (findCurved: heights that change smoothly, not from vertex to vertex as noise does), lies within
 *   PLANE_DEVIATION and 1/500 of its width of its least-squares plane, is moved onto it, a vertex of several such planes to their
 *   intersection; by at most 2 PLANE_DEVIATION, else the patch stays as it is.
 *
 * A mesh that is whole and flat (MeshTopology::FLAT_SINE), or curved, comes back bit-identical. Deterministic; the surface does not
 * depend on the order of vertices and triangles but for rounding.
 * @param report of cleanMesh: counts and extents are brought up to date; may be null @param what may be null
 * @param topology of the mesh that comes back, which mending has at hand; may be null
 */
TriangleMesh mendMesh(TriangleMesh mesh, MeshReport* report, MeshMending* what = nullptr, MeshTopology* topology = nullptr);

}  // namespace blem_sim::geometry
