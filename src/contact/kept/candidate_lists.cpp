#include "kept/candidate_lists.h"

#include <algorithm>
#include <array>
#include <utility>

#include "blem_sim/geometry/roomy.h"
#include "features/tolerances.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

using kernels::Candidate;
using kernels::EdgeRecord;
using kernels::Vec4;

/** Drops candidates that have no contact since the surface at a vertex leads towards the other mesh, however the pair moves by a margin. */
class LeadingVertices {
 public:
  LeadingVertices(const MeshPair& pair, const ListMargin& margin, const CandidateLists& lists, SurroundingsMemory* surroundings)
      : pair_(pair),
        lists_(lists),
        surroundings_(*surroundings),
        R_MF_(pair.X_FM.linear().transpose()),
        limit_(margin.motion + (margin.turn + 2 * CONE_SLACK) * (pair.range + margin.motion) + 2 * TOUCH) {}

  /** Drops vertices whose surface leads towards edges that are not round. */
  void dropFrom(bool moves, const std::vector<Vec4>& vertices, const std::vector<EdgeRecord>& edges, std::vector<Candidate>* candidates) {
    drop(candidates, [&](const Candidate& c) {
      const EdgeRecord& edge = edges[c.b];
      if (edge.along.w < 0) return false;
      const Vector3 along = vector3(edge.along), back = vector3(edge.start) - vector3(vertices[c.a]);
      return leads(moves, c.a, back - back.dot(along) / edge.start.w * along);
    });
  }

  /** Drops pairs of vertices of which both lead, or one does and the other, nearer than its surroundings, is not round. */
  void dropFrom(const std::vector<Vec4>& moving, const std::vector<Vec4>& fixed, std::vector<Candidate>* candidates) {
    drop(candidates, [&](const Candidate& c) {
      const Vector3 d = vector3(fixed[c.b]) - vector3(moving[c.a]);
      const bool moving_leads = leads(true, c.a, d), fixed_leads = leads(false, c.b, -d);
      return (moving_leads || fixed_leads) && (moving_leads || !isRound(true, c.a)) && (fixed_leads || !isRound(false, c.b));
    });
  }

 private:
  template <typename HasNone>
  static void drop(std::vector<Candidate>* candidates, HasNone&& has_none) {
    candidates->erase(std::remove_if(candidates->begin(), candidates->end(), has_none), candidates->end());
  }

  EdgesAtVertex edgesOf(bool moves, std::uint32_t vertex) {
    return surroundings_.ofVertex(pair_.side(moves), lists_.near[moves].vertices.names[vertex]);
  }

  /** @param d [m] from the vertex to the other mesh, frame F: it changes by no more than the motion, and with the turn */
  bool leads(bool moves, std::uint32_t vertex, const Vector3& d) {
    const Vector3 towards = moves ? Vector3(R_MF_ * d) : d;
    const EdgesAtVertex edges = edgesOf(moves, vertex);
    return kernels::kernels().leadTo(edges.blocks, edges.block_count, towards.data(), limit_ * limit_);
  }

  /** Whether the vertex has flat and round edges only. */
  bool isRound(bool moves, std::uint32_t vertex) {
    const EdgesAtVertex edges = edgesOf(moves, vertex);
    return std::all_of(edges.begin(), edges.end(), [&](const EdgeFromVertex& edge) {
      return edge.is_flat || surroundings_.ofEdge(pair_.side(moves), edge.edge).is_round;
    });
  }

  const MeshPair& pair_;
  const CandidateLists& lists_;
  SurroundingsMemory& surroundings_;
  const Matrix3 R_MF_;
  const double limit_;  // [m] along an edge
};

}  // namespace

void NearFeatures::addFaceOf(const LeafFeatures& leaf, std::uint32_t i, bool near_points) {
  patches.push_back(leaf.patches[i]);
  open.push_back(leaf.shapes.faces.open[i] >> (near_points ? kernels::OPEN_TO_POINTS : 0));
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
}

