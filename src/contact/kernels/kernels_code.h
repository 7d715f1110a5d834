// The kernels. Included once by each file that is compiled for an instruction set.
// Wide vectors are passed inside that file only.
#pragma GCC diagnostic ignored "-Wpsabi"

#include "kernels/candidate_kernels.h"
#include "kernels/edge_kernels.h"
#include "kernels/kernels.h"
#include "kernels/leaves/leaf_kernels.h"
#include "kernels/rays/depth_kernels.h"
#include "kernels/rays/fan_kernels.h"
#include "kernels/side_feet.h"
#include "kernels/simd.h"
#include "kernels/vertex_face_kernels.h"
#include "kernels/vertex_kernels.h"

namespace blem_sim::contact::kernels {
namespace {

typedef double Quad __attribute__((vector_size(32)));

/** A motion by columns, so that a vector turns in three products. */
struct Turn {
  explicit Turn(const Motion& m)
      : x{m.R[0], m.R[3], m.R[6], 0}, y{m.R[1], m.R[4], m.R[7], 0}, z{m.R[2], m.R[5], m.R[8], 0}, shift{m.t[0], m.t[1], m.t[2], 0} {}
  void direction(const Vec4& in, Vec4* out) const { store(in.x * x + in.y * y + in.z * z, in.w, out); }
  void point(const Vec4& in, Vec4* out) const { store(in.x * x + in.y * y + in.z * z + shift, in.w, out); }
  static void store(Quad v, double w, Vec4* out) {
    *reinterpret_cast<Quad*>(out) = v;
    out->w = w;
  }
  Quad x, y, z, shift;
};

void turnPoints(const Vec4* in, std::uint32_t count, const Motion& motion, Vec4* out) {
  const Turn turn(motion);
  for (std::uint32_t i = 0; i < count; ++i) turn.point(in[i], &out[i]);
}

void turnEdges(const EdgeRecord* in, std::uint32_t count, const Motion& motion, EdgeRecord* out) {
  const Turn turn(motion);
  for (std::uint32_t i = 0; i < count; ++i) {
    turn.point(in[i].start, &out[i].start);
    turn.direction(in[i].along, &out[i].along);
    for (int k = 0; k < 2; ++k) turn.direction(in[i].inward[k], &out[i].inward[k]);
  }
}

void turnFaces(const FaceRecord* in, std::uint32_t count, const Motion& motion, FaceRecord* out) {
  const Turn turn(motion);
  const auto plane = [&](const Vec4& from, Vec4* to) {
    turn.direction(from, to);
    to->w += motion.t[0] * to->x + motion.t[1] * to->y + motion.t[2] * to->z;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    plane(in[i].plane, &out[i].plane);
    for (int k = 0; k < 3; ++k) plane(in[i].sides[k], &out[i].sides[k]);
  }
}

}  // namespace
}  // namespace blem_sim::contact::kernels

#define BLEM_SIM_KERNEL_TABLE(name)                                                                                                   \
  {                                                                                                                                   \
    name, turnPoints, turnEdges, turnFaces, turnLeaf, leafContacts, leafCrossings, nearVertexFaces, nearEdgeEdges, nearVertexEdges,   \
        nearVertexVertices, vertexFaces, sideFeet, edgeEdges, fadingEdges, vertexEdges, vertexVertices, leadingEdges, leadingAtSides, \
        leadTo, edgeFaces, fanLeaves, fanTriangles, drawDepths                                                                        \
  }
