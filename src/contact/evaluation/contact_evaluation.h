// Evaluation of candidates: their contacts and crossings.
#pragma once

#include <algorithm>
#include <vector>

#include "blem_sim/geometry/roomy.h"
#include "evaluation/border_fade.h"
#include "evaluation/close_contacts.h"
#include "evaluation/edge_crossing.h"
#include "evaluation/exact_tests.h"
#include "features/mesh_pair.h"
#include "kept/candidate_lists.h"

namespace blem_sim::contact {

/** Contacts and crossings that a search finds. */
struct EvaluatedContacts {
  ContactWriter plain;       ///< in the world; each in a place of its own; none where meshes cross
  double deepest_plain = 0;  ///< [m] largest depth of the plain ones
  CloseContacts close;       ///< the others
  std::vector<Crossing> crossings;

  void clear();                                 ///< all but `plain`
  double leastGap(const MeshPair& pair) const;  ///< [m]; the pair's range if there is none
};

/** Cover of a contact that fades, one of asked_fading. */
struct FadingCover {
  std::uint32_t before;  ///< index of the one before it of the same vertex
  bool is_covered;       ///< the vertex lies over another face of the plane
};

/** Buffers of evaluations: room that only grows. */
struct EvaluationBuffers {
  static constexpr std::uint32_t BLOCK = 256;  ///< candidates that are tested at once: there is room for contacts of all

  explicit EvaluationBuffers(SurroundingsMemory* surroundings) : surroundings(*surroundings) {}

  SurroundingsMemory& surroundings;
  TurnedFeatures turned;
  std::vector<kernels::VertexFaceHit> vertex_faces;
  std::vector<kernels::VertexEdgeHit> vertex_edges;
  std::vector<kernels::EdgeEdgeHit> edge_edges;
  std::vector<kernels::Candidate> edges_left;  ///< those that are not plain
  std::uint32_t edges_left_count = 0;          ///< their number
  std::vector<kernels::FadingEdgesHit> fading_edges;
  std::vector<std::uint32_t> hits;
  std::vector<kernels::Candidate> over;   ///< vertices over faces beside which they may fade, or so near a border that they were asked
  std::vector<kernels::Candidate> asked;  ///< vertices that may be over such faces
  LeavingBuffers leaving;
  BesideFaces fading;
  std::vector<kernels::ContactNumbers> feet;         ///< per pair that fades
  std::vector<kernels::FadingContact> asked_fading;  ///< those that may be covered
  std::vector<FadingCover> covers;                   ///< per contact of asked_fading
  std::vector<std::uint32_t> last_fading;            ///< per vertex: the last one of asked_fading; none between evaluations

  template <typename Items, typename... Item>
  static void makeRoom(std::size_t size, Items* items, const Item&... filled_with) {
    if (items->size() < size) geometry::resizeRoomy(size, items, filled_with...);
  }
};

/** Turns candidates into contacts. */
class Evaluation {
 public:
  /** @param pairs of the lists, all or those that matter; the features of the lists must have been turned */
  Evaluation(const MeshPair& pair, CandidateLists* lists, const CandidatePairs& pairs, EvaluationBuffers* buffers, EvaluatedContacts* found)
      : pair_(pair),
        lists_(*lists),
        pairs_(pairs),
        buffers_(*buffers),
        found_(*found),
        exact_(pair, &buffers->surroundings, &found->close),
        fades_(pair, lists, &buffers->surroundings) {}

  /** Finds all contacts. Crossings must be known before: where meshes cross, all contacts are close ones. */
  void findContacts();
  void findCrossings();

 private:
  std::uint32_t* room(const std::vector<kernels::Candidate>& candidates);
  /** Calls test(first candidate, their number, hits) for blocks of candidates, which writes to plain. @return number of hits in all */
  template <typename Hit, typename Plain, typename Test>
  std::uint32_t testBlocks(std::size_t candidates, std::vector<Hit>* hits, Plain* plain, Test&& test);
  template <typename Visit>
  void forEachHit(const std::vector<kernels::Candidate>& candidates, std::uint32_t count, Visit&& visit) const;

  void vertexFaces(Side side);
  std::uint32_t findVertexFaces(Side side);
  kernels::ContactPlace place(Side side) const;
  void addPlain(Side side, const kernels::Candidate& c, double height);
  std::uint32_t addFading(Side side);
  void addFeet(Side side);
  void dropCovered(Side side, std::uint32_t count);
  void listCovering(Side side);
  template <typename Visit>
  void forEachBeside(Side side, const kernels::Candidate& c, Visit&& visit);
  std::uint32_t findEdgeEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed);
  void fadingEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed);
  void edgeEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed);
  void vertexEdges(Side side, const kernels::Vec4* vertices, const kernels::EdgeRecord* edges);
  void vertexVertices(const kernels::Vec4* moving, const kernels::Vec4* fixed);

  const MeshPair& pair_;
  CandidateLists& lists_;
  const CandidatePairs& pairs_;
  EvaluationBuffers& buffers_;
  EvaluatedContacts& found_;
  ExactTests exact_;
  BorderFades fades_;
};

template <typename Hit, typename Plain, typename Test>
std::uint32_t Evaluation::testBlocks(std::size_t candidates, std::vector<Hit>* hits, Plain* plain, Test&& test) {
  constexpr std::uint32_t BLOCK = EvaluationBuffers::BLOCK;
  const auto total = static_cast<std::uint32_t>(candidates);
  EvaluationBuffers::makeRoom(total + 1, hits);
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < total; first += BLOCK) {
    const std::uint32_t size = std::min(BLOCK, total - first);
    Hit* const block = hits->data() + count;
    plain->rows = found_.plain.rows(size + 1);
    plain->count = 0;
    const std::uint32_t found = test(first, size, block);
    for (std::uint32_t i = 0; i < found; ++i) block[i].candidate += first;
    count += found;
    found_.plain.advance(plain->count);
  }
  found_.deepest_plain = plain->deepest;
  return count;
}

}  // namespace blem_sim::contact
