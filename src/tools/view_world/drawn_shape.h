// Things in a picture as triangles and dots, without a renderer.
#pragma once

#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"
#include "blem_sim/sim/drawing.h"

namespace blem_sim {

struct DrawnShape {
  int body = -1;                     ///< that it moves with; -1: the world
  geometry::TriangleMesh mesh;       ///< triangles [m], in the body's frame
  std::vector<Vector3> dots;         ///< [m], in the body's frame: points too many for balls
  double dot_size = 0;               ///< [m]
  sim::Colour colour;                ///< of all of it, unless there are
  std::vector<sim::Colour> colours;  ///< one per triangle, or one per dot
  double opacity = 1;                ///< below 1 it is translucent
};

/** Adds triangles of a colour to a shape whose triangles have one each. */
void addColoured(const geometry::TriangleMesh& mesh, const sim::Colour& colour, DrawnShape* shape);

/** Arrow along `along` [m] from its foot; the head takes half of it at most. @param thickness [m] of the shaft */
geometry::TriangleMesh arrowMesh(const Vector3& foot, const Vector3& along, double thickness);

/** Rod with round ends. */
geometry::TriangleMesh capsuleMesh(const Vector3& p, const Vector3& q, double radius);

/** Adds the elements of a mesh to another. */
void append(const geometry::TriangleMesh& mesh, geometry::TriangleMesh* to);

}  // namespace blem_sim
