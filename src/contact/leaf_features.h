// What the leaves of a mesh's tree own, as the kernels want it; worked out when a search first comes to a leaf, and kept.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "border_kind.h"
#include "kernels/kernels.h"
#include "mesh_pair.h"

namespace blem_sim {

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
  static constexpr std::uint32_t NO_INDEX = 0xFFFFFFFF;

  std::uint64_t search = 0;    ///< the last search that came here: the index and a moving leaf's turned shapes are of it
  std::uint32_t index;         ///< what that search calls it; NO_INDEX: nothing yet
  kernels::LeafShapes shapes;  ///< in the mesh's frame
  Kind<kernels::Vec4, kernels::MAX_LEAF_FEATURES> vertices;
  Kind<kernels::FaceRecord, kernels::MAX_LEAF_ELEMENTS> faces;
  Kind<kernels::EdgeRecord, kernels::MAX_LEAF_FEATURES> edges;
  int patches[kernels::MAX_LEAF_ELEMENTS];          ///< of the faces
  BorderKinds borders[kernels::MAX_LEAF_ELEMENTS];  ///< of the faces
  std::unique_ptr<kernels::LeafShapes> turned;      ///< of a moving leaf, in the frame of the search
};

kernels::FaceRecord faceRecord(const MeshSide& side, int element);
kernels::EdgeRecord edgeRecord(const MeshSide& side, int edge);
inline kernels::Vec4 vertexRecord(const MeshSide& side, int vertex) {
  const Vector3& p = side.mesh.vertices[vertex];
  return {p.x(), p.y(), p.z(), 0};
}

/** Leaves that were looked at lately. What is kept changes no result. */
class LeafMemory {
 public:
  /** Leaf of a mesh that stands. */
  LeafFeatures& standing(const MeshSide& side, std::uint32_t leaf, std::uint64_t search);
  /** Leaf of a mesh that moves: turned once per search. */
  LeafFeatures& moving(const MeshSide& side, std::uint32_t leaf, std::uint64_t search, const kernels::Motion& motion);

 private:
  static constexpr std::size_t CAPACITY = 4096, WAYS = 4;  // of each table; places that a leaf may have
  /** A line of memory: which leaves are held, and where. */
  struct alignas(64) Set {
    std::uint64_t keys[WAYS] = {};  // keyOf; 0: nobody's
    std::unique_ptr<LeafFeatures> features[WAYS];
  };
  struct Table {
    std::vector<Set> sets = std::vector<Set>(CAPACITY / WAYS);
    // Leaves of the search at hand whose places others of its leaves hold: what a search has found stays until it ends.
    std::map<std::uint32_t, std::unique_ptr<LeafFeatures>> crowded_out;
    std::uint64_t crowded_search = 0;
  };
  static std::uint64_t keyOf(const MeshSide& side, std::uint32_t leaf) { return side.identity << 32 | leaf; }
  static LeafFeatures& find(Table* table, const MeshSide& side, std::uint32_t leaf, std::uint64_t search);
  static LeafFeatures& findCrowdedOut(Table* table, const MeshSide& side, std::uint32_t leaf, std::uint64_t search);

  Table standing_, moving_;
};

}  // namespace blem_sim
