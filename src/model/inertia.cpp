#include "inertia.h"

#include <cmath>

#include <Eigen/Eigenvalues>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/mesh_winding.h"

namespace blem_sim::model {
namespace {

constexpr double DENSITY = 1000;          // [kg/m^3]
constexpr double SHELL_THICKNESS = 1e-3;  // [m]
constexpr double BALL_RADIUS = 0.01;      // [m]
constexpr double BALL_MASS = 0.01;        // [kg]
/** Least principal inertia as a part of the largest: a thin rod has about 1e-4. */
constexpr double LEAST_RATIO = 1e-5;
/** A principal inertia below minus this part of the largest is no rounding. */
constexpr double ROUNDING_RATIO = 1e-3;

/** Inertia about a point at -d from the centre of mass, less the inertia about the centre of mass: the parallel axis theorem. */
Matrix3 parallelAxis(double mass, const Vector3& d) { return mass * (d.squaredNorm() * Matrix3::Identity() - d * d.transpose()); }

/** Inertia of a body that is symmetric about an axis: `along` it, `across` it. */
Matrix3 axial(const Vector3& axis, double along, double across) {
  return across * Matrix3::Identity() + (along - across) * axis * axis.transpose();
}

Inertial ball(const Vector3& centre, double radius, double mass) {
  return {mass, centre, 0.4 * mass * radius * radius * Matrix3::Identity()};
}

/** Solid capsule: a cylinder and two half balls. */
Inertial capsule(const Vector3& p, const Vector3& q, double radius) {
  const double length = (q - p).norm(), r2 = radius * radius;
  const double cylinder = DENSITY * M_PI * r2 * length, balls = DENSITY * 4.0 / 3.0 * M_PI * r2 * radius;
  const double along = cylinder * r2 / 2 + balls * 0.4 * r2;
  const double across = cylinder * (length * length / 12 + r2 / 4) + balls * (0.4 * r2 + length * length / 4 + 3 * length * radius / 8);
  return {cylinder + balls, (p + q) / 2, axial((q - p) / length, along, across)};
}

double enclosedVolume(const geometry::TriangleMesh& mesh) {
  const Vector3 reference = mesh.bounds().center();
  double six_volumes = 0;
  for (const Vector3i& e : mesh.elements)
    six_volumes += (mesh.vertices[e[0]] - reference).dot((mesh.vertices[e[1]] - reference).cross(mesh.vertices[e[2]] - reference));
  return std::abs(six_volumes) / 6;
}

double area(const geometry::TriangleMesh& mesh) {
  double twice = 0;
  for (const Vector3i& e : mesh.elements)
    twice += (mesh.vertices[e[1]] - mesh.vertices[e[0]]).cross(mesh.vertices[e[2]] - mesh.vertices[e[0]]).norm();
  return twice / 2;
}

Inertial shapeInertial(const CollisionShape& shape) {
  const geometry::TriangleMesh& mesh = *shape.mesh;
  if (shape.radius > 0 && mesh.elements.size() == 1) {
    const Vector3 &p = mesh.vertices[mesh.elements[0][0]], &q = mesh.vertices[mesh.elements[0][1]];
    if (!mesh.isPoint(0)) return capsule(p, q, shape.radius);
    return ball(p, shape.radius, DENSITY * 4.0 / 3.0 * M_PI * std::pow(shape.radius, 3));
  }
  if (shape.report.closed) {
    Inertial solid;
    const geometry::TriangleMesh outward = geometry::woundOutward(mesh);
    if (geometry::massFromVolume(outward, DENSITY * enclosedVolume(outward), &solid)) return solid;
  }
  return geometry::massFromSurface(mesh, DENSITY * SHELL_THICKNESS * area(mesh));
}

}  // namespace

Inertial movedTo(const Pose& X_AB, const Inertial& inertial) {
  const Matrix3 R_AB = X_AB.linear();
  return {inertial.mass, X_AB * inertial.com, R_AB * inertial.inertia * R_AB.transpose()};
}

Inertial sum(const Inertial& a, const Inertial& b) {
  Inertial total;
  total.mass = a.mass + b.mass;
  if (total.mass > 0) total.com = (a.mass * a.com + b.mass * b.com) / total.mass;
  total.inertia = a.inertia + parallelAxis(a.mass, a.com - total.com) + b.inertia + parallelAxis(b.mass, b.com - total.com);
  return total;
}

void repairInertia(const NamedBody& body, Inertial* inertial, std::vector<std::string>* notes) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(inertial->inertia);
  Vector3 principal = solver.eigenvalues();
  const double largest = principal.cwiseAbs().maxCoeff();
  if (largest == 0) {
    inertial->inertia = ball(Vector3::Zero(), BALL_RADIUS, inertial->mass).inertia;
    notes->push_back(fmt::format("{}: its inertia is zero; a solid ball of 1 cm stands in", body.name));
    return;
  }
  if (principal[0] < -ROUNDING_RATIO * largest)
    throw InputError(
        fmt::format("{}: {}: its inertia is not positive definite (principal values {:.4g} {:.4g} {:.4g} kg m^2); correct <inertia>",
                    body.source, body.name, principal[0], principal[1], principal[2]));
  if (principal[0] < LEAST_RATIO * largest) {
    principal = principal.cwiseMax(LEAST_RATIO * largest);
    const Matrix3 axes = solver.eigenvectors();
    inertial->inertia = axes * principal.asDiagonal() * axes.transpose();
    notes->push_back(fmt::format("{}: its least principal inertia is raised to {:.3g} kg m^2, so that it is positive definite", body.name,
                                 principal[0]));
  }
  const double excess = principal[2] - principal[0] - principal[1];
  if (excess > ROUNDING_RATIO * principal[2])
    notes->push_back(fmt::format(
        "{}: no rigid body has principal inertias {:.4g} {:.4g} {:.4g} kg m^2 (the largest exceeds the sum of the others); kept as given",
        body.name, principal[0], principal[1], principal[2]));
}

std::optional<Inertial> inertialOfShapes(const std::vector<CollisionShape>& shapes) {
  std::optional<Inertial> total;
  for (const CollisionShape& shape : shapes) total = total ? sum(*total, shapeInertial(shape)) : shapeInertial(shape);
  return total;
}

Inertial smallBall() { return ball(Vector3::Zero(), BALL_RADIUS, BALL_MASS); }

}  // namespace blem_sim::model
