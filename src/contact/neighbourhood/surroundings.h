// Surroundings of the vertices and edges that were asked about lately: directions, so that no search works them out anew.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "features/mesh_pair.h"
#include "kernels/edge_directions.h"
#include "neighbourhood/plane_reach.h"

namespace blem_sim::contact {

/** An edge from one of its ends; the mesh's frame. */
struct EdgeFromVertex {
  Vector3 along;   ///< [m] to its other end
  double length2;  ///< [m^2]
  int edge;        ///< name
  bool is_flat;
};

/** The edges at a vertex, ascending. */
struct EdgesAtVertex {
  const EdgeFromVertex* first;
  int count;
  const kernels::EdgeDirections* blocks;  ///< the edges' directions
  int block_count;
  const EdgeFromVertex* begin() const { return first; }
  const EdgeFromVertex* end() const { return first + count; }
};

struct EdgeSurroundings {
  Vector3 direction;  ///< unit, from its lower vertex to the higher one
  Vector3 inward[2];  ///< unit, into its first two faces
  int faces;          ///< number of its faces
  bool is_round;      ///< isRoundEdge
};

/** Surroundings in any meshes, for one thread. The memory changes no result. */
class SurroundingsMemory {
 public:
  // Answers are good until the next question of the same kind.
  EdgesAtVertex ofVertex(const MeshSide& side, int vertex);
  const EdgeSurroundings& ofEdge(const MeshSide& side, int edge);
  const PlaneReach& ofFace(const MeshSide& side, int face);

 private:
  static constexpr int MAX_EDGES = kernels::DIRECTION_BLOCK;
  struct VertexEdgesKept {
    int count;
    std::array<EdgeFromVertex, MAX_EDGES> edges;
    kernels::EdgeDirections block;
  };
  /** A feature has one place, which the last one that came there holds. */
  template <typename Item, std::size_t CAPACITY>
  struct Table {
    struct Place {
      std::uint64_t geometry = 0;  // its identity; 0: free
      int name = 0;
      Item item;
    };
    std::vector<Place> places = std::vector<Place>(CAPACITY);

    /** @param known whether the item is the feature's: else it shall become so */
    Item& find(const MeshSide& side, int name, bool* known) {
      Place& place = places[(static_cast<std::uint64_t>(name) + 0x9E3779B9 * side.identity) % CAPACITY];
      *known = place.geometry == side.identity && place.name == name;
      place.geometry = side.identity;
      place.name = name;
      return place.item;
    }
  };

  Table<VertexEdgesKept, 4096> vertices_;
  Table<EdgeSurroundings, 8192> edges_;
  Table<PlaneReach, 1024> faces_;
  std::vector<EdgeFromVertex> many_;  // edges of a vertex that has more than a place holds
  std::vector<kernels::EdgeDirections> many_blocks_;
};

/** Calls visit(unit direction from the edge into a face) for all its faces; mesh's frame. */
template <typename Visit>
void forEachInward(const MeshSide& side, int edge, SurroundingsMemory* surroundings, Visit&& visit) {
  const EdgeSurroundings& around = surroundings->ofEdge(side, edge);
  for (int k = 0; k < std::min(around.faces, 2); ++k) visit(around.inward[k]);
  if (around.faces <= 2) return;
  const geometry::EdgeFaces faces = side.topology.facesOf(edge);
  for (int k = 2; k < around.faces; ++k) visit(side.topology.inward(side.mesh, edge, faces[k]));
}

/** Whether the surface at the vertex leads nowhere along `direction`: no edge there has a larger part of it than `slack` (sine).
 * @param direction unit, the mesh's frame, towards the other mesh */
bool vertexConeAllows(const EdgesAtVertex& edges, const Vector3& direction, double slack);

/** Whether the surface around a vertex is convex as seen from `direction` (mesh's frame, not unit), with round or flat edges only. */
bool isRoundVertex(const MeshSide& side, const EdgesAtVertex& edges, const Vector3& direction, SurroundingsMemory* surroundings);

}  // namespace blem_sim::contact
