// Results of the kernels near edges: plain numbers, the same for every instruction set.
#pragma once

#include "kernels/records.h"

namespace blem_sim::contact::kernels {

/** Data that place contacts of two meshes' edges in the world, and name them. */
struct EdgePlace {
  const int *names_m, *names_f;  ///< of the edges
  Side a;                        ///< the side that is A
  Motion X_WF;
  double layer;         ///< [m] rA + rB
  double shift;         ///< [m] (rB - rA) / 2
  std::uint64_t kinds;  ///< contactId of edges 0
};

/** Contacts of edges that need no closer look, as kernels write them. Room for one more than there are candidates. */
struct PlainEdges {
  EdgePlace place;
  ContactNumbers* rows;
  std::uint32_t count;  ///< so far; they are appended
  double deepest;       ///< [m] their largest depth so far
};

/** Candidates that are not plain, as kernels copy them. Room for one more than there are candidates. */
struct LeftEdges {
  Candidate* pairs;
  std::uint32_t count;  ///< so far; they are appended
};

struct EdgeEdgeHit;

/** Results of edges near edges. Room for one more of each than there are candidates. */
struct EdgeEdgeResults {
  PlainEdges* plain;  ///< takes those that are plain and not near a border, instead of the hits; null: nothing does
  LeftEdges* left;    ///< takes those that are not plain
  EdgeEdgeHit* hits;
};

/** Two edges near each other, feet inside both, not touching, whose common perpendicular points out of their faces. In the frame of the
 * records. */
struct EdgeEdgeHit {
  std::uint32_t candidate;
  double point_m[3], point_f[3], normal[3];  ///< witness points [m]; unit, from the fixed edge to the moving one
  double gap;                                ///< [m]
};

/** Two edges that are not plain. */
struct FadingEdgesHit {
  std::uint32_t candidate;
  bool is_inside;                 ///< the feet lie inside both, but for CLOSED, and more is to be asked: nothing else is told
  bool cones_known;               ///< whether the normal is known to point into none of their faces
  std::int32_t end_m, end_f;      ///< the vertex at the end beyond which the foot lies; -1 if it lies inside
  double point_m[3], point_f[3];  ///< [m] witness points
  double distance, gap;           ///< [m] of these; and with the depth that is lost beyond the ends
  double normal[3];               ///< unit, from the fixed edge to the moving one, square to both edges
};

/** A vertex near an edge, over none of its first two faces. */
struct VertexEdgeHit {
  std::uint32_t candidate;
  double offset[3];  ///< [m] of the vertex from the edge's line
};

}  // namespace blem_sim::contact::kernels
