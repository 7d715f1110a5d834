#include "candidate_lists.h"

#include <algorithm>

#include "feature_cones.h"
#include "tolerances.h"
#include "vectors.h"
#include "vertex_cone.h"

namespace blem_sim {
namespace {

using kernels::Candidate;

/** Drops pairs of vertices that have no contact, however they move by the margin [m]: those that lead towards each other, or where one does
 * and the other, nearer than its surroundings, is not round. */
void dropLeading(const MeshPair& pair, double margin, NearFeatures (&near)[2], std::vector<Candidate>* vertices) {
  const double limit = CONE_SLACK * (pair.range + margin) + margin;
  const auto leads = [&](const NearFeatures& features, const VertexRing& ring, const Vector3& d) {
    for (std::uint32_t i = ring.begin; i < ring.end; ++i)
      if (features.ring_directions[i].dot(d) > limit) return true;
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
    ring_directions.push_back((side.mesh.vertices[other] - side.mesh.vertices[name]).normalized());
  }
  found.end = static_cast<std::uint32_t>(ring_directions.size());
  return found;
}

bool NearFeatures::isRound(const MeshSide& side, std::uint32_t vertex) {
  VertexRing& found = ring(side, vertex);
  if (found.shape == VertexRing::UNKNOWN)
    found.shape = hasRoundEdgesOnly(side, vertices.names[vertex]) ? VertexRing::ROUND : VertexRing::SHARP;
  return found.shape == VertexRing::ROUND;
}

void NearFeatures::addFaceOf(const LeafFeatures& leaf, std::uint32_t i) {
  patches.push_back(leaf.patches[i]);
  open.push_back(leaf.shapes.faces.open[i]);
  borders.push_back(leaf.borders[i]);
}

void NearFeatures::clear() {
  vertices.clear();
  edges.clear();
  faces.clear();
  patches.clear();
  open.clear();
  borders.clear();
  fading.clear();
  rings_.clear();
  ring_directions.clear();
}

void CandidatePairs::clear() {
  for (Candidates* candidates :
       {&vertex_face[0], &vertex_face[1], &vertex_edge[0], &vertex_edge[1], &edge_face[0], &edge_face[1], &edge_edge, &vertex_vertex}) {
    candidates->clear();
  }
  for (std::vector<std::uint8_t>& each : inner) each.clear();
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

kernels::NearVertices TurnedFeatures::nearFaces(const CandidateLists& lists, bool moves, const Pose& X_FM) const {
  return {moves ? vertices.data() : lists.near[0].vertices.records.data(), !moves, motionOf(X_FM.inverse()), motionOf(X_FM)};
}

void TurnedFeatures::turnForContacts(const CandidateLists& lists, const Pose& X_FM) {
  const kernels::Kernels& kernels = kernels::kernels();
  const kernels::Motion to_fixed = motionOf(X_FM);
  turn(kernels.turnPoints, lists.near[1].vertices.records, to_fixed, &vertices);
  turn(kernels.turnEdges, lists.near[1].edges.records, to_fixed, &edges);
}

void TurnedFeatures::turnForCrossings(const CandidateLists& lists, const Pose& X_FM) {
  turn(kernels::kernels().turnEdges, lists.near[1].edges.records, motionOf(X_FM), &edges);
  turn(kernels::kernels().turnFaces, lists.near[1].faces.records, motionOf(X_FM), &faces);
}

namespace {

/** Keeps what the kernel copies. */
template <typename Kernel>
void keep(Kernel&& kernel, const kernels::Reach& reach, const std::vector<Candidate>& from, std::vector<Candidate>* to) {
  to->resize(from.size());
  to->resize(kernel(from.data(), static_cast<std::uint32_t>(from.size()), reach, to->data()));
}
template <typename Kernel, typename First, typename Second>
void keep(Kernel&& kernel, const std::vector<First>& a, const std::vector<Second>& b, const kernels::Reach& reach,
          const std::vector<Candidate>& from, std::vector<Candidate>* to) {
  keep([&](auto&&... rest) { return kernel(a.data(), b.data(), rest...); }, reach, from, to);
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
    const kernels::NearVertices vertices = turned.nearFaces(*lists, moves, pair.X_FM);
    nearest->inner[moves].resize(all.vertex_face[moves].size());
    keep(
        [&](auto&&... rest) {
          return kernels.nearVertexFaces(vertices, partner.faces.records.data(), partner.open.data(), rest...,
                                         nearest->inner[moves].data());
        },
        reach, all.vertex_face[moves], &nearest->vertex_face[moves]);
  }
  keep(kernels.nearVertexEdges, turned.vertices, fixed.edges.records, reach, all.vertex_edge[1], &nearest->vertex_edge[1]);
  keep(kernels.nearVertexEdges, fixed.vertices.records, turned.edges, reach, all.vertex_edge[0], &nearest->vertex_edge[0]);
  keep(kernels.nearEdgeEdges, turned.edges, fixed.edges.records, reach, all.edge_edge, &nearest->edge_edge);
  keep(kernels.nearVertexVertices, turned.vertices, fixed.vertices.records, reach, all.vertex_vertex, &nearest->vertex_vertex);
  dropLeading(pair, margin.motion, lists->near, &nearest->vertex_vertex);
}

}  // namespace blem_sim
