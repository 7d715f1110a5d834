// Contacts of vertices with faces, in the world. Included by the kernels only.
#pragma once

#include "batch.h"

namespace blem_sim::kernels {
namespace {

// Sums in the order of Eigen's, which turns the contacts that come one by one: the same bits.
inline Vectors turnedDirection(const Motion& X, const Vectors& d) {
  const double* const R = X.R;
  return {R[0] * d.x + R[1] * d.y + R[2] * d.z, R[3] * d.x + R[4] * d.y + R[5] * d.z, R[6] * d.x + (R[7] * d.y + R[8] * d.z)};
}
inline Vectors turnedPoint(const Motion& X, const Vectors& p) {
  const auto row = [&](int i) { return X.R[3 * i] * p.x + X.R[3 * i + 1] * p.y + X.R[3 * i + 2] * p.z + X.t[i]; };
  return {row(0), row(1), row(2)};
}

/** The lanes' vertices: where they are, and as the faces see them. */
struct VertexLanes {
  VertexLanes(const Batch& batch, const NearVertices& vertices) : VertexLanes(batch.points(vertices.records, OF_A), vertices) {}

  const Vectors at;  ///< in frame F
  const Mask names;
  const bool faces_move;
  const Vectors seen;  ///< in the faces' mesh's frame

 private:
  VertexLanes(const Rows& rows, const NearVertices& vertices)
      : at(rows.v),
        names(reinterpret_cast<Mask>(rows.w)),
        faces_move(vertices.faces_move),
        seen(vertices.faces_move ? turnedPoint(vertices.X_MF, rows.v) : rows.v) {}
};

/** A contact's place and normal in the world. */
struct WorldContacts {
  Vectors point, normal;
};
/** @param place ContactPlace or EdgePlace @param at, foot in frame F, as the normal, from B to A */
template <typename Place>
inline WorldContacts inWorld(const Place& place, const Vectors& at, const Vectors& foot, const Vectors& normal) {
  const Vectors middle = all(0.5) * (at + foot) + all(place.shift) * normal;
  return {turnedPoint(place.X_WF, middle), turnedDirection(place.X_WF, normal)};
}

/** ContactRow::weight and what follows. */
constexpr struct {
  double weight;
  std::uint64_t pierced;
} UNWEIGHED = {1, 0};

/** Writes a row for every lane; where its bit is not set the next one is written over it. @param bits of the lanes that have a contact
 * @param also is called with every lane and whether it has one @return the last row's end */
template <typename Also>
inline ContactRow* appendRows(const WorldContacts& contacts, Doubles depth, Mask ids, unsigned bits, ContactRow* row, Also&& also) {
  const auto& [point, normal] = contacts;
  transposed({point.x, point.y, point.z, normal.x, normal.y, normal.z, depth, reinterpret_cast<Doubles>(ids)}, [&](int lane) {
    double* const now = row->point;
    __builtin_memcpy(&row->weight, &UNWEIGHED, sizeof UNWEIGHED);
    const unsigned has_one = bits >> lane & 1;
    also(lane, has_one);
    row += has_one;
    return now;
  });
  return row;
}

/** @param plain null: nothing is raised */
template <typename Plain>
inline void raiseDeepest(Doubles deepest, Plain* plain) {
  for (int i = 0; plain && i < LANES; ++i) plain->deepest = deepest[i] > plain->deepest ? deepest[i] : plain->deepest;
}

/** contactId of the lanes' vertices and faces. */
template <typename Faces>
inline Mask idsOf(const VertexLanes& vertices, const Faces& faces, const ContactPlace& place) {
  const Mask vertex = vertices.names, face = faces.numbers(place.face_names);
  const Mask names = place.vertices_are_a ? vertex << 32 | face : face << 32 | vertex;
  return names | static_cast<long>(place.kinds);
}

/** @param bits of the lanes that have a contact @return depths */
template <typename Faces>
inline Doubles appendPlain(const Batch& batch, const Faces& faces, const VertexLanes& vertices, const Vectors& normal, Doubles height,
                           unsigned bits, PlainContacts* out) {
  const ContactPlace& place = out->place;
  const Vectors &at = vertices.at, up = vertices.faces_move ? turnedDirection(place.X_FM, normal) : normal;
  const Mask to_a = place.vertices_are_a ? height > 0 : height <= 0;
  const Doubles sign = to_a ? all(1) : all(-1), depth = place.layer - absolute(height);
  const WorldContacts contacts = inWorld(place, at, at - height * up, sign * up);
  Candidate* pair = out->pairs + out->count;
  const ContactRow* const end = appendRows(contacts, depth, idsOf(vertices, faces, place), bits, out->rows + out->count,
                                           [&pair, lanes = batch.lanes](int lane, unsigned has_one) {
                                             *pair = lanes[lane];
                                             pair += has_one;
                                           });
  out->count = static_cast<std::uint32_t>(end - out->rows);
  return depth;
}

}  // namespace
}  // namespace blem_sim::kernels
