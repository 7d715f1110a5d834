// Input and output of the kernels: plain numbers, the same for every instruction set.
#pragma once

#include <cstdint>

#include "features/side.h"

namespace blem_sim::contact::kernels {

struct alignas(32) Vec4 {
  double x, y, z, w;
};

/** Bits of a name, as the w of a vertex holds them, and of an edge for its ends. */
inline double nameBits(std::int64_t name) {
  double bits;
  __builtin_memcpy(&bits, &name, sizeof bits);
  return bits;
}
inline std::int64_t nameOf(double bits) {
  std::int64_t name;
  __builtin_memcpy(&name, &bits, sizeof name);
  return name;
}

/** A face in some frame: signed heights over its plane and inside its three sides, all in metres, as normal . p - offset. */
struct alignas(64) FaceRecord {
  Vec4 plane;     ///< unit normal, offset
  Vec4 sides[3];  ///< unit, in the plane, square to side k and into the face; offset
};

/** Sides k of a face over which a vertex's contact may fade, instead of being taken over by a feature behind: bits k for vertices above its
 * plane, 3 + k for those below; from OPEN_TO_POINTS on the same for points, which have no edges. */
using OpenSides = std::int32_t;
constexpr int OPEN_TO_POINTS = 6;

/** An edge in some frame. */
struct alignas(64) EdgeRecord {
  Vec4 start;      ///< its first vertex; w: squared length
  Vec4 along;      ///< to its second vertex; w: 1 if it has more faces than `inward` tells, -1 if it is round (ROUND_COSINE)
  Vec4 inward[2];  ///< unit, square to it, into its first and second face; zero where there is none; w: nameBits of its vertices
};

/** A rigid motion: rotation by rows, then translation. */
struct Motion {
  double R[9], t[3];
};

/** A pair of features that may have a contact: indices into arrays of records. */
struct Candidate {
  std::uint32_t first, second;
};

/** Candidates one after the other. */
struct CandidateRun {
  const Candidate* data;
  std::uint32_t count;
};

/** Elements of a leaf; room for their features, in blocks of so many side by side. */
constexpr int MAX_LEAF_ELEMENTS = 8, LEAF_BLOCK = 8, LEAF_BLOCKS = 3, MAX_LEAF_FEATURES = LEAF_BLOCKS * LEAF_BLOCK;
static_assert(MAX_LEAF_ELEMENTS <= LEAF_BLOCK && 3 * MAX_LEAF_ELEMENTS <= MAX_LEAF_FEATURES, "elements own up to three edges and vertices");

/** All directions, but for their signs, that a contact's normal at some edge of a leaf may have, without slack. */
struct EdgeCone {
  float axis[3];       ///< unit
  float cosine, sine;  ///< of the widest angle of a normal from the axis; 0, 1: any
};

/** All directions that lead away from a vertex between its edges, so that it is nearest: no farther from the axis than `up` times the part
 * along it, or `down` times the part against it, and, with slack, `per_slack` times that. Negative: none. */
struct VertexCone {
  float axis[3];  ///< unit
  float up, down, per_slack;
  bool is_round;  ///< flat and round edges only (ROUND_COSINE)
};

/** Region where features may lie that have a contact with a leaf's: above or below its box, and beside it by so much. */
struct LeafRegion {
  float axes[3][3];            ///< unit, square to each other; the last one leads up
  float middle[3], halves[3];  ///< of the box of all elements along the axes [m]
  float lean;                  ///< sine of the widest angle of a contact's direction, but for its sign, from `up`; 1: any direction
  float fall;                  ///< distance beside: both these parts of the range, less this one of the height
  float edge_beside;           ///< edges with edges: this part of the range, less the height
};

// Features of a leaf in float, a coordinate after the other, in some frame. What is read together lies together: leaves are many.

struct alignas(32) LeafVertices {
  float points[3][LEAF_BLOCK];
};
/** VertexCone */
struct alignas(32) LeafCones {
  float axes[3][LEAF_BLOCK], up[LEAF_BLOCK], down[LEAF_BLOCK], per_slack[LEAF_BLOCK];
  std::int32_t round[LEAF_BLOCK];  ///< -1 if it is
};
struct alignas(32) LeafFaces {
  float planes[4][LEAF_BLOCK];    ///< FaceRecord::plane
  float sides[3][4][LEAF_BLOCK];  ///< FaceRecord::sides
  OpenSides open[LEAF_BLOCK];
};
struct alignas(32) LeafEdges {
  float starts[3][LEAF_BLOCK], inwards[2][3][LEAF_BLOCK];  ///< EdgeRecord::inward
  float directions[3][LEAF_BLOCK], lengths[LEAF_BLOCK];    ///< unit; [m]
  float folds[LEAF_BLOCK];  ///< length of the sum of EdgeRecord::inward; less than 0 if the edge is round (ROUND_COSINE)
};
struct alignas(64) LeafShapes {
  std::uint16_t face_count, edge_count, vertex_count;
  float middle[3], halves[3];  ///< [m] of a box around all elements
  EdgeCone edge_cone;
  LeafRegion region;
  std::uint32_t nearest;  ///< bits of the vertices that can be the nearest of their surface: those with a VertexCone
  LeafVertices vertices[LEAF_BLOCKS];
  LeafFaces faces;
  LeafEdges edges[LEAF_BLOCKS];
  LeafCones cones[LEAF_BLOCKS];  ///< of the vertices
};

/** Reach of a search for candidates [m]. */
struct LeafReach {
  float range;     ///< of contacts, and the margin
  float margin;    ///< that points may move
  float turn;      ///< that unit vectors may turn (length of the difference)
  float inside;    ///< both ends of an edge may lie so far inside a face of the other one
  float rounding;  ///< that coordinates may be wrong by; part of range, margin and inside
  int open_shift;  ///< OPEN_TO_POINTS where one of the meshes has no edges, else 0
  /** For crossings: rows square to each other; no point moves along any of them by more than its length, but for the rounding. */
  float ways[3][3];
};

/** Reach of candidates that are near [m]. */
struct Reach {
  double range;   ///< of contacts
  double margin;  ///< that points may move
  double turn;    ///< that unit vectors may turn (length of the difference)
};

/** Features of one leaf by their bits, near a feature of another. */
struct LeafHit {
  std::uint32_t feature, bits;
};

/** Pairs of features of two leaves that may have a contact, or a crossing, by the side of the first kind; bits are the other leaf's. */
struct LeafHits {
  PerSide<LeafHit[MAX_LEAF_FEATURES]> vertex_face, vertex_edge, edge_face;
  LeafHit vertex_vertex[MAX_LEAF_FEATURES], edge_edge[MAX_LEAF_FEATURES];
  PerSide<int> vertex_faces, vertex_edges, edge_faces;
  int vertex_vertices, edge_edges;
};

/** A vertex near a face. */
struct VertexFaceHit {
  enum : std::uint32_t {
    OUTSIDE = 7,      ///< bits k: it lies outside side k of the face
    PLAIN = 8,        ///< over the face's inside and not touching: a contact as it stands
    BESIDE = 16,      ///< outside the face
    NEAR_BORDER = 32  ///< or over it and so close to its border that another may lie in the same place
  };
  std::uint32_t candidate, bits;
  double height;  ///< [m] over the face's plane

