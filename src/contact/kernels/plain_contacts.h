// Contacts of vertices with faces, in the world. Included by the kernels only.
#pragma once

#include "kernels/batch.h"

namespace blem_sim::contact::kernels {
namespace {

// Sums in the order of Eigen's, which turns the contacts that come one by one: the same bits.
template <typename Lanes>
inline VectorsOf<Lanes> turnedDirection(const Motion& X, const VectorsOf<Lanes>& d) {
  const double* const R = X.R;
  return {R[0] * d.x + R[1] * d.y + R[2] * d.z, R[3] * d.x + R[4] * d.y + R[5] * d.z, R[6] * d.x + (R[7] * d.y + R[8] * d.z)};
}
inline Vectors turnedPoint(const Motion& X, const Vectors& p) {
  const auto row = [&](int i) { return X.R[3 * i] * p.x + X.R[3 * i + 1] * p.y + X.R[3 * i + 2] * p.z + X.t[i]; };
  return {row(0), row(1), row(2)};
}

/** Points in the frame of the faces' mesh. @param at in frame F */
inline Vectors seenByFaces(const NearVertices& vertices, const Vectors& at) {
  return vertices.facesMove() ? turnedPoint(vertices.X_MF, at) : at;
}

/** A face's plane in frame F: of lanes, or of one face. */
template <typename Lanes>
struct PlaneInF {
  /** @param normal, offset in the face's mesh's frame */
  PlaneInF(const NearVertices& vertices, const VectorsOf<Lanes>& normal, Lanes offset) : up(normal), offset(offset) {
    if (!vertices.facesMove()) return;
    const double* const t = vertices.X_FM.t;
    up = turnedDirection(vertices.X_FM, normal);
    this->offset = offset + (t[0] * up.x + t[1] * up.y + t[2] * up.z);
  }
  Doubles height(const Vectors& at) const { return at.x * up.x + at.y * up.y + at.z * up.z - offset; }

  VectorsOf<Lanes> up;  ///< unit
  Lanes offset;
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

/** ContactNumbers::weight and the fields behind it. */
constexpr struct {
  double weight;
  std::uint64_t pierced;
} UNWEIGHED = {1, 0};

/** Writes a row for every lane; where its bit is not set the next one is written over it. @param bits of the lanes that have a contact
 * @return the last row's end */
inline ContactNumbers* appendRows(const WorldContacts& contacts, Doubles depth, Mask ids, unsigned bits, ContactNumbers* row) {
  const auto& [point, normal] = contacts;
  transposed({point.x, point.y, point.z, normal.x, normal.y, normal.z, depth, reinterpret_cast<Doubles>(ids)}, [&](int lane) {
    double* const now = row->point;
    __builtin_memcpy(&row->weight, &UNWEIGHED, sizeof UNWEIGHED);
    row += bits >> lane & 1;
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
inline Mask idsOf(const Rows& vertices, const Faces& faces, const ContactPlace& place) {
  const Mask vertex = reinterpret_cast<Mask>(vertices.w), face = faces.numbers(place.face_names);
  const Mask names = place.verticesAreA() ? vertex << 32 | face : face << 32 | vertex;
  return names | static_cast<long>(place.kinds);
}

/** Vertices over faces, or beside them. */
template <typename Faces>
struct OverFaces {
  const Faces& faces;
  Rows vertices;
  Doubles height;  ///< [m] over the faces' planes
};
template <typename Faces>
OverFaces(const Faces&, const Rows&, Doubles) -> OverFaces<Faces>;

/** @param up_W the faces' normals @param bits of the lanes that have a contact @return depths */
template <typename Faces, typename Lanes>
[[gnu::always_inline]] inline Doubles appendPlain(const OverFaces<Faces>& lanes, const VectorsOf<Lanes>& up_W, unsigned bits,
                                                  PlainContacts* out) {
  const ContactPlace& place = out->place;
  const Doubles height = lanes.height;
  const Mask to_a = place.verticesAreA() ? height > 0 : height <= 0;
  const Doubles sign = to_a ? all(1) : all(-1), depth = place.layer - absolute(height), beside = sign * place.shift - 0.5 * height;
  const Vectors at = turnedPoint(place.X_WF, lanes.vertices.v);
  const WorldContacts contacts{{at.x + beside * up_W.x, at.y + beside * up_W.y, at.z + beside * up_W.z},
                               {sign * up_W.x, sign * up_W.y, sign * up_W.z}};
  const ContactNumbers* const end = appendRows(contacts, depth, idsOf(lanes.vertices, lanes.faces, place), bits, out->rows + out->count);
  out->count = static_cast<std::uint32_t>(end - out->rows);
  return depth;
}

/** Planes of faces in frame F, and their normals in the world; those of one face in all lanes are kept. */
class FacePlanes {
 public:
  FacePlanes(const NearVertices& vertices, const PlainContacts* plain)
      : vertices_(vertices), X_WF_(plain ? plain->place.X_WF : vertices.X_FM) {}

  PlaneInF<Doubles> of(const EachFace& faces) const {
    const Rows plane = faces.plane();
    return {vertices_, plane.v, plane.w};
  }
  const PlaneInF<double>& of(const OneFace& faces) {
    if (index_ != faces.index) {
      const Vec4& plane = faces.face.plane;
      plane_ = {vertices_, {plane.x, plane.y, plane.z}, plane.w};
      up_W_ = turnedDirection(X_WF_, plane_.up);
      index_ = faces.index;
    }
    return plane_;
  }
  Vectors upInWorld(const PlaneInF<Doubles>& plane) const { return turnedDirection(X_WF_, plane.up); }
  const VectorsOf<double>& upInWorld(const PlaneInF<double>&) const { return up_W_; }

 private:
  const NearVertices& vertices_;
  const Motion& X_WF_;
  std::uint32_t index_ = 0xFFFFFFFF;  ///< face whose the other fields are
  PlaneInF<double> plane_{vertices_, {}, 0};
  VectorsOf<double> up_W_{};
};

}  // namespace
}  // namespace blem_sim::contact::kernels
