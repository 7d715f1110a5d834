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
    visitLeafPairsIf(pair_.moving.bvh, pair_.fixed.bvh, pair_.X_FM, reach_, matters, [&](std::uint32_t m, std::uint32_t f) {
      visit(buffers_.leaves.moving(pair_.moving, m, search_, motion_), buffers_.leaves.standing(pair_.fixed, f, search_));
    });
  }

  /** With room for the rounding of floats. */
  kernels::LeafReach leafReach(double margin) const {
    const double largest = std::max(pair_.fixed.bounds.min().cwiseAbs().maxCoeff(), pair_.fixed.bounds.max().cwiseAbs().maxCoeff());
    const double wider = margin + FLOAT_ROUNDING * (largest + reach_) + 3 * CLOSED;
    return {static_cast<float>(reach_ - margin + wider), static_cast<float>(wider), static_cast<float>(deepestInside(reach_) + wider)};
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
    if (leaf->face_slots[i] == LeafFeatures::NO_SLOT) near.patches.push_back(pair_.side(moves).topology.patchOf(leaf->faces[i]));
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

/** How steeply (sine) the face's neighbours over an edge rise out of its plane towards `up`, the mesh's frame; negative where they fall. */
double neighbourSlope(const MeshSide& side, int face, int edge, const Vector3& up) {
  double slope = -1;
  for (const int neighbour : side.topology.facesOf(edge)) {
    if (side.topology.patchOf(neighbour) == side.topology.patchOf(face)) continue;
    slope = std::max(slope, side.topology.inward(side.mesh, edge, neighbour).dot(up));
  }
  return slope;
}

FaceBorders::Kind borderKind(const MeshSide& side, int face, int k, const Vector3& up) {
  const int edge = side.topology.edgeOf(face, k);
  if (side.topology.isFlatEdge(edge)) return FaceBorders::FLAT;
  const double rise = neighbourSlope(side, face, edge, up);
  return rise > NEAR_SUCCESSOR ? FaceBorders::RISING : rise > CONE_SLACK ? FaceBorders::TURNING : FaceBorders::FALLING;
}

bool boxesWithin(const kernels::LeafShapes& a, const kernels::LeafShapes& b, float reach) {
  bool within = true;
  for (int k = 0; k < 3; ++k) within = within && a.lower[k] <= b.upper[k] + reach && b.lower[k] <= a.upper[k] + reach;
  return within;
}

/** Drops pairs of vertices one of which has an edge that leads towards the other, however they move by the margin: they have no contact. */
void dropLeading(const MeshPair& pair, double margin, CandidateLists* lists) {
  const double limit = CONE_SLACK * (pair.range + margin) + margin;
  const auto leads = [&](bool moves, std::uint32_t vertex, const Vector3& d) {
    NearFeatures& near = lists->near[moves];
    const VertexRing ring = near.ring(pair.side(moves), vertex);
    for (std::uint32_t i = ring.begin; i < ring.end; ++i)
      if (vector3(near.ring_directions[i]).dot(d) > limit) return true;
    return false;
  };
  const auto first = std::remove_if(lists->pairs.vertex_vertex.begin(), lists->pairs.vertex_vertex.end(), [&](const Candidate& c) {
    const Vector3 d = vector3(lists->near[0].vertices.records[c.b]) - pair.X_FM * vector3(lists->near[1].vertices.records[c.a]);
    return leads(true, c.a, pair.X_FM.linear().transpose() * d) || leads(false, c.b, -d);
  });
  lists->pairs.vertex_vertex.erase(first, lists->pairs.vertex_vertex.end());
}

}  // namespace

const FaceBorders& NearFeatures::borders(const MeshSide& side, std::uint32_t face) {
  if (borders_.size() < faces.names.size()) borders_.resize(faces.names.size());
  FaceBorders& found = borders_[face];
  if (found.kinds[0][0] != FaceBorders::UNKNOWN) return found;
  const int name = faces.names[face];
  const Vector3 normal = MeshTopology::normal(side.mesh, name);
  for (int k = 0; k < 3; ++k) {
    found.corners[k] = side.mesh.vertices[side.mesh.elements[name][k]];
    found.kinds[0][k] = borderKind(side, name, k, -normal);
    found.kinds[1][k] = borderKind(side, name, k, normal);
  }
  return found;
}

