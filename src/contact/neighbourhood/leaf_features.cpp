#include "neighbourhood/leaf_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "features/feature_cones.h"
#include "kernels/vectors.h"
#include "neighbourhood/border_kind.h"
#include "neighbourhood/leaf_region.h"
#include "neighbourhood/vertex_cone.h"

namespace blem_sim::contact {
namespace {

using kernels::EdgeCone;
using kernels::EdgeRecord;
using kernels::FaceRecord;
using kernels::LeafShapes;
using kernels::Vec4;

/** Writes coordinates, rounded to float, to column i of a block's rows. */
template <int CAPACITY>
void place(const Vec4& v, std::uint32_t i, float (&rows)[3][CAPACITY]) {
  rows[0][i] = static_cast<float>(v.x);
  rows[1][i] = static_cast<float>(v.y);
  rows[2][i] = static_cast<float>(v.z);
}

template <int CAPACITY>
void placePlane(const Vec4& plane, double offset, std::uint32_t i, float (&rows)[4][CAPACITY]) {
  rows[0][i] = static_cast<float>(plane.x);
  rows[1][i] = static_cast<float>(plane.y);
  rows[2][i] = static_cast<float>(plane.z);
  rows[3][i] = static_cast<float>(offset);
}

void placeCone(const kernels::VertexCone& cone, std::uint32_t i, kernels::LeafCones* cones) {
  for (int k = 0; k < 3; ++k) cones->axes[k][i] = cone.axis[k];
  cones->up[i] = cone.up;
  cones->down[i] = cone.down;
  cones->per_slack[i] = cone.per_slack;
  cones->round[i] = -static_cast<std::int32_t>(cone.is_round);
}

void describeFace(const MeshSide& side, int element, SurroundingsMemory* surroundings, LeafFeatures* leaf) {
  const FaceRecord record = faceRecord(side, element);
  const std::uint32_t i = leaf->faces.add(element, record);
  leaf->patches[i] = side.topology.patchOf(element);
  kernels::LeafFaces& faces = leaf->shapes.faces;
  placePlane(record.plane, record.plane.w, i, faces.planes);
  for (int k = 0; k < 3; ++k) placePlane(record.sides[k], record.sides[k].w, i, faces.sides[k]);
  leaf->borders[i] = borderKinds(side, element, surroundings);
  faces.open[i] = openSides(leaf->borders[i]);
}

void describeEdge(const MeshSide& side, int edge, SurroundingsMemory* surroundings, LeafFeatures* leaf) {
  const EdgeRecord record = edgeRecord(side, edge, surroundings);
  const std::uint32_t index = leaf->edges.add(edge, record), i = index % kernels::LEAF_BLOCK;
  kernels::LeafEdges& edges = leaf->shapes.edges[index / kernels::LEAF_BLOCK];
  place(record.start, i, edges.starts);
  for (int k = 0; k < 2; ++k) place(record.inward[k], i, edges.inwards[k]);
  const Vector3 along = vector3(record.along);
  const double length = std::sqrt(record.start.w), fold = (vector3(record.inward[0]) + vector3(record.inward[1])).norm();
  place(vec4(along / length, 0), i, edges.directions);
  edges.lengths[i] = static_cast<float>(length);
  edges.folds[i] = static_cast<float>(record.along.w < 0 ? -fold : fold);
}

void describeVertex(const MeshSide& side, int vertex, SurroundingsMemory* surroundings, std::vector<double>* angles, LeafFeatures* leaf) {
  const Vec4 record = vertexRecord(side, vertex);
  const std::uint32_t i = leaf->vertices.add(vertex, record);
  const std::uint32_t block = i / kernels::LEAF_BLOCK, column = i % kernels::LEAF_BLOCK;
  place(record, column, leaf->shapes.vertices[block].points);
  const kernels::VertexCone cone = vertexCone(side, vertex, surroundings, angles);
  placeCone(cone, column, &leaf->shapes.cones[block]);
  leaf->shapes.nearest |= static_cast<std::uint32_t>(cone.up >= 0 || cone.down >= 0) << i;
}

EdgeCone edgeCone(const std::vector<EdgeRecord>& edges) {
  constexpr double ANY = 4;
  Vector3 middles[kernels::MAX_LEAF_FEATURES], axis = Vector3::Zero();
  double spread = 0, halves[kernels::MAX_LEAF_FEATURES];
  for (std::size_t i = 0; i < edges.size(); ++i) {
    // The middle of the normals that point out of both faces is square to the edge and to this.
    const Vector3 across = vector3(edges[i].inward[0]) - vector3(edges[i].inward[1]);
    middles[i] = vector3(edges[i].along).cross(across).normalized();
    halves[i] = across.norm() > 1.01 ? std::acos(std::min(0.5 * across.norm(), 1.0)) : ANY;
    axis += axis.dot(middles[i]) < 0 ? Vector3(-middles[i]) : middles[i];
  }
  axis.normalize();
  for (std::size_t i = 0; i < edges.size(); ++i)
    spread = std::max(spread, std::acos(std::min(std::abs(axis.dot(middles[i])), 1.0)) + halves[i]);
  spread = std::min(spread, M_PI_2);
  const auto number = [](double value) { return static_cast<float>(value); };
  return {{number(axis.x()), number(axis.y()), number(axis.z())}, number(std::cos(spread)), number(std::sin(spread))};
}

void describe(const MeshSide& side, std::uint32_t index, SurroundingsMemory* surroundings, std::vector<double>* angles,
              LeafFeatures* leaf) {
  const geometry::Bvh::Node& node = side.bvh.nodes()[index];
  assert(node.count <= kernels::MAX_LEAF_ELEMENTS);
  leaf->vertices.clear();
  leaf->faces.clear();
  leaf->edges.clear();
  // Room for the features that most leaves own: grown step by step they take a fifth of all the time here.
  leaf->vertices.records.reserve(node.count);
  leaf->faces.records.reserve(node.count);
  leaf->edges.records.reserve(2 * node.count);
  LeafShapes& shapes = leaf->shapes;
  shapes = LeafShapes{};
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    const int element = static_cast<int>(side.bvh.order()[i]);
    if (side.topology.isFace(element)) describeFace(side, element, surroundings, leaf);
    for (int k = 0; k < 3; ++k) {
      if (side.topology.ownsEdge(element, k)) describeEdge(side, side.topology.edgeOf(element, k), surroundings, leaf);
      if (side.topology.ownsVertex(element, k)) describeVertex(side, side.mesh.elements[element][k], surroundings, angles, leaf);
    }
  }
  Eigen::Map<Eigen::Vector3f>(shapes.middle) = 0.5f * (node.lower + node.upper);
  Eigen::Map<Eigen::Vector3f>(shapes.halves) = 0.5f * (node.upper - node.lower);
  shapes.vertex_count = static_cast<std::uint16_t>(leaf->vertices.records.size());
  shapes.face_count = static_cast<std::uint16_t>(leaf->faces.records.size());
  shapes.edge_count = static_cast<std::uint16_t>(leaf->edges.records.size());
  shapes.edge_cone = edgeCone(leaf->edges.records);
  shapes.region = leafRegion(side, node, *leaf);
}

}  // namespace

