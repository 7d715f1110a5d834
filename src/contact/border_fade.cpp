#include "border_fade.h"

#include <algorithm>
#include <cmath>

#include "feature_cones.h"
#include "vectors.h"

namespace blem_sim {
namespace {

/** The point of side k that is closest to q; mesh's frame. */
Vector3 closestOnSide(const FaceBorders& borders, int k, const Vector3& q) {
  const Vector3 &start = borders.corners[k], along = borders.corners[(k + 1) % 3] - start;
  return start + std::clamp((q - start).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

}  // namespace

bool BorderFades::find(bool vertex_moves, std::uint32_t vertex, std::uint32_t face, const Vector3& p, double height, double most,
                       BorderFade* out) {
  NearFeatures& near = lists_.near[!vertex_moves];
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
  const FaceBorders& borders = near.borders(pair_.side(!vertex_moves), face);
  const Vector3 normal = vector3(record.plane), down = height > 0 ? Vector3(-normal) : normal;
  bool fades = false;
  for (int k = 0; k < 3; ++k) {
    if (outside[k] <= 0) continue;
    const BorderKind kind = borders.kinds[height > 0][k];
    // Beyond a flat side the plane goes on, and is asked there; beyond a round one the edge is.
    if (kind == BorderKind::FLAT || kind == BorderKind::ROUND) return false;
    fades = fades || kind == BorderKind::RISING ||
            (kind == BorderKind::FALLING && leaves(vertex_moves, vertex, near.faces.names[face], k, down, vector3(record.sides[k])));
  }
  if (!fades) return false;
  const Vector3 projection = p - height * normal;
  double nearest2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (outside[k] <= 0) continue;
    const Vector3 foot = closestOnSide(borders, k, projection);
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
  NearFeatures& near = lists_.near[vertex_moves];
  const Matrix3 R_PS = vertex_moves ? Matrix3(pair_.X_FM.linear()) : Matrix3(pair_.X_FM.linear().transpose());
  const Vector3 own_down = R_PS.transpose() * down, own_aside = R_PS.transpose() * inward;
  bool leads_down = false;
  const VertexRing ring = near.ring(side, vertex);
  for (std::uint32_t i = ring.begin; i < ring.end; ++i) {
    const Vector3 w = vector3(near.ring_directions[i]);
    const double sine = w.dot(own_down), aside = w.dot(own_aside);
    if (sine <= CONE_SLACK) continue;
    leads_down = true;
    const bool flat = near.ring_directions[i].w != 0;
    if (!flat && sine <= NEAR_SUCCESSOR * (sine * sine + aside * aside)) {
      const int border = partner.topology.edgeOf(face, k);
      return !isTakenOver({side, partner, near.vertices.names[vertex], border, R_PS, own_down});
    }
  }
  return leads_down;
}

}  // namespace blem_sim
