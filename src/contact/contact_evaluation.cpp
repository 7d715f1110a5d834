#include "contact_evaluation.h"

#include <algorithm>
#include <cmath>

#include "vectors.h"

namespace blem_sim {
namespace {

using kernels::Candidate;
using kernels::Vec4;

/** The planes that vertices lie over. */
class PlanesBelow {
 public:
  explicit PlanesBelow(std::vector<kernels::Candidate>* runs, std::vector<std::uint32_t>* last, std::size_t vertices)
      : entries_(*runs), last_(*last) {
    entries_.clear();
    last_.assign(vertices, NONE);
  }
  void add(std::uint32_t vertex, int patch) {
    entries_.push_back({static_cast<std::uint32_t>(patch), last_[vertex]});
    last_[vertex] = static_cast<std::uint32_t>(entries_.size()) - 1;
  }
  bool has(std::uint32_t vertex, int patch) const {
    for (std::uint32_t i = last_[vertex]; i != NONE; i = entries_[i].b)
      if (entries_[i].a == static_cast<std::uint32_t>(patch)) return true;
    return false;
  }

 private:
  static constexpr std::uint32_t NONE = 0xFFFFFFFF;
  std::vector<kernels::Candidate>& entries_;  // a: patch; b: the entry before of the same vertex
  std::vector<std::uint32_t>& last_;
};

}  // namespace

void FoundContacts::clear() {
  plain.clear();
  close.clear();
  crossings.clear();
}

void Evaluation::findContacts() {
  const auto& vertices = buffers_.turned.vertices;
  const auto& edges = buffers_.turned.edges;
  for (const bool moves : {true, false}) {
    vertexFaces(moves);
    vertexEdges(moves, moves ? vertices[1].data() : lists_.near[0].vertices.records.data(),
                moves ? lists_.near[0].edges.records.data() : edges.data());
  }
  edgeEdges(edges.data(), lists_.near[0].edges.records.data());
  vertexVertices(vertices[1].data(), lists_.near[0].vertices.records.data());
}

void Evaluation::findCrossings() {
  const TurnedFeatures& turned = buffers_.turned;
  for (const bool moves : {true, false}) {
    const std::vector<Candidate>& candidates = pairs_.edge_face[moves];
    const auto& edges = moves ? turned.edges : lists_.near[0].edges.records;
    const auto& faces = moves ? lists_.near[0].faces.records : turned.faces;
    forEachHit(candidates, kernels::kernels().edgeFaces(edges.data(), faces.data(), candidates.data(), candidates.size(), room(candidates)),
               [&](const Candidate& c) {
                 const Crossing crossing{moves, lists_.near[moves].edges.names[c.a], lists_.near[!moves].faces.names[c.b]};
                 if (crosses(pair_, crossing)) found_.crossings.push_back(crossing);
               });
  }
}

std::uint32_t* Evaluation::room(const std::vector<Candidate>& candidates) {
  buffers_.hits.resize(std::max(buffers_.hits.size(), candidates.size()));
  return buffers_.hits.data();
}

template <typename Visit>
void Evaluation::forEachHit(const std::vector<Candidate>& candidates, std::uint32_t count, Visit&& visit) const {
  for (std::uint32_t i = 0; i < count; ++i) visit(candidates[buffers_.hits[i]]);
}

void Evaluation::vertexFaces(bool moves) {
  const std::vector<Candidate>& candidates = pairs_.vertex_face[moves];
  const auto& vertices = lists_.near[moves].vertices;
  const auto& faces = lists_.near[!moves].faces;
  auto& hits = buffers_.vertex_faces;
  hits.resize(std::max(hits.size(), candidates.size()));
  const std::uint32_t count =
      kernels::kernels().vertexFaces(buffers_.turned.vertices[moves].data(), faces.records.data(), lists_.near[!moves].open.data(),
                                     candidates.data(), candidates.size(), pair_.range, hits.data());
  const std::vector<int>& patches = lists_.near[!moves].patches;
  PlanesBelow below(&buffers_.planes_below, &buffers_.last_plane, vertices.names.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    kernels::VertexFaceHit& hit = hits[i];
    const Candidate& c = candidates[hit.candidate];
    if (!hit.is_plain) {
      hit.is_beside = hit.is_beside || !exact_.vertexFace(moves, vertices.names[c.a], faces.names[c.b]);
      if (hit.is_beside) continue;
    } else {
      addPlain(moves, c, hit);
    }
    below.add(c.a, patches[c.b]);
  }
  // Beside one face of a plane but over another it does not fade.
  for (std::uint32_t i = 0; i < count; ++i) {
    const Candidate& c = candidates[hits[i].candidate];
    if (hits[i].is_beside && !below.has(c.a, patches[c.b])) addFading(moves, c, hits[i].height);
  }
}

void Evaluation::addPlain(bool moves, const Candidate& c, const kernels::VertexFaceHit& hit) {
  const auto& faces = lists_.near[!moves].faces;
  const Feature vertex{FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]},
      patch{FeatureKind::FACE, lists_.near[!moves].patches[c.b]};
  const Vector3 p = vector3(moves ? buffers_.turned.vertices[1][c.a] : lists_.near[0].vertices.records[c.a]);
  const Vector3 up = pair_.turned(vector3(faces.records[c.b].plane), !moves), foot = p - hit.height * up;
  const Vector3 normal = (hit.height > 0) == moves ? up : Vector3(-up);
  (hit.near_border ? found_.close : found_.plain).push_back(featureContact(moves, vertex, patch, p, foot, normal, std::abs(hit.height)));
}

