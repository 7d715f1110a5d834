#include "border_fade.h"

#include <algorithm>
#include <cmath>

#include "feature_cones.h"
#include "leaving_vertex.h"
#include "vectors.h"

namespace blem_sim {
namespace {

/** The point of a face's side k that is closest to q; mesh's frame. */
Vector3 closestOnSide(const MeshSide& side, int face, int k, const Vector3& q) {
  const Vector3i& corners = side.mesh.elements[face];
  const Vector3 &start = side.mesh.vertices[corners[k]], along = side.mesh.vertices[corners[(k + 1) % 3]] - start;
  return start + std::clamp((q - start).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

}  // namespace

bool BorderFades::find(bool vertex_moves, std::uint32_t vertex, std::uint32_t face, const Vector3& p, double height, double most,
                       BorderFade* out) {
  const NearFeatures& near = lists_.near[!vertex_moves];
  const kernels::FaceRecord& record = near.faces.records[face];
  double outside[3];
  bool is_outside = false;
  for (int k = 0; k < 3; ++k) {
    outside[k] = record.sides[k].w - vector3(record.sides[k]).dot(p);
    if (outside[k] <= 0) continue;
    if (FADE_SLOPE * outside[k] > most) return false;
    is_outside = true;
  }
  if (!is_outside) return false;
  const MeshSide& side = pair_.side(!vertex_moves);
  const int name = near.faces.names[face];
  const Vector3 normal = vector3(record.plane), down = height > 0 ? Vector3(-normal) : normal;
  bool fades = false;
  for (int k = 0; k < 3; ++k) {
    if (outside[k] <= 0) continue;
    const BorderKind kind = near.borders[face].of[height > 0][k];
    // Beyond a flat side the plane goes on, and is asked there; beyond a round one the edge is.
    if (kind == BorderKind::FLAT || kind == BorderKind::ROUND) return false;
    fades = fades || kind == BorderKind::RISING ||
            (kind == BorderKind::FALLING && leaves(vertex_moves, vertex, name, k, down, vector3(record.sides[k])));
  }
  if (!fades) return false;
  const Vector3 projection = p - height * normal;
  double nearest2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (outside[k] <= 0) continue;
    const Vector3 foot = closestOnSide(side, name, k, projection);
    const double distance2 = (projection - foot).squaredNorm();
    if (distance2 >= nearest2) continue;
    nearest2 = distance2;
    out->foot = foot;
  }
  out->lost = FADE_SLOPE * std::sqrt(nearest2);
  out->foot = pair_.placed(out->foot, !vertex_moves);
  return out->lost <= most;
}

/** Does nothing take over where the vertex leaves over a border behind which the surface falls? isTakenOver in a few products: over such a
 * border the partner allows the vertex's own contact. @param down, inward face's mesh's frame */
bool BorderFades::leaves(bool vertex_moves, std::uint32_t vertex, int face, int k, const Vector3& down, const Vector3& inward) {
  const MeshSide &side = pair_.side(vertex_moves), &partner = pair_.side(!vertex_moves);
  const int vertex_name = lists_.near[vertex_moves].vertices.names[vertex];
  const Matrix3& R_PS = vertex_moves ? R_FM_ : R_MF_;
  const Vector3 own_down = R_PS.transpose() * down, own_aside = R_PS.transpose() * inward;
  bool leads_down = false;
  for (const EdgeFromVertex& around : surroundings_.ofVertex(side, vertex_name)) {
    const double sine = around.direction.dot(own_down), aside = around.direction.dot(own_aside);
    if (sine <= CONE_SLACK) continue;
    leads_down = true;
    if (!around.is_flat && sine <= NEAR_SUCCESSOR * (sine * sine + aside * aside)) {
      const int border = partner.topology.edgeOf(face, k);
      return !isTakenOver({side, partner, vertex_name, border, R_PS, own_down}, &surroundings_);
    }
  }
  return leads_down;
}

}  // namespace blem_sim
