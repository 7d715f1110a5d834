#include "candidate_lists.h"

#include <algorithm>

#include "blem_sim/geometry/bvh_traversal.h"
#include "feature_cones.h"
#include "tolerances.h"
#include "vectors.h"

namespace blem_sim {
namespace {

using kernels::Candidate;
using kernels::LeafHit;

/** Rounding of float coordinates and of what is reckoned with them, relative to the largest one. */
constexpr double FLOAT_ROUNDING = 1e-6;
/** And of directions: unit vectors, and products of edges relative to their lengths. */
constexpr double FLOAT_TURN = 1e-5;

class Search {
 public:
  Search(const MeshPair& pair, double reach, CandidateSearchBuffers* buffers, CandidateLists* lists)
      : pair_(pair), motion_(motionOf(pair.X_FM)), reach_(reach), buffers_(*buffers), lists_(*lists), search_(++buffers->searches) {
    lists->clear();
  }

  /** Calls visit(moving leaf, fixed leaf) for the leaves within reach. */
  template <typename Visit>
  void forEachLeafPair(Visit&& visit) {
    const auto matters = [this](std::uint32_t m, std::uint32_t f) { return (pair_.moving.owners[m] | pair_.fixed.owners[f]) != 0; };
    visitLeafPairsIf(pair_.moving.bvh, pair_.fixed.bvh, pair_.X_FM, reach_ + rounding(), matters, [&](std::uint32_t m, std::uint32_t f) {
      visit(buffers_.leaves.moving(pair_.moving, m, search_, motion_), buffers_.leaves.standing(pair_.fixed, f, search_));
    });
  }

  /** With room for the rounding of floats. */
  kernels::LeafReach leafReach(const ListMargin& margin) const {
    const double wider = margin.motion + rounding();
    return {static_cast<float>(reach_ - margin.motion + wider), static_cast<float>(wider), static_cast<float>(margin.turn + FLOAT_TURN),
            static_cast<float>(deepestInside(reach_) + wider)};
  }

  // Where a feature of a leaf is among the near ones of its mesh.
  std::uint32_t vertex(bool moves, LeafFeatures* leaf, std::uint32_t i) {
    return slot(moves, &leaf->vertex_slots[i], &lists_.near[moves].vertices, leaf->vertices[i], vertexRecord);
  }
  std::uint32_t edge(bool moves, LeafFeatures* leaf, std::uint32_t i) {
    return slot(moves, &leaf->edge_slots[i], &lists_.near[moves].edges, leaf->edges[i], edgeRecord);
  }
  std::uint32_t face(bool moves, LeafFeatures* leaf, std::uint32_t i) {
    NearFeatures& near = lists_.near[moves];
    if (leaf->face_slots[i] == LeafFeatures::NO_SLOT) {
      near.patches.push_back(pair_.side(moves).topology.patchOf(leaf->faces[i]));
      near.open.push_back(leaf->shapes.open[i]);
    }
    return slot(moves, &leaf->face_slots[i], &near.faces, leaf->faces[i], faceRecord);
  }

  /** Appends visit(i, j) for the features i of the moving leaf and j of the fixed one. */
  template <typename Visit>
  static void append(const LeafHit* hits, int count, std::vector<Candidate>* candidates, Visit&& visit) {
    for (int h = 0; h < count; ++h) {
      for (std::uint32_t bits = hits[h].bits; bits != 0; bits &= bits - 1)
        candidates->push_back(visit(hits[h].feature, static_cast<std::uint32_t>(__builtin_ctz(bits))));
    }
  }

 private:
  double rounding() const {
    const double largest = std::max(pair_.fixed.bounds.min().cwiseAbs().maxCoeff(), pair_.fixed.bounds.max().cwiseAbs().maxCoeff());
    return FLOAT_ROUNDING * (largest + reach_) + 3 * CLOSED;
  }

  template <typename Record>
  std::uint32_t slot(bool moves, std::uint32_t* slot, FeatureRecords<Record>* features, int name, Record (*record)(const MeshSide&, int)) {
    if (*slot == LeafFeatures::NO_SLOT) *slot = features->add(record(pair_.side(moves), name), name);
    return *slot;
  }

