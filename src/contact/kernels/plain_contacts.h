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

/** @param p as the faces are @param bits of the lanes that have a contact */
inline void appendPlain(const Batch& batch, const Vectors& p, const Vectors& normal, Doubles height, unsigned bits, PlainContacts* out) {
  const ContactPlace& place = out->place;
  Vectors at = p, up = normal;
  if (place.faces_move) {
    at = batch.points(place.vertices, batch.of_a).v;
    up = turnedDirection(place.X_FM, normal);
  }
  const Mask to_a = place.vertices_are_a ? height > 0 : height <= 0;
  const Doubles sign = to_a ? all(1) : all(-1);
  const Vectors foot = at - height * up, n = sign * up, middle = all(0.5) * (at + foot) + all(place.shift) * n;
  const Vectors point = turnedPoint(place.X_WF, middle), normal_BA = turnedDirection(place.X_WF, n);
  const Doubles depth = place.layer - absolute(height);
  alignas(64) double rows[LANES][8];
  const Doubles columns[] = {point.x, point.y, point.z, normal_BA.x, normal_BA.y, normal_BA.z, depth, {}};
  transposed(columns, rows);
  for (; bits != 0; bits &= bits - 1) {
    const int lane = __builtin_ctz(bits);
    const Candidate pair{batch.of_a[lane], batch.of_b[lane]};
    const auto vertex = static_cast<std::uint64_t>(place.vertex_names[pair.a]), face = static_cast<std::uint64_t>(place.face_names[pair.b]);
    ContactRow& row = out->rows[out->count];
    static_assert(sizeof(ContactRow) == sizeof rows[0], "seven numbers and the id");
    __builtin_memcpy(&row, rows[lane], sizeof row);
    row.id = place.kinds | (place.vertices_are_a ? vertex << 32 | face : face << 32 | vertex);
    out->deepest = rows[lane][6] > out->deepest ? rows[lane][6] : out->deepest;
    out->pairs[out->count++] = pair;
  }
}

}  // namespace
}  // namespace blem_sim::kernels
