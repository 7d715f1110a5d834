#include "evaluation/exact_tests.h"

#include <algorithm>

#include "evaluation/leaving_vertex.h"
#include "features/edge_pair.h"
#include "features/face_borders.h"
#include "features/feature_cones.h"
#include "kernels/kernels.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {

// ---- a vertex over a face

bool ExactTests::vertexFace(Side side, int name, int element) {
  const FaceShape face = faceShape(pair_, !side, element);
  const Vector3 p = position(side, name);
  const double height = face.normal.dot(p - face.corners[0]);
  if (!holdsProjection(face, p)) return false;
  if (std::abs(height) > pair_.range) return true;
  const Feature vertex{FeatureKind::VERTEX, name}, patch{FeatureKind::FACE, pair_.side(!side).topology.patchOf(element)};
  // From fixed to moving: towards the vertex if it is the moving mesh's.
  Vector3 normal = (height > 0) == (side == Side::MOVING) ? face.normal : Vector3(-face.normal);
  if (std::abs(height) <= TOUCH) {
    if (!reachesOver(side, name, p, face)) return true;
    normal = side == Side::MOVING ? towardsMoving(pair_, normal, vertex, patch, p) : towardsMoving(pair_, normal, patch, vertex, p);
  }
  contacts_.add(pair_, contactBetween(side, {vertex, p}, {patch, p - height * face.normal}, normal, std::abs(height)));
  return true;
}

/** Whether the surface of a vertex that touches a face's border extends over the face, not only beside it. */
bool ExactTests::reachesOver(Side side, int vertex, const Vector3& p, const FaceShape& face) const {
  const MeshSide &vertex_side = pair_.side(side), &face_side = pair_.side(!side);
  if (vertex_side.topology.edgesOf(vertex).empty()) return true;
  const EdgesAtVertex edges = surroundings_.ofVertex(vertex_side, vertex);
  bool reaches = true;
  forEachBorderAt(pair_, face, !side, p, [&](int border, int border_face) {
    Vector3 inward = pair_.turned(face_side.topology.inward(face_side.mesh, border, border_face), !side);
    if (side == Side::MOVING) inward = R_FM_.transpose() * inward;
    reaches = reaches && !vertexConeAllows(edges, inward, CONE_SLACK);
  });
  return reaches;
}

// ---- edge and edge

void ExactTests::edgeEdge(int moving, int fixed, const kernels::EdgeRecord& record_m, const kernels::EdgeRecord& record_f) {
  const Vector3 p = vector3(record_m.start), q = vector3(record_f.start);
  EdgePair feet;
  if (!findEdgePair({p, p + vector3(record_m.along)}, {q, q + vector3(record_f.along)}, pair_.range, &feet)) return;
  const Feature m{FeatureKind::EDGE, moving}, f{FeatureKind::EDGE, fixed};
  Vector3 normal = feet.offset < 0 ? Vector3(-feet.axis) : feet.axis;
  const double gap = std::abs(feet.offset);
  if (gap <= TOUCH) normal = towardsMoving(pair_, normal, m, f, feet.point_q);
  if (gap <= pair_.range && conesAllow(m, f, normal, EDGE_CONE_SLACK))
    contacts_.add(pair_, {m, f, feet.point_p, feet.point_q, normal, gap});
}

void ExactTests::fadingEdges(int moving, int fixed, const kernels::FadingEdgesHit& hit) {
  const Feature m{FeatureKind::EDGE, moving}, f{FeatureKind::EDGE, fixed};
  const Vector3 axis(hit.normal);
  if (!hit.cones_known && !conesAllow(m, f, axis, EDGE_CONE_SLACK)) return;
  const auto leaves = [&](int vertex, Side side, int partner, const Matrix3& R_PS, const Vector3& normal) {
    return !isTakenOver({pair_.side(side), pair_.side(!side), vertex, partner, R_PS, normal}, &surroundings_);
  };
  const bool fades = (hit.end_m >= 0 && leaves(hit.end_m, Side::MOVING, fixed, R_FM_, -(R_FM_.transpose() * axis))) ||
                     (hit.end_f >= 0 && leaves(hit.end_f, Side::FIXED, moving, R_FM_.transpose(), axis));
  if (!fades) return;
  const Vector3 point_m(hit.point_m), point_f(hit.point_f);
  contacts_.add(pair_, {m, f, point_m, point_f, (point_m - point_f) / hit.distance, hit.gap});
}

// ---- vertex and edge, vertex and vertex: where each is the other's local minimum, and around round edges and vertices

void ExactTests::vertexEdge(Side side, int vertex, int edge, const Vector3& p, const kernels::EdgeRecord& record) {
  if (record.along.w < 0 && addAtRoundEdge(side, vertex, edge, p, record)) return;
  const Vector3 q = vector3(record.start), along = vector3(record.along);
  const double length2 = along.squaredNorm(), part = (p - q).dot(along);
  if (!edge_pair_detail::isInside(part, length2, length2)) return;
  const Vector3 foot = q + part / length2 * along;
  const Vector3 d = p - foot;
  if (d.squaredNorm() > pair_.range * pair_.range) return;
  if (side == Side::MOVING) {
    addLocalMinimum({FeatureKind::VERTEX, vertex}, {FeatureKind::EDGE, edge}, p, foot, along);
  } else {
    addLocalMinimum({FeatureKind::EDGE, edge}, {FeatureKind::VERTEX, vertex}, foot, p, along);
  }
}