void NearFeatures::reserve(std::size_t count) {
  vertices.reserve(count);
  edges.reserve(count);
  faces.reserve(count);
  patches.reserve(count);
  open.reserve(count);
  borders.reserve(count);
  fading.reserve(count);
}

void CandidatePairs::clear() {
  for (Candidates* candidates :
       {&vertex_face[0], &vertex_face[1], &vertex_edge[0], &vertex_edge[1], &edge_face[0], &edge_face[1], &edge_edge, &vertex_vertex}) {
    candidates->clear();
  }
  for (std::vector<std::uint8_t>& each : inner) each.clear();
}

void CandidatePairs::reserve(std::size_t count) {
  for (Candidates* candidates :
       {&vertex_face[0], &vertex_face[1], &vertex_edge[0], &vertex_edge[1], &edge_face[0], &edge_face[1], &edge_edge, &vertex_vertex}) {
    candidates->reserve(count);
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
  if (out->size() < in.size()) geometry::resizeRoomy(in.size(), out);
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

void groupByFaces(const MeshPair& pair, CandidateLists* lists, CandidatePairs* room) {
  constexpr std::size_t FEW_FACES = 256;
  for (const bool moves : {true, false}) {
    if (pair.side(!moves).mesh.elements.size() > FEW_FACES) continue;
    const std::vector<int>& faces = lists->near[!moves].faces.names;
    CandidatePairs::Candidates &candidates = lists->pairs.vertex_face[moves], &grouped = room->vertex_face[moves];
    std::array<std::uint32_t, FEW_FACES> places{};
    for (const Candidate& c : candidates) ++places[faces[c.b]];
    std::uint32_t end = 0;
    for (std::uint32_t& place : places) end += std::exchange(place, end);
    geometry::resizeRoomy(candidates.size(), &grouped);
    for (const Candidate& c : candidates) grouped[places[faces[c.b]]++] = c;
    candidates.swap(grouped);
  }
}

namespace {

/** Keeps the candidates that the kernel copies. */
template <typename Kernel>
void keep(Kernel&& kernel, const kernels::Reach& reach, const std::vector<Candidate>& from, std::vector<Candidate>* to) {
  geometry::resizeRoomy(from.size(), to);
  to->resize(kernel(from.data(), static_cast<std::uint32_t>(from.size()), reach, to->data()));
}
template <typename Kernel, typename First, typename Second>
void keep(Kernel&& kernel, const std::vector<First>& a, const std::vector<Second>& b, const kernels::Reach& reach,
          const std::vector<Candidate>& from, std::vector<Candidate>* to) {
  keep([&](auto&&... rest) { return kernel(a.data(), b.data(), rest...); }, reach, from, to);
}

}  // namespace

std::size_t findNearest(const MeshPair& pair, const TurnedFeatures& turned, const ListMargin& margin, const CandidateLists& lists,
                        SurroundingsMemory* surroundings, CandidatePairs* nearest) {
  const kernels::Kernels& kernels = kernels::kernels();
  const kernels::Reach reach{pair.range, margin.motion, margin.turn};
  const NearFeatures& fixed = lists.near[0];
  const CandidatePairs& all = lists.pairs;
  for (const bool moves : {true, false}) {
    const NearFeatures& partner = lists.near[!moves];
    const kernels::NearVertices vertices = turned.nearFaces(lists, moves, pair.X_FM);
    geometry::resizeRoomy(all.vertex_face[moves].size(), &nearest->inner[moves]);
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
  const std::size_t near = nearest->contacts();
  LeadingVertices leading(pair, margin, lists, surroundings);
  leading.dropFrom(true, turned.vertices, fixed.edges.records, &nearest->vertex_edge[1]);
  leading.dropFrom(false, fixed.vertices.records, turned.edges, &nearest->vertex_edge[0]);
  leading.dropFrom(turned.vertices, fixed.vertices.records, &nearest->vertex_vertex);
  return near;
}

}  // namespace blem_sim::contact
