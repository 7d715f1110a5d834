// Features that the leaves of a mesh's tree own, as the kernels want them; worked out when a search first comes to a leaf, and kept.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "features/mesh_pair.h"
#include "kernels/kernels.h"
#include "neighbourhood/border_kind.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** The features that the elements of one leaf own: its faces, and those of its edges and vertices that no other element asks for. */
struct LeafFeatures {
  /** Features of one kind. */
  template <typename Record, int CAPACITY>
  struct Kind {
    int names[CAPACITY];          ///< in the mesh
    std::vector<Record> records;  ///< mesh's frame

    void clear() { records.clear(); }
    /** @return its index */
    std::uint32_t add(int name, const Record& record) {
      const std::uint32_t i = static_cast<std::uint32_t>(records.size());
      names[i] = name;
      records.push_back(record);
      return i;
    }
  };
  kernels::LeafShapes shapes;  ///< in the mesh's frame
  Kind<kernels::Vec4, kernels::MAX_LEAF_FEATURES> vertices;
  Kind<kernels::FaceRecord, kernels::MAX_LEAF_ELEMENTS> faces;
  Kind<kernels::EdgeRecord, kernels::MAX_LEAF_FEATURES> edges;
  int patches[kernels::MAX_LEAF_ELEMENTS];          ///< per face: its plane
  BorderKinds borders[kernels::MAX_LEAF_ELEMENTS];  ///< per face: the kinds of its sides
};

kernels::FaceRecord faceRecord(const MeshSide& side, int element);
kernels::EdgeRecord edgeRecord(const MeshSide& side, int edge, SurroundingsMemory* surroundings);
inline kernels::Vec4 vertexRecord(const MeshSide& side, int vertex) {
  const Vector3& p = side.mesh.vertices[vertex];
  return {p.x(), p.y(), p.z(), kernels::nameBits(vertex)};
}

/** A leaf that has a place, and its numbers that searches read without a look at its features. */
struct KeptLeaf {
  static constexpr std::uint32_t NO_INDEX = 0xFFFFFFFF;

  std::unique_ptr<LeafFeatures> features;  ///< the leaf's once it is described
  std::uint64_t search = 0;                ///< the last one that came here
  PerSide<std::uint32_t> index;            ///< in that search, as a leaf of either mesh; NO_INDEX: none yet
  std::uint32_t feature_count = 0;         ///< vertices, faces and edges
  bool is_described = false;
};

/** Leaves that were looked at lately. The memory changes no result. */
class LeafMemory {
 public:
  /** @return the leaf's place until the search ends */
  KeptLeaf& find(const MeshSide& side, std::uint32_t leaf, std::uint64_t search);
  /** Describes the leaf that was found, if it is not described yet. */
  const LeafFeatures& describe(const MeshSide& side, std::uint32_t leaf, SurroundingsMemory* surroundings, KeptLeaf* found) {
    if (!found->is_described) describeAnew(side, leaf, surroundings, found);
    return *found->features;
  }

 private:
  static constexpr std::size_t SET_BITS = 11, WAYS = 8;  // 16,384 leaves; places that a leaf may have
  /** Leaves that are held, by key. */
  struct alignas(64) Set {
    std::uint64_t keys[WAYS] = {};  // keyOf; 0: free
    KeptLeaf leaves[WAYS];
  };
  static std::uint64_t keyOf(const MeshSide& side, std::uint32_t leaf) { return side.identity << 32 | leaf; }
  void describeAnew(const MeshSide& side, std::uint32_t leaf, SurroundingsMemory* surroundings, KeptLeaf* found);
  KeptLeaf& findKept(const MeshSide& side, std::uint32_t leaf, std::uint64_t search);
  KeptLeaf& findCrowdedOut(const MeshSide& side, std::uint32_t leaf, std::uint64_t search);

  std::vector<Set> sets_ = std::vector<Set>(1u << SET_BITS);
  std::vector<double> angles_;  // room of vertexCone
  // Leaves of the search at hand whose places others of its leaves hold.
  std::map<std::uint64_t, KeptLeaf> crowded_out_;
  std::uint64_t crowded_search_ = 0;
};

}  // namespace blem_sim::contact