bool ExactTests::leadsTo(Side side, int vertex, const Vector3& d) const {
  const double distance2 = d.squaredNorm();
  if (distance2 <= TOUCH * TOUCH) return false;
  constexpr double SURE = 1.001 * CONE_SLACK;
  const Vector3 towards = side == Side::MOVING ? Vector3(-(R_FM_.transpose() * d)) : Vector3(-d);
  const EdgesAtVertex edges = surroundings_.ofVertex(pair_.side(side), vertex);
  return kernels::kernels().leadTo(edges.blocks, edges.block_count, towards.data(), SURE * SURE * distance2);
}

/** Contact at a round edge. Beyond the edge's ends, but for round ones, which take over, it fades. @return false if they touch */
bool ExactTests::addAtRoundEdge(Side side, int vertex, int edge, const Vector3& p, const kernels::EdgeRecord& record) {
  const Vector3 start = vector3(record.start), along = vector3(record.along);
  const double length2 = along.squaredNorm(), part = (p - start).dot(along) / length2, clamped = std::clamp(part, 0.0, 1.0);
  const Vector3 foot = start + clamped * along, d = p - foot;
  const double distance = d.norm(), gap = distance + FADE_SLOPE * std::abs(part - clamped) * std::sqrt(length2);
  if (distance <= TOUCH) return false;
  if (gap > pair_.range) return true;
  for (const kernels::Vec4& inward : record.inward)
    if (vector3(inward).dot(d) > CONE_SLACK * distance) return true;
  if (part != clamped) {
    const MeshSide& partner = pair_.side(!side);
    const EdgesAtVertex edges = surroundings_.ofVertex(partner, static_cast<int>(kernels::nameOf(record.inward[part > 1].w)));
    if (isRoundVertex(partner, edges, side == Side::MOVING ? d : Vector3(R_FM_.transpose() * d), &surroundings_)) return true;
  }
  const Witness at{{FeatureKind::VERTEX, vertex}, p}, on{{FeatureKind::EDGE, edge}, foot};
  contacts_.add(pair_, contactBetween(side, at, on, (side == Side::MOVING ? 1 : -1) / distance * d, gap));
  return true;
}

void ExactTests::vertexVertex(int moving, int fixed) {
  const Vector3 p = position(Side::MOVING, moving), &q = pair_.fixed.mesh.vertices[fixed];
  const Vector3 d = p - q;
  const double gap = d.norm();
  if (gap > pair_.range) return;
  const Feature m{FeatureKind::VERTEX, moving}, f{FeatureKind::VERTEX, fixed};
  if (gap <= TOUCH) return addLocalMinimum(m, f, p, q, Vector3::Zero());
  const Vector3 normal = d / gap, inverse = -(R_FM_.transpose() * normal);
  // Whether the vertex's cone allows the direction, and whether the vertex is round besides.
  const auto cone = [&](Side side, int vertex, const Vector3& direction) {
    const MeshSide& mesh = pair_.side(side);
    const EdgesAtVertex edges = surroundings_.ofVertex(mesh, vertex);
    const bool allows = vertexConeAllows(edges, direction, CONE_SLACK);
    return std::make_pair(allows, allows && isRoundVertex(mesh, edges, direction, &surroundings_));
  };
  const auto [f_allows, f_round] = cone(Side::FIXED, fixed, normal);
  if (!f_round) {
    const auto [m_allows, m_round] = cone(Side::MOVING, moving, inverse);
    if (!m_round && !(f_allows && m_allows)) return;
  }
  contacts_.add(pair_, {m, f, p, q, normal, gap});
}

/** @param along direction of the edge, to which the normal is square; zero if there is none */
void ExactTests::addLocalMinimum(const Feature& m, const Feature& f, const Vector3& point_M, const Vector3& point_F, const Vector3& along) {
  const Vector3 d = point_M - point_F;
  const double gap = d.norm();
  const Vector3 normal = gap > TOUCH ? Vector3(d / gap) : touchNormal(pair_, m, f, point_F, along);
  if (conesAllow(m, f, normal, CONE_SLACK)) contacts_.add(pair_, {m, f, point_M, point_F, normal, gap});
}

bool ExactTests::conesAllow(const Feature& m, const Feature& f, const Vector3& normal, double slack) const {
  return coneAllows(Side::FIXED, f, normal, slack) && coneAllows(Side::MOVING, m, -(R_FM_.transpose() * normal), slack);
}

bool ExactTests::coneAllows(Side side, const Feature& feature, const Vector3& direction, double slack) const {
  const MeshSide& mesh = pair_.side(side);
  return feature.kind == FeatureKind::VERTEX ? vertexConeAllows(surroundings_.ofVertex(mesh, feature.index), direction, slack)
                                             : edgeConeAllows(mesh, feature.index, direction, slack, &surroundings_);
}

}  // namespace blem_sim::contact