  const MeshPair& pair_;
  const kernels::Motion motion_;
  const double reach_;
  CandidateSearchBuffers& buffers_;
  CandidateLists& lists_;
  const std::uint64_t search_;
};

/** Drops pairs of vertices that have no contact, however they move by the margin [m]: those that lead towards each other, or where one does
 * and the other, nearer than its surroundings, is not round. */
void dropLeading(const MeshPair& pair, double margin, NearFeatures (&near)[2], std::vector<Candidate>* vertices) {
  const double limit = CONE_SLACK * (pair.range + margin) + margin;
  const auto leads = [&](const NearFeatures& features, const VertexRing& ring, const Vector3& d) {
    for (std::uint32_t i = ring.begin; i < ring.end; ++i)
      if (vector3(features.ring_directions[i]).dot(d) > limit) return true;
    return false;
  };
  const auto hasNone = [&](const Candidate& c) {
    const Vector3 d = vector3(near[0].vertices.records[c.b]) - pair.X_FM * vector3(near[1].vertices.records[c.a]);
    const VertexRing moving = near[1].ring(pair.moving, c.a), fixed = near[0].ring(pair.fixed, c.b);
    const bool moving_leads = leads(near[1], moving, pair.X_FM.linear().transpose() * d), fixed_leads = leads(near[0], fixed, -d);
    if (moving_leads && fixed_leads) return true;
    return (moving_leads && !near[0].isRound(pair.fixed, c.b)) || (fixed_leads && !near[1].isRound(pair.moving, c.a));
  };
  vertices->erase(std::remove_if(vertices->begin(), vertices->end(), hasNone), vertices->end());
}

}  // namespace

VertexRing& NearFeatures::ring(const MeshSide& side, std::uint32_t vertex) {
  if (rings_.size() < vertices.names.size()) rings_.resize(vertices.names.size());
  VertexRing& found = rings_[vertex];
  if (found.end != 0) return found;
  const MeshTopology& topology = side.topology;
  const int name = vertices.names[vertex];
  found.begin = static_cast<std::uint32_t>(ring_directions.size());
  for (const int edge : topology.edgesOf(name)) {
    const int other = topology.otherEnd(side.mesh, edge, name);
    ring_directions.push_back(vec4((side.mesh.vertices[other] - side.mesh.vertices[name]).normalized(), topology.isFlatEdge(edge)));
  }
  found.end = static_cast<std::uint32_t>(ring_directions.size());
  return found;
}

bool NearFeatures::isRound(const MeshSide& side, std::uint32_t vertex) {
  VertexRing& found = ring(side, vertex);
  if (found.shape == VertexRing::UNKNOWN) {
    const VertexEdges edges = side.topology.edgesOf(vertices.names[vertex]);
    const auto isSmooth = [&](int edge) { return side.topology.isFlatEdge(edge) || isRoundEdge(side, edge); };
    found.shape = std::all_of(edges.begin(), edges.end(), isSmooth) ? VertexRing::ROUND : VertexRing::SHARP;
  }
  return found.shape == VertexRing::ROUND;
}

void NearFeatures::clear() {
  vertices.clear();
  edges.clear();
  faces.clear();
  patches.clear();
  open.clear();
  rings_.clear();
  ring_directions.clear();
}

void CandidatePairs::clear() {
  for (Candidates* candidates :
       {&vertex_face[0], &vertex_face[1], &vertex_edge[0], &vertex_edge[1], &edge_face[0], &edge_face[1], &edge_edge, &vertex_vertex}) {
    candidates->clear();
  }
}

std::size_t CandidatePairs::contacts() const {
  return vertex_face[0].size() + vertex_face[1].size() + vertex_edge[0].size() + vertex_edge[1].size() + edge_edge.size() +
         vertex_vertex.size();
}

void CandidateLists::clear() {
  for (NearFeatures& features : near) features.clear();
  pairs.clear();
}

namespace {

/** Room only grows: nothing is cleared that is overwritten. */
template <typename Record>
void turn(void (*kernel)(const Record*, std::uint32_t, const kernels::Motion&, Record*), const std::vector<Record>& in,
          const kernels::Motion& motion, std::vector<Record>* out) {
  if (out->size() < in.size()) out->resize(in.size());
  kernel(in.data(), static_cast<std::uint32_t>(in.size()), motion, out->data());
}

}  // namespace

void TurnedFeatures::turnForContacts(const CandidateLists& lists, const Pose& X_FM) {
  const kernels::Kernels& kernels = kernels::kernels();
  const kernels::Motion to_fixed = motionOf(X_FM);
  turn(kernels.turnPoints, lists.near[1].vertices.records, to_fixed, &vertices[1]);
  turn(kernels.turnPoints, lists.near[0].vertices.records, motionOf(X_FM.inverse()), &vertices[0]);
  turn(kernels.turnEdges, lists.near[1].edges.records, to_fixed, &edges);
}

void TurnedFeatures::turnForCrossings(const CandidateLists& lists, const Pose& X_FM) {
  turn(kernels::kernels().turnEdges, lists.near[1].edges.records, motionOf(X_FM), &edges);
  turn(kernels::kernels().turnFaces, lists.near[1].faces.records, motionOf(X_FM), &faces);
}

void findCandidates(const MeshPair& pair, const ListMargin& margin, CandidateSearchBuffers* buffers, CandidateLists* lists) {
  const kernels::Kernels& kernels = kernels::kernels();
  Search search(pair, pair.range + margin.motion, buffers, lists);
  const kernels::LeafReach reach = search.leafReach(margin);
  kernels::LeafHits& hits = buffers->hits;
  search.forEachLeafPair([&](LeafFeatures& m, LeafFeatures& f) {
    kernels.leafContacts(m.turned, f.shapes, reach, &hits);
    for (const bool moves : {true, false}) {
      LeafFeatures &own = moves ? m : f, &partner = moves ? f : m;
      Search::append(hits.vertex_face[!moves], hits.vertex_faces[!moves], &lists->pairs.vertex_face[moves],
                     [&](auto i, auto j) -> Candidate {
                       return {search.vertex(moves, &own, i), search.face(!moves, &partner, j)};
                     });
      Search::append(hits.vertex_edge[!moves], hits.vertex_edges[!moves], &lists->pairs.vertex_edge[moves],
                     [&](auto i, auto j) -> Candidate {
                       return {search.vertex(moves, &own, i), search.edge(!moves, &partner, j)};
                     });
    }
    Search::append(hits.vertex_vertex, hits.vertex_vertices, &lists->pairs.vertex_vertex, [&](auto i, auto j) -> Candidate {
      return {search.vertex(true, &m, i), search.vertex(false, &f, j)};
    });
    Search::append(hits.edge_edge, hits.edge_edges, &lists->pairs.edge_edge, [&](auto i, auto j) -> Candidate {
      return {search.edge(true, &m, i), search.edge(false, &f, j)};
    });
  });
  if (margin.motion > 0) dropLeading(pair, margin.motion, lists->near, &lists->pairs.vertex_vertex);
}

void findCrossingCandidates(const MeshPair& pair, const ListMargin& margin, CandidateSearchBuffers* buffers, CandidateLists* lists) {
  Search search(pair, margin.motion, buffers, lists);
  const kernels::LeafReach reach = search.leafReach(margin);
  kernels::LeafHits& hits = buffers->hits;
  search.forEachLeafPair([&](LeafFeatures& m, LeafFeatures& f) {
    kernels::kernels().leafCrossings(m.turned, f.shapes, reach, &hits);
    for (const bool moves : {true, false}) {
      Search::append(hits.edge_face[!moves], hits.edge_faces[!moves], &lists->pairs.edge_face[moves], [&](auto i, auto j) -> Candidate {
        return {search.edge(moves, moves ? &m : &f, i), search.face(!moves, moves ? &f : &m, j)};
      });
    }
  });
}

namespace {

template <typename Kernel, typename First, typename Second>
void keep(Kernel&& kernel, const std::vector<First>& a, const std::vector<Second>& b, const kernels::Reach& reach,
          const std::vector<Candidate>& from, std::vector<Candidate>* to) {
  to->resize(from.size());
  to->resize(kernel(a.data(), b.data(), from.data(), static_cast<std::uint32_t>(from.size()), reach, to->data()));
}

}  // namespace

void findNearest(const MeshPair& pair, const TurnedFeatures& turned, const ListMargin& margin, CandidateLists* lists,
                 CandidatePairs* nearest) {
  const kernels::Kernels& kernels = kernels::kernels();
  const kernels::Reach reach{pair.range, margin.motion, margin.turn};
  const NearFeatures& fixed = lists->near[0];
  const CandidatePairs& all = lists->pairs;
  for (const bool moves : {true, false}) {
    const NearFeatures& partner = lists->near[!moves];
    const auto nearVertexFaces = [&](const auto* a, const auto* b, auto&&... rest) {
      return kernels.nearVertexFaces(a, b, partner.open.data(), rest...);
    };
    keep(nearVertexFaces, turned.vertices[moves], partner.faces.records, reach, all.vertex_face[moves], &nearest->vertex_face[moves]);
  }
  keep(kernels.nearVertexEdges, turned.vertices[1], fixed.edges.records, reach, all.vertex_edge[1], &nearest->vertex_edge[1]);
  keep(kernels.nearVertexEdges, fixed.vertices.records, turned.edges, reach, all.vertex_edge[0], &nearest->vertex_edge[0]);
  keep(kernels.nearEdgeEdges, turned.edges, fixed.edges.records, reach, all.edge_edge, &nearest->edge_edge);
  keep(kernels.nearVertexVertices, turned.vertices[1], fixed.vertices.records, reach, all.vertex_vertex, &nearest->vertex_vertex);
  dropLeading(pair, margin.motion, lists->near, &nearest->vertex_vertex);
}

}  // namespace blem_sim
