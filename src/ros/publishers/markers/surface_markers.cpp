#include "publishers/markers/surface_markers.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

using visualization_msgs::Marker;

constexpr std::size_t MOST_SPHERES = 20000;
constexpr double PLANE_SIZE = 20;         // [m] edge of the square that stands for a half-space
constexpr double LINE_WIDTH = 0.002;      // [m]
constexpr double SMALLEST_POINT = 0.002;  // [m]

/** Lists of one kind of element, split into markers that share everything but their points. */
class MarkerLists {
 public:
  MarkerLists(Marker prototype, std::size_t most, std::vector<Marker>* markers)
      : prototype_(std::move(prototype)), most_(most), markers_(markers) {}

  void add(std::initializer_list<Vector3> corners) {
    startIfFull();
    for (const Vector3& corner : corners) markers_->back().points.push_back(toPoint(corner));
  }
  void addDot(const Vector3& dot, const sim::Colour& colour) {
    add({dot});
    markers_->back().colors.push_back(toColour(colour));
  }

 private:
  void startIfFull() {
    if (started_ && markers_->back().points.size() < most_) return;
    prototype_.id = markers_->empty() ? prototype_.id : markers_->back().id + 1;
    markers_->push_back(prototype_);
    started_ = true;
  }

  Marker prototype_;
  std::size_t most_;  // points of a marker, a multiple of those of its elements
  std::vector<Marker>* markers_;
  bool started_ = false;
};

Marker withType(Marker marker, int type, double size) {
  marker.type = type;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  return marker;
}

void addPlane(const contact::CollisionGeometry& geometry, const Marker& prototype, std::vector<Marker>* markers) {
  const Vector3 normal = geometry.planeNormal();
  const Vector3 centre = geometry.planeOffset() * normal;
  const Vector3 u = 0.5 * PLANE_SIZE * normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  MarkerLists triangles(withType(prototype, Marker::TRIANGLE_LIST, 1), 3 * MOST_TRIANGLES, markers);
  triangles.add({centre - u - v, centre + u - v, centre + u + v});
  triangles.add({centre - u - v, centre + u + v, centre - u + v});
}

/** Points as spheres or squares. @param up unit; if not zero, they have the colours of their heights along it */
void addPoints(const std::vector<Vector3>& points, double radius, const Vector3& up, const Marker& prototype,
               std::vector<Marker>* markers) {
  const int type = points.size() <= MOST_SPHERES ? Marker::SPHERE_LIST : Marker::POINTS;
  MarkerLists dots(withType(prototype, type, std::max(2 * radius, SMALLEST_POINT)), MOST_DOTS, markers);
  const std::vector<sim::Colour> colours = up.isZero() ? std::vector<sim::Colour>() : sim::coloursByHeight(points, up);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (colours.empty()) {
      dots.add({points[i]});
    } else {
      dots.addDot(points[i], colours[i]);
    }
  }
}

/** Elements that are no triangles, a pass per kind, so that each list is contiguous. */
void addOthers(const geometry::TriangleMesh& mesh, double radius, const Vector3& up, const Marker& prototype,
               std::vector<Marker>* markers) {
  const int count = static_cast<int>(mesh.elements.size());
  const auto vertex = [&](int element, int corner) { return mesh.vertices[mesh.elements[element][corner]]; };
  MarkerLists lines(withType(prototype, Marker::LINE_LIST, std::max(2 * radius, LINE_WIDTH)), MOST_DOTS, markers);
  for (int i = 0; i < count; ++i) {
    if (!mesh.isTriangle(i) && !mesh.isPoint(i)) {
      lines.add({vertex(i, 0), mesh.elements[i][1] == mesh.elements[i][0] ? vertex(i, 2) : vertex(i, 1)});
    }
  }
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) {
    if (mesh.isPoint(i)) points.push_back(vertex(i, 0));
  }
  addPoints(points, radius, up, prototype, markers);
}

/** An ASCII file begins so; rviz reads the binary kind alone. */
bool beginsAsAsciiStl(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string start(5, ' ');
  return !stream.read(start.data(), static_cast<std::streamsize>(start.size())) || start == "solid";
}

Marker fileMarker(const sim::SurfaceFile& file, Marker marker) {
  marker.type = Marker::MESH_RESOURCE;
  marker.mesh_resource = file.uri;
  marker.scale.x = file.scale.x();
  marker.scale.y = file.scale.y();
  marker.scale.z = file.scale.z();
  return marker;
}

}  // namespace

bool rvizReads(const sim::SurfaceFile& file) {
  const bool plain =
      std::all_of(file.uri.begin(), file.uri.end(), [](unsigned char c) { return std::isalnum(c) || std::strchr("/._-+:", c) != nullptr; });
  const std::string extension = std::filesystem::path(file.path).extension().string();
  if (extension == ".stl") return plain && !beginsAsAsciiStl(file.path);
  return plain && (extension == ".ply" || extension == ".obj");
}

Marker markerOf(const contact::Collider& collider, const MarkerStyle& style) {
  Marker marker;
  marker.header.frame_id = style.frame;
  marker.ns = collider.name;
  marker.id = style.first_id;
  marker.pose = toPose(style.X_FC);
  marker.color = style.colour;
  marker.frame_locked = true;
  return marker;
}

void addTriangles(const geometry::TriangleMesh& mesh, const Marker& prototype, std::vector<Marker>* markers) {
  MarkerLists triangles(withType(prototype, Marker::TRIANGLE_LIST, 1), 3 * MOST_TRIANGLES, markers);
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    const Vector3i& e = mesh.elements[i];
    if (mesh.isTriangle(i)) triangles.add({mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]});
  }
}

std::vector<Marker> surfaceMarkers(const contact::Collider& collider, const MarkerStyle& style) {
  const Marker prototype = markerOf(collider, style);
  std::vector<Marker> markers;
  if (collider.geometry->isHalfSpace()) {
    addPlane(*collider.geometry, prototype, &markers);
    return markers;
  }
  const geometry::TriangleMesh& mesh = collider.seen()->mesh();
  if (style.file && mesh.elements.size() > MOST_TRIANGLES && rvizReads(*style.file)) return {fileMarker(*style.file, prototype)};
  addTriangles(mesh, prototype, &markers);
  addOthers(mesh, collider.radius, style.X_FC.linear().transpose() * style.up, prototype, &markers);
  return markers;
}

}  // namespace blem_sim::node
