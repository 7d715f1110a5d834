// Vertices beside faces: places of their contacts on the faces' sides. Included by the kernels only.
#pragma once

#include "kernels/plain_contacts.h"

namespace blem_sim::contact::kernels {
namespace {

/** The closest point of the side to the vertex's projection into the face's plane. */
inline Vectors closestOnSide(const Vectors& start, const Vectors& end, const Vectors& projection) {
  const Vectors along = end - start;
  const Doubles part = clampedToUnit(dot(projection - start, along) / dot(along, along));
  return start + part * along;
}

inline Vectors chosen(Mask first, const Vectors& a, const Vectors& b) { return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z}; }

/** Places of contacts, and the depth [m] that they lose there, since the vertices lie beside their faces. */
struct FeetOnSides {
  Vectors foot;
  Doubles lost;
};

/** Foot of each lane's contact, on the nearest of the sides. @param projection of the vertex into the face's plane */
inline FeetOnSides nearestFeet(const BesideSides* sides, std::uint32_t count, const FaceCorners* corners, const Vectors& projection) {
  constexpr int NEXT[] = {1, 2, 0};
  FeetOnSides nearest{{}, all(__builtin_inf())};
  const FaceCorners* faces[LANES];
  std::uint32_t left[LANES], more;
  for (std::uint32_t i = 0; i < LANES; ++i) {
    const BesideSides& side = sides[i < count ? i : 0];
    faces[i] = &corners[side.face];
    left[i] = side.outside;
  }
  do {
    more = 0;
    const Vec4 *starts[LANES], *ends[LANES];
    for (int i = 0; i < LANES; ++i) {
      const int k = __builtin_ctz(left[i]);
      starts[i] = &faces[i]->of[k];
      ends[i] = &faces[i]->of[NEXT[k]];
      const std::uint32_t others = left[i] & (left[i] - 1);
      if (others != 0) left[i] = others;  // else its last side is asked again
      more |= others;
    }
    const Vectors foot = closestOnSide(gathered(starts).v, gathered(ends).v, projection), beside = projection - foot;
    const Doubles lost = FADE_SLOPE * squareRoot(dot(beside, beside));
    const Mask nearer = lost < nearest.lost;
    nearest = {chosen(nearer, foot, nearest.foot), nearer ? lost : nearest.lost};
  } while (more != 0);
  return nearest;
}

/** Reach [m] of each lane's plane beside its face. */
inline Doubles reaches(const BesideSides* sides, std::uint32_t count) {
  Doubles reach;
  for (std::uint32_t i = 0; i < LANES; ++i) reach[i] = sides[i < count ? i : 0].reach;
  return reach;
}

std::uint32_t sideFeet(const ContactPlace& place, const VerticesBesideFaces& features, CandidateRun pairs, double range,
                       FadingContacts* out) {
  const NearVertices& vertices = features.vertices;
  const FaceRecord* const faces = features.faces;
  const BesideSides* const sides = features.sides;
  const std::uint32_t count = pairs.count;
  ContactNumbers* row = out->rows;
  out->asked_count = 0;
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Batch batch(pairs, first);
    const Rows points = batch.points(vertices.records, OF_FIRST);
    const Vectors &at = points.v, p = seenByFaces(vertices, at);
    const Rows plane = batch.field(faces, OF_SECOND, &FaceRecord::plane);
    auto [foot, lost] = nearestFeet(sides + first, count - first, features.corners, p - above(p, plane) * plane.v);
    if (vertices.facesMove()) foot = turnedPoint(place.X_FM, foot);
    const bool from_foot = place.keeps_feet ? !vertices.facesMove() : place.verticesAreA();
    const Vectors d = from_foot ? at - foot : foot - at;
    const Doubles distance = squareRoot(dot(d, d)), gap = distance + lost;
    const Vectors normal{d.x / distance, d.y / distance, d.z / distance};
    const WorldContacts contacts = place.keeps_feet ? WorldContacts{foot, normal} : inWorld(place, at, foot, normal);
    const unsigned bits = bitsOf((distance > TOUCH) & (gap <= range)) & batch.valid,
                   near = bits & bitsOf(lost <= FADE_SLOPE * reaches(sides + first, count - first));
    for (unsigned asked = place.keeps_feet ? bits : near; asked != 0; asked &= asked - 1) {
      const int lane = __builtin_ctz(asked), before = __builtin_popcount(bits & ((1u << lane) - 1));
      out->asked[out->asked_count++] = {static_cast<std::uint32_t>(row - out->rows + before), first + lane};
    }
    row = appendRows(contacts, place.keeps_feet ? gap : place.layer - gap, idsOf(points, EachFace{batch, faces}, place), bits, row);
  }
  return static_cast<std::uint32_t>(row - out->rows);
}

}  // namespace
}  // namespace blem_sim::contact::kernels
