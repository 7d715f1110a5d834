#include "evaluation/contact_evaluation.h"

#include <algorithm>
#include <limits>

#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

using kernels::Candidate;
using kernels::Vec4;

kernels::CandidateRun runOf(const std::vector<Candidate>& candidates) {
  return {candidates.data(), static_cast<std::uint32_t>(candidates.size())};
}

}  // namespace

void EvaluatedContacts::clear() {
  deepest_plain = -std::numeric_limits<double>::infinity();
  close.begin(false);
  crossings.clear();
}

double EvaluatedContacts::leastGap(const MeshPair& pair) const {
  return std::min({pair.range, pair.layer - deepest_plain, close.leastGap(pair.layer)});
}

void Evaluation::findContacts() {
  found_.close.begin(!found_.crossings.empty());
  const auto& vertices = buffers_.turned.vertices;
  const auto& edges = buffers_.turned.edges;
  for (const Side side : SIDES) {
    vertexFaces(side);
    vertexEdges(side, side == Side::MOVING ? vertices.data() : lists_.near.fixed.vertices.records.data(),
                side == Side::MOVING ? lists_.near.fixed.edges.records.data() : edges.data());
  }
  edgeEdges(edges.data(), lists_.near.fixed.edges.records.data());
  vertexVertices(vertices.data(), lists_.near.fixed.vertices.records.data());
}

void Evaluation::findCrossings() {
  const TurnedFeatures& turned = buffers_.turned;
  for (const Side side : SIDES) {
    const std::vector<Candidate>& candidates = pairs_.edge_face[side];
    const auto& edges = side == Side::MOVING ? turned.edges : lists_.near.fixed.edges.records;
    const auto& faces = side == Side::MOVING ? lists_.near.fixed.faces.records : turned.faces;
    forEachHit(candidates, kernels::kernels().edgeFaces(edges.data(), faces.data(), runOf(candidates), room(candidates)),
               [&](const Candidate& c) {
                 const Crossing crossing{side, lists_.near[side].edges.names[c.first], lists_.near[!side].faces.names[c.second]};
                 if (crosses(pair_, crossing)) found_.crossings.push_back(crossing);
               });
  }
}

std::uint32_t* Evaluation::room(const std::vector<Candidate>& candidates) {
  EvaluationBuffers::makeRoom(candidates.size(), &buffers_.hits);
  return buffers_.hits.data();
}

template <typename Visit>
void Evaluation::forEachHit(const std::vector<Candidate>& candidates, std::uint32_t count, Visit&& visit) const {
  for (std::uint32_t i = 0; i < count; ++i) visit(candidates[buffers_.hits[i]]);
}

/** @return number of plain ones that need a closer look; the others are written, those that are not plain are left */
std::uint32_t Evaluation::findEdgeEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed) {
  const std::vector<Candidate>& candidates = pairs_.edge_edge;
  const ContactRoles& roles = pair_.roles;
  const Feature edge{FeatureKind::EDGE, 0};
  kernels::PlainEdges plain{{lists_.near.moving.edges.names.data(), lists_.near.fixed.edges.names.data(), roles.a, motionOf(pair_.X_WF),
                             roles.layer(), roles.shift(), contactId(edge, edge)},
                            nullptr,
                            0,
                            found_.deepest_plain};
  EvaluationBuffers::makeRoom(candidates.size() + 1, &buffers_.edges_left);
  kernels::LeftEdges left{buffers_.edges_left.data(), 0};
  const std::uint32_t count =
      testBlocks(candidates.size(), &buffers_.edge_edges, &plain, [&](std::uint32_t first, std::uint32_t size, kernels::EdgeEdgeHit* hits) {
        return kernels::kernels().edgeEdges(moving, fixed, {candidates.data() + first, size}, pair_.range,
                                            {found_.crossings.empty() ? &plain : nullptr, &left, hits});
      });
  buffers_.edges_left_count = left.count;
  return count;
}

void Evaluation::edgeEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed) {
  if (pairs_.edge_edge.empty()) return;
  const std::uint32_t count = findEdgeEdges(moving, fixed);
  for (std::uint32_t i = 0; i < count; ++i) {
    const kernels::EdgeEdgeHit& hit = buffers_.edge_edges[i];
    const Candidate& c = pairs_.edge_edge[hit.candidate];
    const Feature m{FeatureKind::EDGE, lists_.near.moving.edges.names[c.first]},
        f{FeatureKind::EDGE, lists_.near.fixed.edges.names[c.second]};
    found_.close.add(pair_, {m, f, Vector3(hit.point_m), Vector3(hit.point_f), Vector3(hit.normal), hit.gap});
  }
  fadingEdges(moving, fixed);
}

void Evaluation::fadingEdges(const kernels::EdgeRecord* moving, const kernels::EdgeRecord* fixed) {
  const std::vector<Candidate>& left = buffers_.edges_left;
  const std::uint32_t total = buffers_.edges_left_count;
  EvaluationBuffers::makeRoom(total + 1, &buffers_.fading_edges);
  const std::uint32_t count =
      kernels::kernels().fadingEdges(moving, fixed, {left.data(), total}, pair_.range, buffers_.fading_edges.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    const kernels::FadingEdgesHit& hit = buffers_.fading_edges[i];
    const Candidate& c = left[hit.candidate];
    const int m = lists_.near.moving.edges.names[c.first], f = lists_.near.fixed.edges.names[c.second];
    if (hit.is_inside) {
      exact_.edgeEdge(m, f, moving[c.first], fixed[c.second]);
    } else {
      exact_.fadingEdges(m, f, hit);
    }
  }
}

void Evaluation::vertexEdges(Side side, const Vec4* vertices, const kernels::EdgeRecord* edges) {
  const std::vector<Candidate>& candidates = pairs_.vertex_edge[side];
  EvaluationBuffers::makeRoom(candidates.size(), &buffers_.vertex_edges);
  const kernels::VertexEdgeHit* const hits = buffers_.vertex_edges.data();
  const std::uint32_t count = kernels::kernels().vertexEdges(vertices, edges, runOf(candidates), pair_.range, buffers_.vertex_edges.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    const Candidate& c = candidates[hits[i].candidate];
    const int vertex = lists_.near[side].vertices.names[c.first];
    const bool is_round = edges[c.second].along.w < 0;
    if (!is_round && exact_.leadsTo(side, vertex, Vector3(hits[i].offset))) continue;
    exact_.vertexEdge(side, vertex, lists_.near[!side].edges.names[c.second], vector3(vertices[c.first]), edges[c.second]);
  }
}

void Evaluation::vertexVertices(const Vec4* moving, const Vec4* fixed) {
  const std::vector<Candidate>& candidates = pairs_.vertex_vertex;
  forEachHit(candidates, kernels::kernels().vertexVertices(moving, fixed, runOf(candidates), pair_.range, room(candidates)),
             [&](const Candidate& c) {
               exact_.vertexVertex(lists_.near.moving.vertices.names[c.first], lists_.near.fixed.vertices.names[c.second]);
             });
}

}  // namespace blem_sim::contact
