#include "collision_shapes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace blem_sim::model {
namespace {

/** Decimals of a URDF; spheres that miss a cylinder's end by more are spheres of their own. */
constexpr double SAME = 1e-6;  // [m]

/** Three collision elements that are one capsule. */
struct Capsule {
  std::size_t cylinder, first_sphere, second_sphere;
  Vector3 p, q;  ///< ends of the axis [m], link frame
  double radius = 0;
};

const urdf::Cylinder* asCylinder(const urdf::Collision& collision) {
  return collision.geometry->type == urdf::Geometry::CYLINDER ? static_cast<const urdf::Cylinder*>(collision.geometry.get()) : nullptr;
}

const urdf::Sphere* asSphere(const urdf::Collision& collision) {
  return collision.geometry->type == urdf::Geometry::SPHERE ? static_cast<const urdf::Sphere*>(collision.geometry.get()) : nullptr;
}

/** Index of an unused sphere of that radius at p; size of the array if there is none. */
std::size_t sphereAt(const urdf::Link& link, const std::vector<bool>& used, const Vector3& p, double radius) {
  std::size_t i = 0;
  for (; i < link.collision_array.size(); ++i) {
    const urdf::Sphere* sphere = asSphere(*link.collision_array[i]);
    if (!sphere || used[i] || std::abs(sphere->radius - radius) > SAME) continue;
    if ((toPose(link.collision_array[i]->origin).translation() - p).norm() <= SAME) break;
  }
  return i;
}

std::vector<Capsule> findCapsules(const urdf::Link& link) {
  std::vector<Capsule> capsules;
  std::vector<bool> used(link.collision_array.size(), false);
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    const urdf::Cylinder* cylinder = asCylinder(*link.collision_array[i]);
    if (!cylinder) continue;
    const Pose X_LC = toPose(link.collision_array[i]->origin);
    const Vector3 half(0, 0, cylinder->length / 2);
    const Capsule capsule{i,
                          sphereAt(link, used, X_LC * Vector3(-half), cylinder->radius),
                          sphereAt(link, used, X_LC * half, cylinder->radius),
                          X_LC * Vector3(-half),
                          X_LC * half,
                          cylinder->radius};
    if (std::max(capsule.first_sphere, capsule.second_sphere) == used.size() || capsule.first_sphere == capsule.second_sphere) continue;
    used[capsule.cylinder] = used[capsule.first_sphere] = used[capsule.second_sphere] = true;
    capsules.push_back(capsule);
  }
  return capsules;
}

/** A primitive with its report filled. @param radius boundary, 0 for triangles */
CollisionShape primitive(const geometry::TriangleMesh& mesh, double radius, const std::string& source) {
  CollisionShape shape;
  shape.mesh = std::make_shared<const geometry::TriangleMesh>(geometry::cleanMesh(mesh, &shape.report));
  shape.radius = shape.report.boundary_width = radius;
  shape.report.source = source;
  return shape;
}

}  // namespace

Pose toPose(const urdf::Pose& pose) {
  Pose X = Pose::Identity();
  const Quaternion q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() = Vector3(pose.position.x, pose.position.y, pose.position.z);
  return X;
}

CollisionShape CollisionShapeReader::readMesh(const urdf::Mesh& mesh, const Pose& X_LC, const std::string& where) {
  try {
    const std::string file = resolver_.resolve(mesh.filename, base_);
    const auto key = std::make_tuple(file, mesh.scale.x, mesh.scale.y, mesh.scale.z);
    auto loaded = loaded_.find(key);
    if (loaded == loaded_.end()) {
      const Vector3 scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
      loaded = loaded_.emplace(key, loadSurface(file, scale, {}, mending_)).first;
    }
    CollisionShape shape;
    shape.mesh = loaded->second.mesh;
    shape.radius = loaded->second.radius;
    shape.report = loaded->second.report;
    if (X_LC.matrix() == Pose::Identity().matrix()) return shape;
    shape.mesh = std::make_shared<const geometry::TriangleMesh>(geometry::transformed(*shape.mesh, X_LC));
    shape.report.extents = shape.mesh->bounds();
    return shape;
  } catch (const InputError& error) {
    throw InputError(where + ": mesh " + error.what());
  }
}

CollisionShape CollisionShapeReader::readOne(const urdf::Collision& collision, const std::string& where) {
  const Pose X_LC = toPose(collision.origin);
  if (const urdf::Sphere* sphere = asSphere(collision))
    return primitive(geometry::pointMesh(X_LC.translation()), sphere->radius, fmt::format("sphere of radius {} m", sphere->radius));
  if (const urdf::Cylinder* cylinder = asCylinder(collision)) {
    CollisionShape shape = primitive(geometry::transformed(geometry::cylinderMesh(cylinder->radius, cylinder->length), X_LC), 0,
                                     fmt::format("cylinder of radius {} m and length {} m", cylinder->radius, cylinder->length));
    shape.cylinder = geometry::cylinderBehind(*shape.mesh);
    return shape;
  }
  if (collision.geometry->type == urdf::Geometry::BOX) {
    const urdf::Vector3& size = static_cast<const urdf::Box&>(*collision.geometry).dim;
    return primitive(geometry::transformed(geometry::boxMesh(Vector3(size.x, size.y, size.z)), X_LC), 0,
                     fmt::format("box of {} x {} x {} m", size.x, size.y, size.z));
  }
  return readMesh(static_cast<const urdf::Mesh&>(*collision.geometry), X_LC, where);
}

std::vector<CollisionShape> CollisionShapeReader::read(const urdf::Link& link, const std::string& where, std::vector<std::string>* notes) {
  const std::vector<Capsule> capsules = findCapsules(link);
  std::vector<CollisionShape> shapes;
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    const auto part = std::find_if(capsules.begin(), capsules.end(),
                                   [&](const Capsule& c) { return c.cylinder == i || c.first_sphere == i || c.second_sphere == i; });
    if (part == capsules.end()) {
      shapes.push_back(readOne(*link.collision_array[i], fmt::format("{} collision {}", where, i + 1)));
    } else if (part->cylinder == i) {
      shapes.push_back(
          primitive(geometry::segmentMesh(part->p, part->q), part->radius, fmt::format("capsule of radius {} m", part->radius)));
      notes->push_back(fmt::format("link '{}': a cylinder with a sphere of its radius at each end is taken as one capsule", link.name));
    }
  }
  return shapes;
}

}  // namespace blem_sim::model