void Evaluation::addFading(bool moves, const Candidate& c, double height) {
  BorderFade fade;
  const double most = pair_.range - std::abs(height);
  if (!fades_.find(moves, c.a, c.b, vector3(buffers_.turned.vertices[moves][c.a]), height, most, &fade)) return;
  const Vector3 p = vector3(moves ? buffers_.turned.vertices[1][c.a] : lists_.near[0].vertices.records[c.a]);
  const Vector3 d = moves ? Vector3(p - fade.foot) : Vector3(fade.foot - p);
  const double distance = d.norm(), gap = distance + fade.lost;
  if (distance <= TOUCH || gap > pair_.range) return;
  const Feature vertex{FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]},
      patch{FeatureKind::FACE, lists_.near[!moves].patches[c.b]};
  found_.close.push_back(featureContact(moves, vertex, patch, p, fade.foot, d / distance, gap));
}

void Evaluation::edgeEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed) {
  const std::vector<Candidate>& candidates = pairs_.edge_edge;
  auto& hits = buffers_.edge_edges;
  hits.resize(std::max(hits.size(), candidates.size()));
  const std::uint32_t count = kernels::kernels().edgeEdges(moving, fixed, candidates.data(), candidates.size(), pair_.range, hits.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    const kernels::EdgeEdgeHit& hit = hits[i];
    const Candidate& c = candidates[hit.candidate];
    const int m = lists_.near[1].edges.names[c.a], f = lists_.near[0].edges.names[c.b];
    if (!hit.is_plain) {
      exact_.edgeEdge(m, f, moving[c.a], fixed[c.b]);
      continue;
    }
    const auto foot = [](const kernels::EdgeRecord& edge, double part) {
      return Vector3(vector3(edge.start) + part * vector3(edge.along));
    };
    (hit.near_border ? found_.close : found_.plain)
        .push_back({{FeatureKind::EDGE, m},
                    {FeatureKind::EDGE, f},
                    foot(moving[c.a], hit.part_a),
                    foot(fixed[c.b], hit.part_b),
                    Vector3(hit.normal[0], hit.normal[1], hit.normal[2]),
                    hit.gap});
  }
}

void Evaluation::vertexEdges(bool moves, const Vec4* vertices, const kernels::EdgeRecord* edges) {
  const std::vector<Candidate>& candidates = pairs_.vertex_edge[moves];
  forEachHit(candidates,
             kernels::kernels().vertexEdges(vertices, edges, candidates.data(), candidates.size(), pair_.range, room(candidates)),
             [&](const Candidate& c) {
               exact_.vertexEdge(moves, lists_.near[moves].vertices.names[c.a], lists_.near[!moves].edges.names[c.b],
                                 vector3(vertices[c.a]), edges[c.b]);
             });
}

void Evaluation::vertexVertices(const Vec4* moving, const Vec4* fixed) {
  const std::vector<Candidate>& candidates = pairs_.vertex_vertex;
  forEachHit(candidates,
             kernels::kernels().vertexVertices(moving, fixed, candidates.data(), candidates.size(), pair_.range, room(candidates)),
             [&](const Candidate& c) { exact_.vertexVertex(lists_.near[1].vertices.names[c.a], lists_.near[0].vertices.names[c.b]); });
}

}  // namespace blem_sim
