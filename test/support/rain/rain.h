// Balls that rain on a file's mesh or cloud, and whether one of them got through it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"
#include "support/bare_meshes.h"
#include "support/rain/element_grid.h"
#include "support/random/scene_numbers.h"

namespace blem_sim {

struct RainOutcome {
  int balls = 0, touched = 0;
  int crossed = 0;  ///< balls that went through the mesh, or that it went through
  int untold = 0;   ///< of these, without a layer event of the ball up to the next step
  bool finite = true;
  int unreliable_steps = 0, troubled_steps = 0, gained_steps = 0;
  double max_of_layer = 0;     ///< of contacts with the file's mesh or cloud
  double fastest = 0;          ///< [m/s]
  std::string first_crossing;  ///< in words
};

namespace rain {

constexpr int BALLS = 36;              // about
constexpr double LEAST_CELL = 0.025;   // [m] holds a ball of 4 mm, its layer, and the way it is put aside
constexpr double BALL_LAYER = 0.0025;  // [m] the default
constexpr int BALL_LEVEL = 2;          // subdivisions of balls that are meshes

struct Ball {
  double radius = 0;
  bool is_mesh = false;
  Vector3 start = Vector3::Zero();
  double speed = 0;  ///< [m/s] downwards
};

/** Radius [m] of the ball inside the unit ball of triangles. */
inline double inscribedRadius() {
  const geometry::TriangleMesh ball = geometry::icosphereMesh(1, BALL_LEVEL);
  double radius = 1;
  for (std::size_t i = 0; i < ball.elements.size(); ++i)
    radius = std::min(radius, geometry::closestPointTriangle(Vector3::Zero(), geometry::triangleOf(ball, i)).distance);
  return radius;
}

/** Height [m] that nothing below a square about a place exceeds; the mesh's lowest where there is nothing. */
inline double topOver(const Vector3& place, double half, const Box& bounds, ElementGrid* grid) {
  Box column(place - Vector3::Constant(half), place + Vector3::Constant(half));
  column.min().z() = bounds.min().z();
  column.max().z() = bounds.max().z();
  double top = bounds.min().z();
  grid->visit(column, [&](int i) {
    for (const Vector3& corner : grid->triangle(i)) top = std::max(top, corner.z());
  });
  return top;
}

/** Balls over cells of the box seen from above, one over the other where there are few cells, half of them meshes. */
inline std::vector<Ball> ballsOver(const Box& bounds, double least_height, ElementGrid* grid, SceneNumbers* n) {
  const double x = bounds.sizes().x(), y = bounds.sizes().y();
  const double cell = std::max({std::sqrt(x * y / BALLS), std::max(x, y) / 12, LEAST_CELL});
  const int nx = std::max(1, static_cast<int>(std::lround(x / cell))), ny = std::max(1, static_cast<int>(std::lround(y / cell)));
  const int levels = std::clamp((BALLS + nx * ny - 1) / (nx * ny), 1, 4);
  std::vector<Ball> balls;
  for (int column = 0; column < nx * ny; ++column) {
    const Vector3 middle(bounds.min().x() + (column % nx + 0.5) * x / nx, bounds.min().y() + (column / nx + 0.5) * y / ny, 0);
    const double speed = n->uniform(0, 5), gap = n->spread(0.005, 0.5);
    double height = topOver(middle, 0.45 * cell, bounds, grid) + least_height + gap;
    for (int level = 0; level < levels; ++level) {
      Ball ball;
      ball.radius = std::max(0.004, cell * n->uniform(0.15, 0.3));
      ball.is_mesh = n->chance(0.5);
      ball.speed = speed;
      height += ball.radius + BALL_LAYER;
      ball.start = middle + Vector3(n->uniform(-0.1, 0.1) * cell, n->uniform(-0.1, 0.1) * cell, height);
      height += ball.radius + BALL_LAYER + 0.1 * cell;
      balls.push_back(ball);
    }
  }
  return balls;
}

inline sim::ObjectConfig objectOf(const Ball& ball, const std::string& name) {
  sim::ObjectConfig object = sim::exactBall(name, ball.radius, 4e3 * std::pow(ball.radius, 3));
  object.linear_velocity = {0, 0, -ball.speed};
  object.X_WO = makePose(ball.start);
  if (ball.is_mesh) {
    object.urdf_xml.clear();
    object.uri = sim::meshFile("rain_ball", geometry::icosphereMesh(1, BALL_LEVEL));
    object.scale = Vector3::Constant(ball.radius);
  }
  return object;
}

/** The mesh that balls fall on, in its own frame, and the way of each ball's centre. */
class Ways {
 public:
  Ways(const sim::Simulator& simulator, const std::vector<Ball>& balls, ElementGrid* grid)
      : simulator_(simulator), balls_(balls), grid_(*grid), ways_(balls.size()) {
    ground_ = colliderOf(simulator, "ground");
    const double inscribed = inscribedRadius() * (1 - 1e-9);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      ways_[i].collider = colliderOf(simulator, nameOf(i));
      // The centre of an exact ball is all there is of it without its layer.
      ways_[i].inside = balls[i].is_mesh ? inscribed * balls[i].radius : 0.01 * balls[i].radius;
    }
  }

