// Features of a leaf, several side by side or one in all lanes, in float. Included by the kernels only.
#pragma once

#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

inline Floats row(const float* from) { return *reinterpret_cast<const Floats*>(from); }
inline FloatMask maskRow(const std::int32_t* from) { return *reinterpret_cast<const FloatMask*>(from); }

/** Coordinates of several features, or of one in all lanes. */
inline FloatVectors severalVectors(const float (&from)[3][LEAF_BLOCK], std::uint32_t first) {
  return {row(&from[0][first]), row(&from[1][first]), row(&from[2][first])};
}
inline FloatVectors oneVector(const float (&from)[3][LEAF_BLOCK], std::uint32_t i) {
  return {allFloats(from[0][i]), allFloats(from[1][i]), allFloats(from[2][i])};
}

/** Planes, by their normal and offset: several, or one in all lanes. */
struct FloatPlanes {
  FloatVectors normal;
  Floats offset;

  static FloatPlanes several(const float (&from)[4][LEAF_BLOCK], std::uint32_t first) {
    return {{row(&from[0][first]), row(&from[1][first]), row(&from[2][first])}, row(&from[3][first])};
  }
  static FloatPlanes one(const float (&from)[4][LEAF_BLOCK], std::uint32_t i) {
    return {{allFloats(from[0][i]), allFloats(from[1][i]), allFloats(from[2][i])}, allFloats(from[3][i])};
  }
  Floats above(const FloatVectors& p) const { return dot(normal, p) - offset; }
};

struct FloatFaces {
  FloatFaces(const LeafFaces& faces, std::uint32_t first)
      : plane(FloatPlanes::several(faces.planes, first)),
        sides{FloatPlanes::several(faces.sides[0], first), FloatPlanes::several(faces.sides[1], first),
              FloatPlanes::several(faces.sides[2], first)},
        open(maskRow(&faces.open[first])) {}
  FloatPlanes plane, sides[3];
  FloatMask open;
};

/** Block that holds feature i of a leaf. */
template <typename Block>
inline const Block& blockOf(const Block (&blocks)[LEAF_BLOCKS], std::uint32_t i) {
  return blocks[i / LEAF_BLOCK];
}
template <typename Block>
inline Block& blockOf(Block (&blocks)[LEAF_BLOCKS], std::uint32_t i) {
  return blocks[i / LEAF_BLOCK];
}

inline FloatVectors oneVertex(const LeafShapes& leaf, std::uint32_t i) {
  return oneVector(blockOf(leaf.vertices, i).points, i % LEAF_BLOCK);
}
inline FloatVectors severalVertices(const LeafShapes& leaf, std::uint32_t first) {
  return severalVectors(blockOf(leaf.vertices, first).points, first % LEAF_BLOCK);
}

struct FloatEdge {
  FloatVectors start, along, inward[2];
};
inline FloatEdge oneEdge(const LeafShapes& leaf, std::uint32_t index) {
  const LeafEdges& edges = blockOf(leaf.edges, index);
  const std::uint32_t i = index % LEAF_BLOCK;
  return {oneVector(edges.starts, i),
          allFloats(edges.lengths[i]) * oneVector(edges.directions, i),
          {oneVector(edges.inwards[0], i), oneVector(edges.inwards[1], i)}};
}
inline FloatEdge severalEdges(const LeafEdges& edges, std::uint32_t first) {
  return {severalVectors(edges.starts, first),
          row(&edges.lengths[first]) * severalVectors(edges.directions, first),
          {severalVectors(edges.inwards[0], first), severalVectors(edges.inwards[1], first)}};
}

/** Bits of the features for which test(first of some lanes) holds. */
template <typename Test>
inline std::uint32_t bitsWhere(std::uint32_t count, Test&& test) {
  std::uint32_t bits = 0;
  for (std::uint32_t first = 0; first < count; first += FLOAT_LANES) bits |= bitsOf(test(first)) << first;
  return count < 32 ? bits & ((1u << count) - 1) : bits;
}

/** The same of edges: test(block, first in it). */
template <typename Test>
inline std::uint32_t edgesWhere(const LeafShapes& leaf, Test&& test) {
  return bitsWhere(leaf.edge_count, [&](std::uint32_t i) { return test(blockOf(leaf.edges, i), i % LEAF_BLOCK); });
}

template <typename Visit>
inline void forEachBit(std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::uint32_t>(__builtin_ctz(bits)));
}

}  // namespace
}  // namespace blem_sim::contact::kernels
