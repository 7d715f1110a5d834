#include "world_shapes.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/shortest_turn.h"
#include "layer_shell.h"

namespace blem_sim {

namespace {

constexpr std::size_t MOST_BALLS = 20000;
constexpr std::size_t MOST_ROUND_BALLS = 500;  // of 320 triangles each; others have 80
constexpr int CELLS = 40;                      // of a half-space's square, along each side
constexpr double SMALLEST_ROD = 0.0005;        // [m] radius of rods and balls without one
constexpr double SHELL_OPACITY = 0.3;
constexpr double CONTACT_SIZE = 0.02;  // of the scale: radius of a contact's ball
constexpr double ARROW_SIZE = 0.02;    // of the scale: thickness of an arrow
constexpr double SHORTEST_ARROW = 0.02;

/** Points as balls, or dots if they are many. @param colours one per point, or one */
void addPoints(const std::vector<Vector3>& points, const std::vector<sim::Colour>& colours, double radius, DrawnShape* shape) {
  const auto colour = [&](std::size_t i) { return colours[colours.size() == 1 ? 0 : i]; };
  if (points.size() > MOST_BALLS) {
    shape->dots = points;
    shape->dot_size = 2 * radius;
    for (std::size_t i = 0; i < points.size(); ++i) shape->colours.push_back(colour(i));
    return;
  }
  const geometry::TriangleMesh ball = geometry::icosphereMesh(radius, points.size() > MOST_ROUND_BALLS ? 1 : 2);
  for (std::size_t i = 0; i < points.size(); ++i) addColoured(geometry::transformed(ball, makePose(points[i])), colour(i), shape);
}

/**
 * Triangles of a collider's mesh, and rods for its segments.
 * @param bare the mesh below its layer, where that lies inside, too @param points those of its elements that are points, in the body's
 * frame
 */
DrawnShape surfaceShape(const contact::Collider& collider, bool bare, const sim::Colour& colour, std::vector<Vector3>* points) {
  DrawnShape shape;
  shape.body = collider.body;
  shape.colour = colour;
  const geometry::TriangleMesh mesh = geometry::transformed((bare ? collider.geometry : collider.seen())->mesh(), collider.X_BC);
  const double radius = std::max(collider.radius, SMALLEST_ROD);
  shape.mesh.vertices = mesh.vertices;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    const Vector3i& e = mesh.elements[i];
    if (mesh.isTriangle(i)) {
      shape.mesh.elements.push_back(e);
    } else if (mesh.isPoint(i)) {
      points->push_back(mesh.vertices[e[0]]);
    } else {
      append(capsuleMesh(mesh.vertices[e[0]], mesh.vertices[e[1] == e[0] ? e[2] : e[1]], radius), &shape.mesh);
    }
  }
  return shape;
}

/** A chequered square of the plane below `middle`. @param cell [m] */
DrawnShape planeShape(const contact::CollisionGeometry& plane, const Pose& X_WC, const Vector3& middle, double cell,
                      const sim::Colour& colour) {
  const Vector3 normal = X_WC.linear() * plane.planeNormal();
  const Vector3 foot = X_WC * (plane.planeOffset() * plane.planeNormal());
  Pose X_WP = Pose::Identity();
  X_WP.linear() = geometry::shortestTurn(Vector3::UnitZ(), normal).toRotationMatrix();
  X_WP.translation() = foot;
  // A whole number of pairs of cells away from the foot point: the pattern stays where it is in the world.
  const Vector3 way = X_WP.inverse() * middle;
  const Vector3 snapped(2 * cell * std::round(way.x() / (2 * cell)), 2 * cell * std::round(way.y() / (2 * cell)), 0);
  DrawnShape shape;
  const sim::Colour other = mixed(colour, {0.45F, 0.50F, 0.58F}, 0.3);
  for (int i = 0; i < CELLS; ++i) {
    for (int j = 0; j < CELLS; ++j) {
      const Vector3 centre = snapped + cell * Vector3(i - 0.5 * CELLS + 0.5, j - 0.5 * CELLS + 0.5, 0);
      addColoured(geometry::transformed(geometry::gridMesh(cell, cell, 1, 1), X_WP * makePose(centre)), (i + j) % 2 == 0 ? colour : other,
                  &shape);
    }
  }
  return shape;
}

bool isDrawn(const sim::Simulator& simulator, const contact::Collider& collider) {
  return collider.enabled && collider.model >= 0 && simulator.models()[collider.model].alive;
}

sim::ModelKind kindOf(const sim::Simulator& simulator, const contact::Collider& collider) {
  return simulator.models()[collider.model].kind;
}

Pose poseOf(const contact::Collider& collider, const WorldFrame& frame) {
  return collider.body == dynamics::WORLD_BODY ? collider.X_BC : Pose(frame.bodies[collider.body].X_WB * collider.X_BC);
}

/** Extends a box by that of a collider, whose sides it turns with it. */
void extend(const contact::Collider& collider, const WorldFrame& frame, Box* box) {
  const Box& bounds = collider.geometry->bounds();
  const Pose X_WC = poseOf(collider, frame);
  const Vector3 half = X_WC.linear().cwiseAbs() * Vector3(0.5 * bounds.sizes()) + Vector3::Constant(collider.radius);
  const Vector3 centre = X_WC * bounds.center();
  box->extend(Box(Vector3(centre - half), Vector3(centre + half)));
}

/** Largest power of ten [m] that is not above a length. */
double powerOfTen(double length) { return std::pow(10, std::floor(std::log10(length))); }

}  // namespace

