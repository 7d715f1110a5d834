#include "neighbourhood/surroundings.h"

#include <algorithm>

#include "features/feature_cones.h"

namespace blem_sim::contact {
namespace {

EdgeFromVertex edgeFrom(const MeshSide& side, int vertex, int edge) {
  EdgeFromVertex out;
  out.along = side.mesh.vertices[side.topology.otherEnd(side.mesh, edge, vertex)] - side.mesh.vertices[vertex];
  out.length2 = out.along.squaredNorm();
  out.edge = edge;
  out.is_flat = side.topology.isFlatEdge(edge);
  return out;
}

/** @param blocks room for all */
void writeDirections(const EdgeFromVertex* edges, int count, kernels::EdgeDirections* blocks) {
  constexpr int SIZE = kernels::DIRECTION_BLOCK;
  for (int i = 0; i < kernels::directionBlocks(count) * SIZE; ++i) {
    const Vector3 direction = i < count ? edges[i].along.normalized() : Vector3(Vector3::Zero());
    kernels::EdgeDirections& block = blocks[i / SIZE];
    block.x[i % SIZE] = direction.x(), block.y[i % SIZE] = direction.y(), block.z[i % SIZE] = direction.z();
    block.near[i % SIZE] = i < count && !edges[i].is_flat ? NEAR_SUCCESSOR : -1;
  }
}

}  // namespace

EdgesAtVertex SurroundingsMemory::ofVertex(const MeshSide& side, int vertex) {
  if (side.topology.edgeCount() == 0) return {};  // points
  bool known;
  VertexEdgesKept& kept = vertices_.find(side, vertex, &known);
  if (known && kept.count <= MAX_EDGES) return {kept.edges.data(), kept.count, &kept.block, kernels::directionBlocks(kept.count)};
  const geometry::VertexEdges edges = side.topology.edgesOf(vertex);
  kept.count = edges.size();
  const bool many = kept.count > MAX_EDGES;
  if (many) {
    many_.resize(kept.count);
    many_blocks_.resize(kernels::directionBlocks(kept.count));
  }
  EdgeFromVertex* const out = many ? many_.data() : kept.edges.data();
  kernels::EdgeDirections* const blocks = many ? many_blocks_.data() : &kept.block;
  for (int i = 0; i < kept.count; ++i) out[i] = edgeFrom(side, vertex, edges[i]);
  writeDirections(out, kept.count, blocks);
  return {out, kept.count, blocks, kernels::directionBlocks(kept.count)};
}

const EdgeSurroundings& SurroundingsMemory::ofEdge(const MeshSide& side, int edge) {
  bool known;
  EdgeSurroundings& out = edges_.find(side, edge, &known);
  if (known) return out;
  const std::array<int, 2> ends = side.topology.ends(side.mesh, edge);
  out.direction = (side.mesh.vertices[ends[1]] - side.mesh.vertices[ends[0]]).normalized();
  const geometry::EdgeFaces faces = side.topology.facesOf(edge);
  out.faces = faces.size();
  for (int k = 0; k < std::min(out.faces, 2); ++k) out.inward[k] = side.topology.inward(side.mesh, edge, faces[k]);
  out.is_round = !side.topology.isFlatEdge(edge) && out.faces == 2 && isRound(out.inward[0], out.inward[1]);
  return out;
}

const PlaneReach& SurroundingsMemory::ofFace(const MeshSide& side, int face) {
  bool known;
  PlaneReach& out = faces_.find(side, face, &known);
  if (!known) out = planeReach(side, face);
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

}  // namespace blem_sim::contact
