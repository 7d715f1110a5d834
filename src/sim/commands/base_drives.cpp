#include "commands/base_drives.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/sim/trajectory.h"

namespace blem_sim::sim {
namespace {

constexpr double FULL = 1 - 1e-9;   // of a bound: all that it lets through
constexpr double MOST_WEIGHTS = 2;  // of a robot, by which it is pushed
constexpr double EARTH = 9.81;      // [m/s^2] weighs a robot in any gravity
constexpr double LEVER = 2;         // radii of gyration

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) { return Eigen::Rotation2Dd(angle) * v; }

dynamics::RootDrive driveOf(const BaseVelocityCommand& command, const CarriedFrame& frame, const dynamics::BodyState& state,
                            const Vector3& com_B, double dt) {
  const double half = 0.5 * dt * command.turn;
  const Vector3 ahead = state.X_WB.linear() * frame.x_B, lever = state.X_WB.linear() * (com_B - frame.p_B);
  const Eigen::Vector2d arm = turned(lever.head<2>(), half);
  dynamics::RootDrive drive;
  drive.velocity =
      turned({command.x, command.y}, std::atan2(ahead.y(), ahead.x()) + half) + command.turn * Eigen::Vector2d(-arm.y(), arm.x());
  drive.spin = command.turn;
  drive.max_force = command.max_force;
  drive.max_torque = command.max_torque;
  return drive;
}

struct Heft {
  double mass;    // [kg]
  double radius;  // [m] of gyration about z
};

Heft heftOf(const dynamics::World& world, const std::vector<int>& bodies) {
  double mass = 0, inertia = 0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const int body : bodies) {
    const geometry::MassProperties& of = world.bodySpec(body).inertial;
    const Pose X_WB = world.bodyState(body).X_WB;
    const Eigen::Vector2d com = (X_WB * of.com).head<2>();
    mass += of.mass;
    moment += of.mass * com;
    inertia += of.mass * com.squaredNorm() + (X_WB.linear() * of.inertia * X_WB.linear().transpose())(2, 2);
  }
  return {mass, std::sqrt(std::max(0.0, inertia - moment.squaredNorm() / mass) / mass)};
}

}  // namespace

BaseVelocityCommand withBounds(BaseVelocityCommand command, const dynamics::World& world, const std::vector<int>& bodies) {
  const Heft heft = heftOf(world, bodies);
  if (command.max_force == 0) command.max_force = MOST_WEIGHTS * EARTH * heft.mass;
  if (command.max_torque == 0) command.max_torque = LEVER * heft.radius * command.max_force;
  return command;
}

std::vector<BaseDrives::Driven>::iterator BaseDrives::placeOf(int body) {
  return std::lower_bound(driven_.begin(), driven_.end(), body, [](const Driven& driven, int wanted) { return driven.body < wanted; });
}

void BaseDrives::set(int body, const CarriedFrame& frame, const BaseVelocityCommand& command) {
  const auto place = placeOf(body);
  if (place != driven_.end() && place->body == body)
    *place = {body, frame, command};
  else
    driven_.insert(place, {body, frame, command});
}

void BaseDrives::clearBody(int body) {
  const auto place = placeOf(body);
  if (place != driven_.end() && place->body == body) driven_.erase(place);
}

const BaseVelocityCommand* BaseDrives::commandOf(int body) const {
  const auto place = std::find_if(driven_.begin(), driven_.end(), [&](const Driven& driven) { return driven.body == body; });
  return place == driven_.end() ? nullptr : &place->command;
}

const std::vector<dynamics::RootDrive>& BaseDrives::of(const dynamics::World& world, const std::vector<dynamics::BodyState>& states,
                                                       double dt) {
  of_solve_.clear();
  for (const Driven& driven : driven_) {
    of_solve_.push_back(driveOf(driven.command, driven.frame, states[driven.body], world.bodySpec(driven.body).inertial.com, dt));
    of_solve_.back().body = driven.body;
  }
  return of_solve_;
}

bool BaseDrives::areSaturated(const std::vector<Wrench>& wrenches) const {
  const auto isFull = [](const Wrench& wrench, const BaseVelocityCommand& command) {
    const double force = std::max(std::abs(wrench.force.x()), std::abs(wrench.force.y()));
    return force > FULL * command.max_force || std::abs(wrench.torque.z()) > FULL * command.max_torque;
  };
  for (std::size_t i = 0; i < driven_.size(); ++i)
    if (isFull(wrenches[i], driven_[i].command)) return true;
  return false;
}

void BaseDrives::save(geometry::StateWriter* writer) const {
  writer->number(static_cast<double>(driven_.size()));
  for (const auto& [body, frame, command] : driven_) {
    writer->numbers({static_cast<double>(body), command.x, command.y, command.turn, command.max_force, command.max_torque});
    writer->vector(frame.p_B);
    writer->vector(frame.x_B);
  }
}

void BaseDrives::restore(int bodies, geometry::StateReader* reader) {
  const double count = reader->number();
  driven_.clear();
  if (!(count >= 0 && count <= bodies) || count != std::floor(count)) reader->refuseContent("more bases are driven than there are bodies");
  for (int i = 0; i < count; ++i) {
    const double body = reader->number();
    if (!(body >= 0 && body < bodies) || body != std::floor(body) || (i > 0 && body <= driven_.back().body))
      reader->refuseContent("a base is driven that is not there");
    Driven driven{static_cast<int>(body), {}, {}};
    for (double* number :
         {&driven.command.x, &driven.command.y, &driven.command.turn, &driven.command.max_force, &driven.command.max_torque}) {
      *number = reader->number();
      if (!isCommand(*number)) reader->refuseContent("a base is driven by numbers that are too large");
    }
    if (!(driven.command.max_force > 0) || !(driven.command.max_torque > 0)) reader->refuseContent("a base is driven by bounds below 0");
    driven.frame.p_B = reader->vector();
    driven.frame.x_B = reader->vector();
    driven_.push_back(driven);
  }
}

}  // namespace blem_sim::sim
