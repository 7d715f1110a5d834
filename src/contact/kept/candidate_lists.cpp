#include "kept/candidate_lists.h"

#include <algorithm>

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
  void dropFrom(Side side, const std::vector<Vec4>& vertices, const std::vector<EdgeRecord>& edges, std::vector<Candidate>* candidates) {
    drop(candidates, [&](const Candidate& c) {
      const EdgeRecord& edge = edges[c.second];
      if (edge.along.w < 0) return false;
      const Vector3 along = vector3(edge.along), back = vector3(edge.start) - vector3(vertices[c.first]);
      return leads(side, c.first, back - back.dot(along) / edge.start.w * along);
    });
  }

  /** Drops pairs of vertices of which both lead, or one does and the other, nearer than its surroundings, is not round. */
  void dropFrom(const std::vector<Vec4>& moving, const std::vector<Vec4>& fixed, std::vector<Candidate>* candidates) {
    drop(candidates, [&](const Candidate& c) {
      const Vector3 d = vector3(fixed[c.second]) - vector3(moving[c.first]);
      const bool moving_leads = leads(Side::MOVING, c.first, d), fixed_leads = leads(Side::FIXED, c.second, -d);
      return (moving_leads || fixed_leads) && (moving_leads || !isRound(Side::MOVING, c.first)) &&
             (fixed_leads || !isRound(Side::FIXED, c.second));
    });
  }

 private:
  template <typename HasNone>
  static void drop(std::vector<Candidate>* candidates, HasNone&& has_none) {
    candidates->erase(std::remove_if(candidates->begin(), candidates->end(), has_none), candidates->end());
  }

  EdgesAtVertex edgesOf(Side side, std::uint32_t vertex) {
    return surroundings_.ofVertex(pair_.side(side), lists_.near[side].vertices.names[vertex]);
  }

  /** @param d [m] from the vertex to the other mesh, frame F: it changes by no more than the motion, and with the turn */
  bool leads(Side side, std::uint32_t vertex, const Vector3& d) {
    const Vector3 towards = side == Side::MOVING ? Vector3(R_MF_ * d) : d;
    const EdgesAtVertex edges = edgesOf(side, vertex);
    return kernels::kernels().leadTo(edges.blocks, edges.block_count, towards.data(), limit_ * limit_);
  }

  /** Whether the vertex has flat and round edges only. */
  bool isRound(Side side, std::uint32_t vertex) {
    const EdgesAtVertex edges = edgesOf(side, vertex);
    return std::all_of(edges.begin(), edges.end(), [&](const EdgeFromVertex& edge) {
      return edge.is_flat || surroundings_.ofEdge(pair_.side(side), edge.edge).is_round;
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
  for (PerSide<Candidates>* candidates : {&vertex_face, &vertex_edge, &edge_face})
    for (const Side side : SIDES) (*candidates)[side].clear();
  for (Candidates* candidates : {&edge_edge, &vertex_vertex}) candidates->clear();
  for (const Side side : SIDES) inner[side].clear();
}

void CandidatePairs::reserve(std::size_t count) {
  for (PerSide<Candidates>* candidates : {&vertex_face, &vertex_edge, &edge_face})
    for (const Side side : SIDES) (*candidates)[side].reserve(count);
  for (Candidates* candidates : {&edge_edge, &vertex_vertex}) candidates->reserve(count);
}

std::size_t CandidatePairs::contacts() const {
  return vertex_face.fixed.size() + vertex_face.moving.size() + vertex_edge.fixed.size() + vertex_edge.moving.size() + edge_edge.size() +
         vertex_vertex.size();
}

void CandidateLists::clear() {
  for (const Side side : SIDES) near[side].clear();
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

kernels::NearVertices TurnedFeatures::nearFaces(const CandidateLists& lists, Side side, const Pose& X_FM) const {
  return {side == Side::MOVING ? vertices.data() : lists.near.fixed.vertices.records.data(), side, motionOf(X_FM.inverse()),
          motionOf(X_FM)};
}

void TurnedFeatures::turnForContacts(const CandidateLists& lists, const Pose& X_FM) {
  const kernels::Kernels& kernels = kernels::kernels();
  const kernels::Motion to_fixed = motionOf(X_FM);
  turn(kernels.turnPoints, lists.near.moving.vertices.records, to_fixed, &vertices);
  turn(kernels.turnEdges, lists.near.moving.edges.records, to_fixed, &edges);
}

void TurnedFeatures::turnForCrossings(const CandidateLists& lists, const Pose& X_FM) {
  turn(kernels::kernels().turnEdges, lists.near.moving.edges.records, motionOf(X_FM), &edges);
  turn(kernels::kernels().turnFaces, lists.near.moving.faces.records, motionOf(X_FM), &faces);
}

namespace {

/** Keeps the candidates that the kernel copies. */
template <typename Kernel>
void keep(Kernel&& kernel, const kernels::Reach& reach, const std::vector<Candidate>& from, std::vector<Candidate>* to) {
  geometry::resizeRoomy(from.size(), to);
  to->resize(kernel(kernels::CandidateRun{from.data(), static_cast<std::uint32_t>(from.size())}, reach, to->data()));
}
/** The kernel on these features. */
template <typename Kernel, typename First, typename Second>
auto on(Kernel kernel, const std::vector<First>& first, const std::vector<Second>& second) {
  return [kernel, &first, &second](auto&&... rest) { return kernel(first.data(), second.data(), rest...); };
}

}  // namespace

std::size_t findNearest(const MeshPair& pair, const TurnedLists& listed, const ListMargin& margin, SurroundingsMemory* surroundings,
                        CandidatePairs* nearest) {
  const CandidateLists& lists = listed.lists;
  const TurnedFeatures& turned = listed.turned;
  const kernels::Kernels& kernels = kernels::kernels();
  const kernels::Reach reach{pair.range, margin.motion, margin.turn};
  const NearFeatures& fixed = lists.near.fixed;
  const CandidatePairs& all = lists.pairs;
  for (const Side side : SIDES) {
    const kernels::VerticesAtFaces features = turned.atFaces(lists, side, pair.X_FM);
    geometry::resizeRoomy(all.vertex_face[side].size(), &nearest->inner[side]);
    keep([&](auto&&... rest) { return kernels.nearVertexFaces(features, rest..., nearest->inner[side].data()); }, reach,
         all.vertex_face[side], &nearest->vertex_face[side]);
  }
  keep(on(kernels.nearVertexEdges, turned.vertices, fixed.edges.records), reach, all.vertex_edge.moving, &nearest->vertex_edge.moving);
  keep(on(kernels.nearVertexEdges, fixed.vertices.records, turned.edges), reach, all.vertex_edge.fixed, &nearest->vertex_edge.fixed);
  keep(on(kernels.nearEdgeEdges, turned.edges, fixed.edges.records), reach, all.edge_edge, &nearest->edge_edge);
  keep(on(kernels.nearVertexVertices, turned.vertices, fixed.vertices.records), reach, all.vertex_vertex, &nearest->vertex_vertex);
  const std::size_t near = nearest->contacts();
  LeadingVertices leading(pair, margin, lists, surroundings);
  leading.dropFrom(Side::MOVING, turned.vertices, fixed.edges.records, &nearest->vertex_edge.moving);
  leading.dropFrom(Side::FIXED, fixed.vertices.records, turned.edges, &nearest->vertex_edge.fixed);
  leading.dropFrom(turned.vertices, fixed.vertices.records, &nearest->vertex_vertex);
  return near;
}

}  // namespace blem_sim::contact
