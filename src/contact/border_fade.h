// A vertex that has left a plane over its border, where nothing takes the contact over: it fades instead of vanishing.
#pragma once

#include <vector>

#include "candidate_lists.h"
#include "mesh_pair.h"
#include "surroundings.h"

namespace blem_sim {

/**
 * Vertices beside faces, by the records of lists of candidates. Over a border that is convex an exact successor is there (vertex-edge,
 * edge-edge) unless the vertex's own surface comes closer to the plane away from it; over a concave border there is none.
 */
class BorderFades {
 public:
  BorderFades(const MeshPair& pair, const CandidateLists* lists, SurroundingsMemory* surroundings)
      : pair_(pair), lists_(*lists), surroundings_(*surroundings), R_FM_(pair.X_FM.linear()), R_MF_(R_FM_.transpose()) {}

  /** Does nothing take over behind one of the sides that the vertex lies outside of, and is neither the plane, behind one of them, nor a
   * round edge asked instead? @param c vertex and face of the lists @param hit theirs */
  bool fades(bool vertex_moves, const kernels::Candidate& c, const kernels::VertexFaceHit& hit);

 private:
  bool leaves(bool vertex_moves, const kernels::Candidate& c, int k, bool is_above);

  const MeshPair& pair_;
  const CandidateLists& lists_;
  SurroundingsMemory& surroundings_;
  const Matrix3 R_FM_, R_MF_;
};

}  // namespace blem_sim
