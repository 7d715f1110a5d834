#include "surroundings.h"

#include <algorithm>

#include "feature_cones.h"

namespace blem_sim {
namespace {

EdgeFromVertex edgeFrom(const MeshSide& side, int vertex, int edge) {
  EdgeFromVertex out;
  out.along = side.mesh.vertices[side.topology.otherEnd(side.mesh, edge, vertex)] - side.mesh.vertices[vertex];
  out.length2 = out.along.squaredNorm();
  out.direction = out.along.normalized();
  out.edge = edge;
  out.is_flat = side.topology.isFlatEdge(edge);
  return out;
}

}  // namespace

EdgesAtVertex SurroundingsMemory::ofVertex(const MeshSide& side, int vertex) {
  bool known;
  VertexEdgesKept& kept = vertices_.find(side, vertex, &known);
  if (known && kept.count <= MAX_EDGES) return {kept.edges.data(), kept.count};
  const VertexEdges edges = side.topology.edgesOf(vertex);
  kept.count = edges.size();
  if (kept.count > MAX_EDGES) many_.resize(kept.count);
  EdgeFromVertex* const out = kept.count > MAX_EDGES ? many_.data() : kept.edges.data();
  for (int i = 0; i < kept.count; ++i) out[i] = edgeFrom(side, vertex, edges[i]);
  return {out, kept.count};
}

const EdgeSurroundings& SurroundingsMemory::ofEdge(const MeshSide& side, int edge) {
  bool known;
  EdgeSurroundings& out = edges_.find(side, edge, &known);
  if (known) return out;
  const std::array<int, 2> ends = side.topology.ends(side.mesh, edge);
  out.direction = (side.mesh.vertices[ends[1]] - side.mesh.vertices[ends[0]]).normalized();
  const EdgeFaces faces = side.topology.facesOf(edge);
  out.faces = faces.size();
  for (int k = 0; k < std::min(out.faces, 2); ++k) out.inward[k] = side.topology.inward(side.mesh, edge, faces[k]);
  out.is_round = !side.topology.isFlatEdge(edge) && out.faces == 2 && isRound(out.inward[0], out.inward[1]);
  return out;
}

bool vertexConeAllows(const EdgesAtVertex& edges, const Vector3& direction, double slack) {
  return std::none_of(edges.begin(), edges.end(), [&](const EdgeFromVertex& edge) {
    const double along = edge.along.dot(direction);
    return along > 0 && along * along > slack * slack * edge.length2;
  });
}

bool isRoundVertex(const MeshSide& side, const EdgesAtVertex& edges, const Vector3& direction, SurroundingsMemory* surroundings) {
  return std::all_of(edges.begin(), edges.end(), [&](const EdgeFromVertex& each) {
    if (each.is_flat) return true;
    const EdgeSurroundings& edge = surroundings->ofEdge(side, each.edge);
    return edge.is_round && Vector3(edge.inward[0] + edge.inward[1]).dot(direction) <= 0;
  });
}

}  // namespace blem_sim
