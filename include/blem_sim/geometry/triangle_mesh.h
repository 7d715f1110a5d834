// Unstructured surfaces: triangle meshes, segments and point clouds are one type.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::geometry {

/**
 * A soup of elements. An element is a triangle of vertex indices whose corners may coincide: {i, j, k} is a triangle, {i, j, j} a
 * segment, {i, i, i} a point. So a point cloud, a capsule's axis and a mesh are handled by the same code, without a topology asked for.
 */
struct TriangleMesh {
  std::vector<Vector3> vertices;   ///< [m], in the mesh's own frame
  std::vector<Vector3i> elements;  ///< indices into vertices

  bool isPoint(int element) const {
    const Vector3i& e = elements[element];
    return e[0] == e[1] && e[1] == e[2];
  }
  bool isTriangle(int element) const {
    const Vector3i& e = elements[element];
    return e[0] != e[1] && e[1] != e[2] && e[2] != e[0];
  }
  Box bounds() const;
  std::size_t bytes() const { return vertices.capacity() * sizeof(Vector3) + elements.capacity() * sizeof(Vector3i); }  ///< memory held
};

/** Result of loading one mesh or cloud; published as it stands in the load report. */
struct MeshReport {
  std::string name;    ///< user of the mesh: "hubo::Body_LAR", "ladder"
  std::string source;  ///< file or primitive it came from
  int vertices = 0;    ///< after cleaning and mending
  int triangles = 0;   ///< after cleaning and mending
  int segments = 0;
  int points = 0;
  int degenerate = 0;              ///< triangles without area, dropped
  int duplicate = 0;               ///< triangles given more than once (either winding), dropped
  int nonfinite = 0;               ///< triangles or points that used a NaN or infinite coordinate, dropped
  int invalid = 0;                 ///< triangles whose index is out of range, dropped
  int welded = 0;                  ///< vertices merged with another at exactly the same position
  int open_edges = 0;              ///< edges with one triangle
  int nonmanifold_edges = 0;       ///< edges with three or more triangles
  bool closed = false;             ///< every edge has two triangles
  Box extents;                     ///< [m], mesh frame, after cleaning and mending
  double boundary_width = 0;       ///< [m] r that contact uses
  std::size_t bytes = 0;           ///< memory of its geometry, shared by all users of the same one
  std::vector<std::string> notes;  ///< changes that were made, in words
};

/** Meaning of an element that names a vertex twice: a segment or a point, on purpose, or a malformed triangle of a file. */
enum class RepeatedIndices { ARE_SEGMENTS_AND_POINTS, ARE_DEGENERATE };

/**
 * Makes a soup fit for contact and reports the changes: drops elements with non-finite coordinates or indices out of range, welds vertices
 * at exactly the same position, drops triangles without area and repeated ones (either winding), drops unused vertices, counts open and
 * non-manifold edges. Never moves a vertex. Segments and points pass through, unless told that the soup has none; three different indices
 * are always a triangle, whatever their positions. A coordinate beyond 1e30 m counts as non-finite: boxes are float.
 * The result may be empty; the caller decides whether that is an error. Order is kept.
 * @param report its counts, extents are set; may be null
 */
TriangleMesh cleanMesh(TriangleMesh soup, MeshReport* report, RepeatedIndices repeated = RepeatedIndices::ARE_SEGMENTS_AND_POINTS);

/** One element {i, i, i} per finite point; non-finite ones are counted in the report. Points at exactly the same position are merged. */
TriangleMesh pointCloudMesh(const std::vector<Vector3>& points, MeshReport* report);

/** Closed box of 12 triangles, centred. @param size full edge lengths [m] */
TriangleMesh boxMesh(const Vector3& size);

/** Closed cylinder about z, centred, with `sides` sides on the circumscribed circle of the true cylinder's radius. */
TriangleMesh cylinderMesh(double radius, double length, int sides = 64);

/** Regular grid of 2 nx ny triangles in z = 0, centred. @param size_x, size_y [m] */
TriangleMesh gridMesh(double size_x, double size_y, int nx, int ny);

/** Icosphere: 20 * 4^level triangles, vertices on the sphere of the given radius [m]. */
TriangleMesh icosphereMesh(double radius, int level);

/** A single point / segment, for spheres and capsules, whose radius is their boundary. */
TriangleMesh pointMesh(const Vector3& p);
TriangleMesh segmentMesh(const Vector3& p, const Vector3& q);

/** Scales (non-uniformly if asked), then moves every vertex. @param X_AB pose of the mesh frame B in the new frame A */
TriangleMesh transformed(const TriangleMesh& mesh, const Pose& X_AB, const Vector3& scale = Vector3::Ones());

/** Splits each triangle into 4^level equal ones; same surface, other tessellation. */
TriangleMesh subdivided(const TriangleMesh& mesh, int level);

/** Mass, centre of mass [m, mesh frame] and inertia [kg m^2, about the centre of mass, mesh axes]. */
struct MassProperties {
  double mass = 0;
  Vector3 com = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();
};

/** Uniform density in the enclosed volume. Precondition: mesh is closed and consistently wound (either way); returns false if the
 *  enclosed volume is not positive beyond rounding, then nothing is written. */
bool massFromVolume(const TriangleMesh& mesh, double mass, MassProperties* out);

/** Uniform density on the surface (triangles by area; else segments by length; else points): a thin shell. */
MassProperties massFromSurface(const TriangleMesh& mesh, double mass);

}  // namespace blem_sim::geometry