  bool has(std::uint32_t bit) const { return (bits & bit) != 0; }
};

/** A Contact, number by number. */
struct ContactNumbers {
  double point[3];   ///< [m] world
  double normal[3];  ///< unit, world, from B to A
  double depth;      ///< [m]
  std::uint64_t id;  ///< contactId
  double weight;
  std::uint64_t pierced;
};

/** Vertices of one mesh near faces of the other. */
struct NearVertices {
  const Vec4* records;  ///< in frame F; w: nameBits
  Side side;            ///< of the vertices
  Motion X_MF, X_FM;    ///< read only if the faces move, whose records are in frame M then

  bool facesMove() const { return side == Side::FIXED; }
};

/** Vertices and the faces that candidates pair them with. */
struct VerticesAtFaces {
  NearVertices vertices;
  const FaceRecord* faces;
  const OpenSides* open;  ///< per face
};

/** Candidates of vertices with faces. */
struct VertexFaceRun {
  CandidateRun candidates;
  const std::uint8_t* inner;  ///< as of nearVertexFaces, which changes no contact; null: not known
};

/** Data that place contacts of vertices of one mesh with faces of the other in the world, and name them. */
struct ContactPlace {
  const int* face_names;  ///< per face
  Side vertices, a;       ///< side of the vertices, and the one that is A
  Motion X_FM, X_WF;
  double layer;         ///< [m] rA + rB
  double shift;         ///< [m] (rB - rA) / 2
  std::uint64_t kinds;  ///< contactId of features 0
  bool keeps_feet;      ///< witness points are asked for

  bool verticesAreA() const { return vertices == a; }
};

/** Contacts that need no closer look, as kernels write them. Room for one more than there are candidates. */
struct PlainContacts {
  ContactPlace place;
  ContactNumbers* rows;
  std::uint32_t count;  ///< so far; they are appended
  double deepest;       ///< [m] their largest depth so far
};

/** Corners of a face; its mesh's frame. Side k goes from corner k to the next. */
struct FaceCorners {
  Vec4 of[3];
};

/** A face beside which a vertex lies. */
struct BesideSides {
  std::uint32_t outside;  ///< bits k: outside its side k; not none
  std::uint32_t face;     ///< among FaceCorners
  double reach;           ///< [m] farther beside the face the vertex lies over no other face of the plane
};

/** Vertices and the faces that they lie beside. */
struct VerticesBesideFaces {
  NearVertices vertices;
  const FaceRecord* faces;
  const FaceCorners* corners;
  const BesideSides* sides;  ///< per pair
};

/** The row of a contact that fades, and its pair. */
struct FadingContact {
  std::uint32_t row, pair;
};

/** Contacts that fade, as kernels write them. Room for one more row than there are pairs. */
struct FadingContacts {
  ContactNumbers* rows;
  FadingContact* asked;  ///< those within the face's reach; where witness points are asked for, all
  std::uint32_t asked_count;
};

}  // namespace blem_sim::contact::kernels
