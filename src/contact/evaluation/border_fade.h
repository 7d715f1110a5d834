// A vertex that has left a plane over its border, where nothing takes the contact over: it fades instead of vanishing.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/geometry/roomy.h"
#include "features/mesh_pair.h"
#include "kept/candidate_lists.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** Hits of some candidates. */
struct VertexFaceHits {
  const kernels::Candidate* candidates;
  const kernels::VertexFaceHit* data;
  std::uint32_t count;
};

/** Vertices beside faces whose contacts fade. */
struct BesideFaces {
  std::vector<kernels::Candidate> pairs;
  std::vector<kernels::BesideSides> sides;  ///< per pair: the sides that the vertex lies outside of

  void resize(std::size_t size) {
    geometry::resizeRoomy(size, &pairs);
    geometry::resizeRoomy(size, &sides);
  }
};

/** Questions about vertices that may leave, and their answers: room that only grows. */
struct LeavingBuffers {
  std::vector<kernels::LeavingSide> questions;
  std::uint32_t question_count = 0;
  std::vector<kernels::LeadingEdges> answers;
  std::vector<std::uint8_t> fades;  ///< per pair

  void makeRoom(std::size_t pairs) {
    if (fades.size() >= pairs) return;
    geometry::resizeRoomy(3 * pairs, &questions);
    geometry::resizeRoomy(3 * pairs, &answers);
    geometry::resizeRoomy(pairs, &fades);
  }
};

/**
 * Vertices beside faces, by the records of lists of candidates. Over a border that is convex an exact successor is there (vertex-edge,
 * edge-edge) unless the vertex's own surface comes closer to the plane away from it; over a concave border there is none.
 */
class BorderFades {
 public:
  BorderFades(const MeshPair& pair, CandidateLists* lists, SurroundingsMemory* surroundings)
      : pair_(pair), lists_(*lists), surroundings_(*surroundings), R_FM_(pair.X_FM.linear()), R_MF_(R_FM_.transpose()) {}

  /** Lists, in order, those of the hits that fade: nothing takes over behind one of the sides that the vertex lies outside of, and neither
   * the plane, behind one of them, nor a round edge is asked instead. */
  void list(Side side, const VertexFaceHits& hits, LeavingBuffers* buffers, BesideFaces* fading);

 private:
  void listOpen(Side side, const VertexFaceHits& hits, LeavingBuffers* buffers, BesideFaces* fading);
  void answer(Side side, LeavingBuffers* buffers, const BesideFaces& fading);
  bool isTakenOver(Side side, const kernels::Candidate& c, const kernels::LeavingSide& leaving);

  const MeshPair& pair_;
  CandidateLists& lists_;
  SurroundingsMemory& surroundings_;
  const Matrix3 R_FM_, R_MF_;
};

}  // namespace blem_sim::contact
