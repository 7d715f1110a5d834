// Tests of many pairs of features at once. One source, compiled for several instruction sets; every one gives the same bits.
#pragma once

#include <vector>

#include "kernels/edge_directions.h"
#include "kernels/edge_records.h"
#include "kernels/rays/pixel_rays.h"
#include "kernels/rays/ray_fan.h"

namespace blem_sim::contact::kernels {

/** One set of kernels. Arrays of hits must have room for as many as there are candidates. */
struct Kernels {
  const char* name;  ///< "avx512", "avx2", "baseline"

  /** out[i] = motion of in[i]; w is kept. */
  void (*turnPoints)(const Vec4* in, std::uint32_t count, const Motion& motion, Vec4* out);
  void (*turnEdges)(const EdgeRecord* in, std::uint32_t count, const Motion& motion, EdgeRecord* out);
  void (*turnFaces)(const FaceRecord* in, std::uint32_t count, const Motion& motion, FaceRecord* out);

  void (*turnLeaf)(const LeafShapes& in, const Motion& motion, LeafShapes* out);

  /** Pairs of features of two leaves that can have a contact within the range while nothing moves or turns by more than it says;
   * conservative, if the reach has room for the rounding of floats. */
  void (*leafContacts)(const LeafShapes& moving, const LeafShapes& fixed, const LeafReach& reach, LeafHits* hits);
  /** The same of edges that pass through faces. */
  void (*leafCrossings)(const LeafShapes& moving, const LeafShapes& fixed, const LeafReach& reach, LeafHits* hits);

  /** Copies, in order, the candidates that can have a contact within the range while nothing moves or turns by more than the reach says.
   * @param inner as them: 1 where the vertex stays over its face and away from its border, else 0 @return their number */
  std::uint32_t (*nearVertexFaces)(const VerticesAtFaces& features, CandidateRun in, const Reach& reach, Candidate* out,
                                   std::uint8_t* inner);
  std::uint32_t (*nearEdgeEdges)(const EdgeRecord* moving, const EdgeRecord* fixed, CandidateRun in, const Reach& reach, Candidate* out);
  std::uint32_t (*nearVertexEdges)(const Vec4* vertices, const EdgeRecord* edges, CandidateRun in, const Reach& reach, Candidate* out);
  std::uint32_t (*nearVertexVertices)(const Vec4* moving, const Vec4* fixed, CandidateRun in, const Reach& reach, Candidate* out);

  /** Candidates with a contact within `range`, and those that need a closer look. Room for one more hit than candidates.
   * @param plain takes those that are plain and not near a border, instead of the hits; null: nothing does @return number of hits */
  std::uint32_t (*vertexFaces)(const VerticesAtFaces& features, const VertexFaceRun& run, double range, PlainContacts* plain,
                               VertexFaceHit* hits);
  /** The contacts within `range` of vertices with the nearest of those sides of faces that they lie outside of. Where witness points are
   * asked for a row has the foot on the side and the normal from the fixed mesh to the moving one, in frame F, and the gap as its depth.
   * @return number of contacts */
  std::uint32_t (*sideFeet)(const ContactPlace& place, const VerticesBesideFaces& features, CandidateRun pairs, double range,
                            FadingContacts* out);
  /** As vertexFaces. */
  std::uint32_t (*edgeEdges)(const EdgeRecord* moving, const EdgeRecord* fixed, CandidateRun run, double range, const EdgeEdgeResults& out);
  /** Candidates, among those that are not plain, with a contact within `range` if nothing takes over, or that need a closer look. Room for
   * one more hit than candidates. */
  std::uint32_t (*fadingEdges)(const EdgeRecord* moving, const EdgeRecord* fixed, CandidateRun run, double range, FadingEdgesHit* hits);
  /** Candidates that need a closer look. @return their number */
  std::uint32_t (*vertexEdges)(const Vec4* vertices, const EdgeRecord* edges, CandidateRun run, double range, VertexEdgeHit* hits);
  /** The same for two vertices; hits are indices of candidates. */
  std::uint32_t (*vertexVertices)(const Vec4* moving, const Vec4* fixed, CandidateRun run, double range, std::uint32_t* hits);
  /** Leading edges among a vertex's edges, in `count` blocks. @param down, aside unit, three numbers each, in the edges' frame */
  LeadingEdges (*leadingEdges)(const EdgeDirections* blocks, int count, const double* down, const double* aside);
  /** Leading edges of vertices that leave faces over their sides: down, to the face, and aside, into it.
   * @param directions of all vertices @param to_vertices turns directions of the faces */
  void (*leadingAtSides)(const EdgeDirections* directions, const FaceRecord* faces, const Motion& to_vertices, const LeavingRun& leaving,
                         LeadingEdges* leading);
  /** Whether an edge has a part along `towards` whose square is larger than `least2`. */
  bool (*leadTo)(const EdgeDirections* blocks, int count, const double* towards, double least2);
  /** Edges that pass through a face's plane where the face may be. */
  std::uint32_t (*edgeFaces)(const EdgeRecord* edges, const FaceRecord* faces, CandidateRun run, std::uint32_t* hits);

  /** Leaves of a tree that the rays of a fan may meet, nearer ones first. @param farthest [FAN] where rays end to count, which the visitor
   * may draw nearer */
  void (*fanLeaves)(const FanTree& tree, const FanRays& fan, double* farthest, const FanVisitor& visitor);
  /** First hits of a fan's rays with the triangles of a mesh, those of geometry::castRay.
   * @return whether elements that are no triangles were near: they are left out */
  bool (*fanTriangles)(const FanMesh& mesh, const FanRays& fan, FanHits* hits);
  /** Draws a mesh of triangles into rows of a depth image: each pixel's depth becomes that of geometry::castRay along its ray, if that is
   * less. */
  void (*drawDepths)(const PixelMesh& mesh, const PixelRays& rays, const DepthBand& band);
};

/** The fastest set that this machine runs; $BLEM_SIM_KERNELS (avx512, avx2, baseline) forces another one.
 * @throws InputError the first time, if that one does not run here: geometry asks when it is made */
const Kernels& kernels();

/** The set of that name; the fastest for none. @throws InputError if it does not run here */
const Kernels& kernelsNamed(const char* name);

/** Sets that this machine runs, fastest first; the last one is "baseline". */
const std::vector<const Kernels*>& availableKernels();

}  // namespace blem_sim::contact::kernels