const VertexRing& NearFeatures::ring(const MeshSide& side, std::uint32_t vertex) {
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

void NearFeatures::clear() {
  vertices.clear();
  edges.clear();
  faces.clear();
  patches.clear();
  borders_.clear();
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

// Room only grows: nothing is cleared that is overwritten.
void TurnedFeatures::turnVertices(bool moves, const CandidateLists& lists, const kernels::Motion& motion) {
  const auto& records = lists.near[moves].vertices.records;
  if (vertices[moves].size() < records.size()) vertices[moves].resize(records.size());
  kernels::kernels().turnPoints(records.data(), records.size(), motion, vertices[moves].data());
}

void TurnedFeatures::turnEdges(bool moves, const CandidateLists& lists, const kernels::Motion& motion) {
  const auto& records = lists.near[moves].edges.records;
  if (edges[moves].size() < records.size()) edges[moves].resize(records.size());
  kernels::kernels().turnEdges(records.data(), records.size(), motion, edges[moves].data());
}

void TurnedFeatures::turn(const CandidateLists& lists, const Pose& X_FM) {
  const kernels::Motion to_fixed = motionOf(X_FM);
  turnVertices(true, lists, to_fixed);
  turnVertices(false, lists, motionOf(X_FM.inverse()));
  turnEdges(true, lists, to_fixed);
}

void TurnedFeatures::turnForCrossings(const CandidateLists& lists, const Pose& X_FM) { turnEdges(false, lists, motionOf(X_FM.inverse())); }

void findCandidates(const MeshPair& pair, double margin, CandidateSearchBuffers* buffers, CandidateLists* lists) {
  const kernels::Kernels& kernels = kernels::kernels();
  Search search(pair, pair.range + margin, buffers, lists);
  const kernels::LeafReach reach = search.leafReach(margin);
  kernels::LeafHits& hits = buffers->hits;
  search.forEachLeafPair([&](LeafFeatures& m, LeafFeatures& f) {
    kernels.leafContacts(m.turned, f.shapes, reach, &hits);
    Search::append(hits.vertex_face, hits.vertex_faces, &lists->pairs.vertex_face[1], [&](auto i, auto j) -> Candidate {
      return {search.vertex(true, &m, i), search.face(false, &f, j)};
    });
    Search::append(hits.vertex_edge, hits.vertex_edges, &lists->pairs.vertex_edge[1], [&](auto i, auto j) -> Candidate {
      return {search.vertex(true, &m, i), search.edge(false, &f, j)};
    });
    Search::append(hits.vertex_vertex, hits.vertex_vertices, &lists->pairs.vertex_vertex, [&](auto i, auto j) -> Candidate {
      return {search.vertex(true, &m, i), search.vertex(false, &f, j)};
    });
    Search::append(hits.edge_edge, hits.edge_edges, &lists->pairs.edge_edge, [&](auto i, auto j) -> Candidate {
      return {search.edge(true, &m, i), search.edge(false, &f, j)};
    });
    Search::append(hits.edge_vertex, hits.edge_vertices, &lists->pairs.vertex_edge[0], [&](auto i, auto j) -> Candidate {
      return {search.vertex(false, &f, j), search.edge(true, &m, i)};
    });
    Search::append(hits.face_vertex, hits.face_vertices, &lists->pairs.vertex_face[0], [&](auto i, auto j) -> Candidate {
      return {search.vertex(false, &f, j), search.face(true, &m, i)};
    });
    if (!boxesWithin(m.turned, f.shapes, reach.margin)) return;
    kernels.leafCrossings(m.turned, f.shapes, reach, &hits);
    Search::append(hits.edge_face, hits.edge_faces, &lists->pairs.edge_face[1], [&](auto i, auto j) -> Candidate {
      return {search.edge(true, &m, i), search.face(false, &f, j)};
    });
    Search::append(hits.face_edge, hits.face_edges, &lists->pairs.edge_face[0], [&](auto i, auto j) -> Candidate {
      return {search.edge(false, &f, j), search.face(true, &m, i)};
    });
  });
  dropLeading(pair, margin, lists);
}

void findNearest(const CandidateLists& lists, const TurnedFeatures& turned, double range, double margin, CandidatePairs* nearest) {
  const kernels::Kernels& kernels = kernels::kernels();
  const auto keep = [&](auto kernel, const auto* a, const auto* b, const std::vector<Candidate>& from, std::vector<Candidate>* to) {
    to->resize(from.size());
    to->resize(kernel(a, b, from.data(), static_cast<std::uint32_t>(from.size()), {range, margin}, to->data()));
  };
  const NearFeatures &fixed = lists.near[0], &moving = lists.near[1];
  const auto &fixed_vertices = fixed.vertices.records, &moving_vertices = turned.vertices[1];
  const CandidatePairs& all = lists.pairs;
  keep(kernels.nearVertexFaces, moving_vertices.data(), fixed.faces.records.data(), all.vertex_face[1], &nearest->vertex_face[1]);
  keep(kernels.nearVertexFaces, turned.vertices[0].data(), moving.faces.records.data(), all.vertex_face[0], &nearest->vertex_face[0]);
  keep(kernels.nearVertexEdges, moving_vertices.data(), fixed.edges.records.data(), all.vertex_edge[1], &nearest->vertex_edge[1]);
  keep(kernels.nearVertexEdges, fixed_vertices.data(), turned.edges[1].data(), all.vertex_edge[0], &nearest->vertex_edge[0]);
  keep(kernels.nearEdgeEdges, turned.edges[1].data(), fixed.edges.records.data(), all.edge_edge, &nearest->edge_edge);
  keep(kernels.nearVertexVertices, moving_vertices.data(), fixed_vertices.data(), all.vertex_vertex, &nearest->vertex_vertex);
}

}  // namespace blem_sim
