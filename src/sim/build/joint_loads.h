// Loads of a robot's joints, what each has to move and to hold, and gains for them.
#pragma once

#include <vector>

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

/** One side of a joint as its axis meets it, all other joints being stiff. */
struct JointSide {
  double inertia = 0;  ///< [kg m^2 or kg] about or along the axis
  double weight = 0;   ///< [N m or N] largest effort of gravity on it, however the robot is turned
};

/** A joint parts a tree in two: what its child carries, and the rest, which it has to carry when the child stands on the ground. */
struct JointLoad {
  JointSide child;
  JointSide rest;       ///< zero where the root is part of the world
  double friction = 0;  ///< [N m or N] dry
};

/**
 * Loads of a robot's joints.
 * @param positions of the joints [rad or m] at which the sides are stiff; gravity: its size [m/s^2]
 * @return one per lumped joint; zero for floating ones, where trees end
 */
std::vector<JointLoad> jointLoads(const model::LumpedRobot& robot, const std::vector<double>& positions, bool fixed_base, double gravity);

/**
 * Inertia that a joint's effort meets at least: both sides in series, since a free robot gives way at both.
 * @return [kg m^2 or kg]
 */
double lightInertia(const JointLoad& load);

/** Adds the loads of joints that mimic others to those of the joints that they follow, whose motors move them. */
void addFollowers(const model::LumpedRobot& robot, std::vector<JointLoad>* loads);

/**
 * Gains of the implicit law that hold a pose: p lets friction and the weight of the heavier side keep the joint off by 1 mrad (sliders
 * 0.1 mm) at most, with no more effort than the limit, and swings the child at 10 Hz at least; d is critical damping of the heavier side.
 */
JointGains computedGains(const JointLoad& load, const model::LumpedJoint& joint, double effort_limit);

}  // namespace blem_sim::sim
