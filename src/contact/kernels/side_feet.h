// Vertices beside faces: where on a side of the face the contact is. Included by the kernels only.
#pragma once

#include "plain_contacts.h"

namespace blem_sim::kernels {
namespace {

/** The closest point of the side to the vertex's projection into the face's plane. */
inline Vectors closestOnSide(const Rows& start, const Rows& along, const Vectors& projection) {
  const Doubles part = clampedToUnit(dot(projection - start.v, along.v) / dot(along.v, along.v));
  return start.v + part * along.v;
}

void sideFeet(const ContactPlace& place, const NearVertices& vertices, const FaceRecord* faces, const BesideSide* sides,
              const Candidate* pairs, std::uint32_t count, SideFoot* feet) {
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Batch batch(pairs, first, count);
    const Vectors at = batch.points(vertices.records, OF_A).v, p = seenByFaces(vertices, at);
    const Rows plane = batch.field(faces, OF_B, &FaceRecord::plane);
    const Vectors projection = p - above(p, plane) * plane.v;
    const Vec4 *starts[LANES], *alongs[LANES];
    for (int i = 0; i < LANES; ++i) {
      const BesideSide& side = sides[first + i < count ? first + i : count - 1];
      starts[i] = &side.start;
      alongs[i] = &side.along;
    }
    Vectors foot = closestOnSide(gathered(starts), gathered(alongs), projection);
    const Vectors beside = projection - foot;
    const Doubles lost = FADE_SLOPE * squareRoot(dot(beside, beside));
    if (vertices.faces_move) foot = turnedPoint(place.X_FM, foot);
    const bool from_foot = place.keeps_feet ? !vertices.faces_move : place.vertices_are_a;
    const Vectors d = from_foot ? at - foot : foot - at;
    const Doubles distance = squareRoot(dot(d, d));
    const Vectors normal{d.x / distance, d.y / distance, d.z / distance};
    const auto [point, direction] = place.keeps_feet ? WorldContacts{foot, normal} : inWorld(place, at, foot, normal);
    SideFoot behind_last;
    transposed({point.x, point.y, point.z, direction.x, direction.y, direction.z, distance, lost},
               [&](int lane) { return first + lane < count ? feet[first + lane].point : behind_last.point; });
  }
}

}  // namespace
}  // namespace blem_sim::kernels
