#include "border_fade.h"

#include "kernels/kernels.h"
#include "leaving_vertex.h"
#include "vectors.h"

namespace blem_sim {

bool BorderFades::fades(bool vertex_moves, const kernels::Candidate& c, const kernels::VertexFaceHit& hit) {
  const NearFeatures& near = lists_.near[!vertex_moves];
  const BorderKind* const kinds = near.borders[c.b].of[hit.height > 0];
  bool fades = false;
  unsigned falling = 0;
  for (unsigned sides = hit.bits & kernels::VertexFaceHit::OUTSIDE; sides != 0; sides &= sides - 1) {
    const BorderKind kind = kinds[__builtin_ctz(sides)];
    if (kind == BorderKind::FLAT || kind == BorderKind::ROUND) return false;
    fades = fades || kind == BorderKind::RISING;
    if (kind == BorderKind::FALLING) falling |= sides & -sides;
  }
  for (; !fades && falling != 0; falling &= falling - 1) fades = leaves(vertex_moves, c, __builtin_ctz(falling), hit.height > 0);
  return fades;
}

/** Does nothing take over where the vertex leaves over a border behind which the surface falls? isTakenOver in a few products: over such a
 * border the partner allows the vertex's own contact. @param k the side */
bool BorderFades::leaves(bool vertex_moves, const kernels::Candidate& c, int k, bool is_above) {
  const MeshSide &side = pair_.side(vertex_moves), &partner = pair_.side(!vertex_moves);
  const int vertex_name = lists_.near[vertex_moves].vertices.names[c.a], face = lists_.near[!vertex_moves].faces.names[c.b];
  const kernels::FaceRecord& record = lists_.near[!vertex_moves].faces.records[c.b];
  const Vector3 normal = vector3(record.plane), inward = vector3(record.sides[k]), down = is_above ? Vector3(-normal) : normal;
  const Matrix3& R_PS = vertex_moves ? R_FM_ : R_MF_;
  const Vector3 own_down = R_PS.transpose() * down, own_aside = R_PS.transpose() * inward;
  const EdgesAtVertex edges = surroundings_.ofVertex(side, vertex_name);
  const kernels::LeadingEdges leading = kernels::kernels().leadingEdges(edges.blocks, edges.block_count, own_down.data(), own_aside.data());
  if (!leading.near) return leading.down;
  return !isTakenOver({side, partner, vertex_name, partner.topology.edgeOf(face, k), R_PS, own_down}, &surroundings_);
}

}  // namespace blem_sim
