// Drives of robots' bases over the ground, from their commands to those of a solve.
#pragma once

#include <vector>

#include "blem_sim/dynamics/world.h"
#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

/** A frame that a body carries, as far as commands need it. */
struct CarriedFrame {
  Vector3 p_B = Vector3::Zero();   ///< its origin
  Vector3 x_B = Vector3::UnitX();  ///< its axis ahead
};

/** The command with the bounds that it leaves out. @param bodies of the robot, where they are */
BaseVelocityCommand withBounds(BaseVelocityCommand command, const dynamics::World& world, const std::vector<int>& bodies);

/** Drives in the order of their bodies, one each at most. State: all of them. */
class BaseDrives {
 public:
  /** Begins, or replaces, the drive of a body. @param command with bounds above 0 */
  void set(int body, const CarriedFrame& frame, const BaseVelocityCommand& command);
  void clearBody(int body);
  bool empty() const { return driven_.empty(); }
  /** The command of a body; null: it has none. */
  const BaseVelocityCommand* commandOf(int body) const;

  /**
   * Drives of a solve of dt [s]. Targets are those of its middle, so that a command leads its frame on an arc.
   * @param states of the world's bodies at its start
   */
  const std::vector<dynamics::RootDrive>& of(const dynamics::World& world, const std::vector<dynamics::BodyState>& states, double dt);
  /** Whether the last solve has taken all that a drive may give. */
  bool areSaturated(const std::vector<Wrench>& wrenches) const;

  void save(geometry::StateWriter* writer) const;
  /** @param bodies slots that drives can be on */
  void restore(int bodies, geometry::StateReader* reader);

 private:
  struct Driven {
    int body;
    CarriedFrame frame;
    BaseVelocityCommand command;
  };
  std::vector<Driven>::iterator placeOf(int body);

  std::vector<Driven> driven_;
  std::vector<dynamics::RootDrive> of_solve_;
};

}  // namespace blem_sim::sim