Box worldBox(const sim::Simulator& simulator, const std::vector<WorldFrame>& frames) {
  Box moving, standing;
  for (const contact::Collider& collider : simulator.colliders()) {
    if (!isDrawn(simulator, collider) || collider.geometry->isHalfSpace()) continue;
    if (kindOf(simulator, collider) == sim::ModelKind::ENVIRONMENT) {
      extend(collider, frames[0], &standing);
    } else {
      for (const WorldFrame& frame : frames) extend(collider, frame, &moving);
    }
  }
  if (!moving.isEmpty()) return moving;
  return standing.isEmpty() ? Box(Vector3::Constant(-0.5), Vector3::Constant(0.5)) : standing;
}

std::vector<DrawnShape> worldShapes(const sim::Simulator& simulator, const ViewCamera& camera, bool layers) {
  const double cell = powerOfTen((camera.target - camera.eye).norm() / 3);
  std::vector<DrawnShape> shapes;
  for (const contact::Collider& collider : simulator.colliders()) {
    if (!isDrawn(simulator, collider)) continue;
    const sim::ModelKind kind = kindOf(simulator, collider);
    const sim::Colour colour = sim::modelColour(kind, collider.model);
    if (collider.geometry->isHalfSpace()) {
      shapes.push_back(planeShape(*collider.geometry, collider.X_BC, camera.target, cell, colour));
      continue;
    }
    std::vector<Vector3> points;
    shapes.push_back(surfaceShape(collider, layers, colour, &points));
    if (!points.empty()) {
      const bool by_height = kind == sim::ModelKind::ENVIRONMENT && points.size() > 1;
      DrawnShape balls;
      balls.body = collider.body;
      addPoints(points, by_height ? sim::coloursByHeight(points, sim::upwards(simulator.gravity())) : std::vector<sim::Colour>{colour},
                std::max(collider.radius, SMALLEST_ROD), &balls);
      shapes.push_back(balls);
    }
    if (!layers || collider.radius <= 0) continue;
    DrawnShape shell;
    shell.body = collider.body;
    shell.mesh =
        geometry::transformed(layerShell(collider.geometry->mesh(), collider.geometry->topology(), collider.radius), collider.X_BC);
    shell.colour = mixed(colour, {0.3F, 0.5F, 1.0F}, 0.6);
    shell.opacity = SHELL_OPACITY;
    shapes.push_back(shell);
  }
  return shapes;
}

DrawnShape contactShape(const sim::Simulator& simulator, const std::vector<sim::ContactReport>& contacts, double scale) {
  const double metres_per_newton = scale / std::max(1e-12, sim::movingWeight(simulator));
  const geometry::TriangleMesh ball = geometry::icosphereMesh(CONTACT_SIZE * scale, 2);
  DrawnShape shape;
  for (const sim::ContactReport& contact : contacts) {
    const sim::Colour colour = sim::contactColour(contact);
    addColoured(geometry::transformed(ball, makePose(contact.point)), colour, &shape);
    Vector3 along = metres_per_newton * sim::forceOnMovingSide(contact);
    if (along.norm() < SHORTEST_ARROW * scale) continue;
    if (along.norm() > scale) along *= scale / along.norm();
    addColoured(arrowMesh(contact.point, along, ARROW_SIZE * scale), colour, &shape);
  }
  return shape;
}

}  // namespace blem_sim
