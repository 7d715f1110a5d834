// Records of a list's features, asked where contacts fade.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/geometry/roomy.h"
#include "kernels/edge_directions.h"
#include "kernels/records.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** Directions at vertices and shapes of faces of one mesh, in its frame. Few features are asked, but again in each step: their records are
 * worked out when they first are, and kept side by side for as long as the list. */
class FadingRecords {
 public:
  /** A run of directions(). */
  struct Directions {
    std::uint32_t first, blocks;
  };

  /** Makes places for all features of a list. */
  void makePlaces(std::size_t vertices, std::size_t faces) {
    if (at_vertices_.size() < vertices) geometry::resizeRoomy(vertices, &at_vertices_, Directions{UNKNOWN, 0});
    if (of_faces_.size() < faces) geometry::resizeRoomy(faces, &of_faces_, std::uint32_t{UNKNOWN});
  }
  /** Directions of the edges at a vertex. @param vertex in the list @param name in the mesh */
  const Directions& directionsAt(const MeshSide& side, std::uint32_t vertex, int name, SurroundingsMemory* surroundings) {
    if (at_vertices_[vertex].first == UNKNOWN) at_vertices_[vertex] = addDirections(surroundings->ofVertex(side, name));
    return at_vertices_[vertex];
  }
  /** A face's place in corners(). @param face in the list @param name in the mesh @param goes_on whether its plane has other faces */
  std::uint32_t shapeOf(const MeshSide& side, std::uint32_t face, int name, bool goes_on, SurroundingsMemory* surroundings) {
    if (of_faces_[face] == UNKNOWN) of_faces_[face] = addShape(side, name, goes_on ? surroundings->ofFace(side, name) : PlaneReach{0, 0});
    return of_faces_[face];
  }

  const kernels::EdgeDirections* directions() const { return directions_.data(); }
  const kernels::FaceCorners* corners() const { return corners_.data(); }
  const PlaneReach& reach(std::uint32_t shape) const { return reaches_[shape]; }
  void clear();
  /** Makes room for so many features. */
  void reserve(std::size_t count) {
    at_vertices_.reserve(count);
    of_faces_.reserve(count);
    directions_.reserve(count);
    corners_.reserve(count);
    reaches_.reserve(count);
  }

 private:
  static constexpr std::uint32_t UNKNOWN = 0xFFFFFFFF;
  static constexpr std::size_t FIRST_SHAPES = 8;  // for which there is room at once: a kilobyte

  Directions addDirections(const EdgesAtVertex& edges);
  std::uint32_t addShape(const MeshSide& side, int face, const PlaneReach& reach);

  std::vector<Directions> at_vertices_;
  std::vector<std::uint32_t> of_faces_;
  std::vector<kernels::EdgeDirections> directions_;
  std::vector<kernels::FaceCorners> corners_;
  std::vector<PlaneReach> reaches_;
};

}  // namespace blem_sim::contact