  static std::string nameOf(std::size_t ball) { return fmt::format("ball{}", ball); }

  /** Takes a step's state and events in. */
  void look(RainOutcome* outcome) {
    const sim::StepReport& report = simulator_.report();
    for (Way& way : ways_) {
      for (const sim::LayerEventReport& event : report.layer_events)
        way.told = way.told || (event.outside && (event.collider_a == way.collider || event.collider_b == way.collider));
      if (way.crossed && !way.judged) outcome->untold += way.told ? 0 : 1, way.judged = true;
    }
    for (std::size_t i = 0; i < ways_.size(); ++i) lookAt(i, outcome);
    for (const sim::ContactReport& contact : report.contacts)
      if (contact.collider_a == ground_ || contact.collider_b == ground_) {
        outcome->max_of_layer = std::max(outcome->max_of_layer, contact.of_layer);
        const int other = contact.collider_a == ground_ ? contact.collider_b : contact.collider_a;
        for (Way& way : ways_) way.touched = way.touched || way.collider == other;
      }
  }

  int touched() const {
    return static_cast<int>(std::count_if(ways_.begin(), ways_.end(), [](const Way& way) { return way.touched; }));
  }

 private:
  struct Way {
    int collider = -1;
    double inside = 0;  ///< [m] nothing of the mesh may be nearer to the centre
    std::optional<Vector3> last;
    bool touched = false, told = false, crossed = false, judged = false;
  };

  void lookAt(std::size_t ball, RainOutcome* outcome) {
    Way& way = ways_[ball];
    const Vector3 centre = poseOf(simulator_, ground_).inverse() * centreOf(simulator_, way.collider);
    const Vector3 from = way.last.value_or(centre);
    way.last = centre;
    if (way.crossed || !centre.allFinite()) return;
    Box box(from.cwiseMin(centre), from.cwiseMax(centre));
    box.extend(centre + Vector3::Constant(way.inside)).extend(centre - Vector3::Constant(way.inside));
    grid_.visit(box, [&](int i) {
      const geometry::Triangle triangle = grid_.triangle(i);
      way.crossed = way.crossed || geometry::closestPointTriangle(centre, triangle).distance < way.inside ||
                    geometry::segmentCrossesTriangle(from, centre, triangle);
    });
    if (!way.crossed) return;
    if (outcome->crossed++ == 0)
      outcome->first_crossing =
          fmt::format("{} ball {} of radius {:.4g} m at {:.3f} s, {:.4g} {:.4g} {:.4g} m", balls_[ball].is_mesh ? "meshed" : "exact", ball,
                      balls_[ball].radius, simulator_.time(), centre.x(), centre.y(), centre.z());
  }

  const sim::Simulator& simulator_;
  const std::vector<Ball>& balls_;
  ElementGrid& grid_;
  std::vector<Way> ways_;
  int ground_ = -1;
};

inline bool isFinite(const sim::StepReport& report) {
  bool finite = !(report.status & sim::STATE_NOT_FINITE);
  for (const dynamics::BodyState& body : report.bodies)
    finite = finite && body.X_WB.matrix().allFinite() && body.v_WCom.allFinite() && body.w_WB.allFinite();
  return finite;
}

inline void addStep(const sim::StepReport& report, RainOutcome* outcome) {
  outcome->finite = outcome->finite && isFinite(report);
  outcome->unreliable_steps += (report.status & sim::CONTACT_UNRELIABLE) != 0;
  outcome->troubled_steps += (report.status & sim::SOLVER_TROUBLE) != 0;
  outcome->gained_steps += (report.status & sim::ENERGY_GAINED) != 0;
  for (const dynamics::BodyState& body : report.bodies) outcome->fastest = std::max(outcome->fastest, body.v_WCom.norm());
}

}  // namespace rain

/**
 * Lets balls rain on a file for some simulated time. Sizes suit the file; they fall for up to half a metre and begin with up to 5 m/s.
 * @throws InputError if the file is refused
 */
inline RainOutcome rainOn(const std::string& file, double seconds, std::uint64_t seed) {
  sim::SimulationConfig config;
  sim::EnvironmentConfig ground;
  ground.name = "ground";
  ground.uri = file;
  config.environments = {ground};
  const sim::Simulator dry(config, model::UriResolver());
  const contact::Collider& collider = dry.colliders()[colliderOf(dry, "ground")];
  ElementGrid grid(collider.geometry->mesh());
  SceneNumbers n(seed);
  std::vector<rain::Ball> balls = rain::ballsOver(collider.geometry->bounds(), collider.radius, &grid, &n);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls[i].start = collider.X_BC * balls[i].start;
    config.objects.push_back(rain::objectOf(balls[i], rain::Ways::nameOf(i)));
  }
  sim::Simulator simulator(config, model::UriResolver());
  rain::Ways ways(simulator, balls, &grid);
  RainOutcome outcome;
  outcome.balls = static_cast<int>(balls.size());
  for (long i = std::lround(seconds / config.time_step); i > 0 && outcome.finite; --i) {
    rain::addStep(simulator.step(), &outcome);
    ways.look(&outcome);
  }
  outcome.touched = ways.touched();
  return outcome;
}

}  // namespace blem_sim