FaceRecord faceRecord(const MeshSide& side, int element) {
  const Vector3i& e = side.mesh.elements[element];
  const Vector3 normal = geometry::MeshTopology::normal(side.mesh, element);
  FaceRecord record;
  record.plane = vec4(normal, normal.dot(side.mesh.vertices[e[0]]));
  for (int k = 0; k < 3; ++k) {
    const Vector3& corner = side.mesh.vertices[e[k]];
    const Vector3 inward = normal.cross(side.mesh.vertices[e[(k + 1) % 3]] - corner).normalized();
    record.sides[k] = vec4(inward, inward.dot(corner));
  }
  return record;
}

EdgeRecord edgeRecord(const MeshSide& side, int edge, SurroundingsMemory* surroundings) {
  const geometry::MeshTopology& topology = side.topology;
  const std::array<int, 2> ends = topology.ends(side.mesh, edge);
  const geometry::EdgeFaces faces = topology.facesOf(edge);
  const Vector3 &start = side.mesh.vertices[ends[0]], along = side.mesh.vertices[ends[1]] - start;
  const double length2 = along.squaredNorm(), length = std::sqrt(length2);
  EdgeRecord record{vec4(start, length2), vec4(along, faces.size() > 2 ? 1 : surroundings->ofEdge(side, edge).is_round ? -1 : 0), {}};
  for (int k = 0; k < std::min(faces.size(), 2); ++k) {
    const int face = faces[k];
    // Whether the edge runs along its side by the face's own winding, or against it.
    const Vector3i& e = side.mesh.elements[face];
    const bool forward =
        (e[0] == ends[0] && e[1] == ends[1]) || (e[1] == ends[0] && e[2] == ends[1]) || (e[2] == ends[0] && e[0] == ends[1]);
    record.inward[k] = vec4(geometry::MeshTopology::normal(side.mesh, face).cross(along) / (forward ? length : -length), 0);
  }
  for (int k = 0; k < 2; ++k) record.inward[k].w = kernels::nameBits(ends[k]);
  return record;
}

/** The place that holds the leaf; else the leaf takes that of its few places that was used longest ago, if this search does not use all of
 * them. */
KeptLeaf& LeafMemory::findKept(const MeshSide& side, std::uint32_t leaf, std::uint64_t search) {
  const std::uint64_t key = keyOf(side, leaf);
  Set& set = sets_[key * 0x9E3779B97F4A7C15u >> (64 - SET_BITS)];
  for (std::size_t way = 0; way < WAYS; ++way)
    if (set.keys[way] == key) return set.leaves[way];
  std::size_t oldest = 0;
  for (std::size_t way = 1; way < WAYS; ++way)
    if (set.leaves[way].search < set.leaves[oldest].search) oldest = way;
  if (set.leaves[oldest].search == search) return findCrowdedOut(side, leaf, search);
  set.keys[oldest] = key;
  set.leaves[oldest].is_described = false;
  return set.leaves[oldest];
}

KeptLeaf& LeafMemory::findCrowdedOut(const MeshSide& side, std::uint32_t leaf, std::uint64_t search) {
  if (crowded_search_ != search) crowded_out_.clear();
  crowded_search_ = search;
  return crowded_out_[keyOf(side, leaf)];
}

KeptLeaf& LeafMemory::find(const MeshSide& side, std::uint32_t leaf, std::uint64_t search) {
  KeptLeaf& found = findKept(side, leaf, search);
  if (found.search != search) found.index = {KeptLeaf::NO_INDEX, KeptLeaf::NO_INDEX};
  found.search = search;
  return found;
}

void LeafMemory::describeAnew(const MeshSide& side, std::uint32_t leaf, SurroundingsMemory* surroundings, KeptLeaf* found) {
  if (!found->features) found->features = std::make_unique<LeafFeatures>();
  contact::describe(side, leaf, surroundings, &angles_, found->features.get());
  const LeafShapes& shapes = found->features->shapes;
  found->feature_count = shapes.vertex_count + shapes.face_count + shapes.edge_count;
  found->is_described = true;
}

}  // namespace blem_sim::contact
