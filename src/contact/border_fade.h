// A vertex that has left a plane over its border, where nothing takes the contact over: it fades instead of vanishing.
#pragma once

#include <vector>

#include "candidate_lists.h"
#include "mesh_pair.h"
#include "surroundings.h"

namespace blem_sim {

/** Where a contact that fades is. */
struct BorderFade {
  Vector3 foot;  ///< closest point of the face, on its plane's border; frame F
  double lost;   ///< [m] of depth
};

/**
 * Vertices beside faces, by the records of lists of candidates. Over a border that is convex an exact successor is there (vertex-edge,
 * edge-edge) unless the vertex's own surface comes closer to the plane away from it; over a concave border there is none.
 */
class BorderFades {
 public:
  BorderFades(const MeshPair& pair, const CandidateLists* lists, SurroundingsMemory* surroundings)
      : pair_(pair), lists_(*lists), surroundings_(*surroundings), R_FM_(pair.X_FM.linear()), R_MF_(R_FM_.transpose()) {}

  /**
   * @param c vertex and face of the lists @param hit theirs @param p the vertex in the face's mesh's frame
   * @return false if p projects into the plane, or has a successor
   */
  bool find(bool vertex_moves, const kernels::Candidate& c, const kernels::VertexFaceHit& hit, const Vector3& p, BorderFade* out);

 private:
  bool fades(bool vertex_moves, const kernels::Candidate& c, const kernels::VertexFaceHit& hit);
  bool leaves(bool vertex_moves, const kernels::Candidate& c, int k, bool is_above);

  const MeshPair& pair_;
  const CandidateLists& lists_;
  SurroundingsMemory& surroundings_;
  const Matrix3 R_FM_, R_MF_;
};

}  // namespace blem_sim
