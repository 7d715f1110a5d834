#include "publishers/surface_markers.h"

#include <algorithm>

#include "messages/conversions.h"

namespace blem_sim {

namespace {

using visualization_msgs::Marker;

constexpr std::size_t CORNERS_PER_MARKER = 60000;
constexpr std::size_t MOST_SPHERES = 20000;
constexpr double PLANE_SIZE = 20;         // [m] edge of the square that stands for a half-space
constexpr double LINE_WIDTH = 0.002;      // [m]
constexpr double SMALLEST_POINT = 0.002;  // [m]

/** Lists of one kind of element, split into markers that share everything but their points. */
class MarkerLists {
 public:
  MarkerLists(Marker prototype, std::vector<Marker>* markers) : prototype_(std::move(prototype)), markers_(markers) {}

  void add(std::initializer_list<Vector3> corners) {
    if (full()) {
      prototype_.id = markers_->empty() ? prototype_.id : markers_->back().id + 1;
      markers_->push_back(prototype_);
      started_ = true;
    }
    for (const Vector3& corner : corners) markers_->back().points.push_back(toPoint(corner));
  }

 private:
  bool full() const { return !started_ || markers_->back().points.size() + 3 > CORNERS_PER_MARKER; }

  Marker prototype_;
  std::vector<Marker>* markers_;
  bool started_ = false;
};

Marker withType(Marker marker, int type, double size) {
  marker.type = type;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  return marker;
}

void addPlane(const CollisionGeometry& geometry, const Marker& prototype, std::vector<Marker>* markers) {
  const Vector3 normal = geometry.planeNormal();
  const Vector3 centre = geometry.planeOffset() * normal;
  const Vector3 u = 0.5 * PLANE_SIZE * normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  MarkerLists triangles(withType(prototype, Marker::TRIANGLE_LIST, 1), markers);
  triangles.add({centre - u - v, centre + u - v, centre + u + v});
  triangles.add({centre - u - v, centre + u + v, centre - u + v});
}

/** One pass per kind of element, so that each list is contiguous. */
void addMesh(const TriangleMesh& mesh, double radius, const Marker& prototype, std::vector<Marker>* markers) {
  const int count = static_cast<int>(mesh.elements.size());
  const auto vertex = [&](int element, int corner) { return mesh.vertices[mesh.elements[element][corner]]; };
  std::size_t points = 0;
  for (int i = 0; i < count; ++i) points += mesh.isPoint(i) ? 1 : 0;

  MarkerLists triangles(withType(prototype, Marker::TRIANGLE_LIST, 1), markers);
  for (int i = 0; i < count; ++i) {
    if (mesh.isTriangle(i)) triangles.add({vertex(i, 0), vertex(i, 1), vertex(i, 2)});
  }
  MarkerLists lines(withType(prototype, Marker::LINE_LIST, std::max(2 * radius, LINE_WIDTH)), markers);
  for (int i = 0; i < count; ++i) {
    if (!mesh.isTriangle(i) && !mesh.isPoint(i)) {
      lines.add({vertex(i, 0), mesh.elements[i][1] == mesh.elements[i][0] ? vertex(i, 2) : vertex(i, 1)});
    }
  }
  const int point_type = points <= MOST_SPHERES ? Marker::SPHERE_LIST : Marker::POINTS;
  MarkerLists dots(withType(prototype, point_type, std::max(2 * radius, SMALLEST_POINT)), markers);
  for (int i = 0; i < count; ++i) {
    if (mesh.isPoint(i)) dots.add({vertex(i, 0)});
  }
}

}  // namespace

std::vector<Marker> surfaceMarkers(const Collider& collider, const std::string& frame, const Pose& X_FC, const std_msgs::ColorRGBA& colour,
                                   int first_id) {
  Marker prototype;
  prototype.header.frame_id = frame;
  prototype.ns = collider.name;
  prototype.id = first_id;
  prototype.pose = toPose(X_FC);
  prototype.color = colour;
  prototype.frame_locked = true;
  std::vector<Marker> markers;
  if (collider.geometry->isHalfSpace()) {
    addPlane(*collider.geometry, prototype, &markers);
  } else {
    addMesh(collider.geometry->mesh(), collider.radius, prototype, &markers);
  }
  return markers;
}

}  // namespace blem_sim
