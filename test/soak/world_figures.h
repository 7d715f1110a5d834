// Quantities of a whole world that theory knows: gaps of joints, momenta, hashes. World axes.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/dynamics/world.h"

namespace blem_sim {

/** Pose of a joint's frame as the parent has it. */
Pose jointFrame(const dynamics::World& world, int joint);
/** [m] between the parent's and the child's idea of the joint's origin (of a sliding one: off its line). */
double jointGap(const dynamics::World& world, int joint);
/** [rad] between the parent's and the child's idea of the joint's axis (of a fixed one: of the whole frame). */
double jointTilt(const dynamics::World& world, int joint);
/** The worst of all joints. */
double worstJointGap(const dynamics::World& world);
double worstJointTilt(const dynamics::World& world);

Vector3 bodyCom(const dynamics::World& world, int body);
double totalMass(const dynamics::World& world, const std::vector<int>& bodies);
Vector3 centreOfMass(const dynamics::World& world, const std::vector<int>& bodies);
Vector3 momentum(const dynamics::World& world, const std::vector<int>& bodies);                               ///< [kg m/s]
Vector3 angularMomentum(const dynamics::World& world, const std::vector<int>& bodies, const Vector3& about);  ///< [kg m^2/s]
/** [J] kinetic, in the frame that moves with their centre of mass. */
double innerKineticEnergy(const dynamics::World& world, const std::vector<int>& bodies);
/** Wrench that the bodies' motion over a step needs, less gravity, about a point; lever arms and inertias of the step's start. */
Wrench neededWrench(const dynamics::World& world, const std::vector<dynamics::BodyState>& before, const std::vector<int>& bodies, double dt,
                    const Vector3& about);
std::vector<dynamics::BodyState> bodyStates(const dynamics::World& world);

/** Bodies of a tree get the velocities that joint speeds (one per joint slot) and the root's twist give. Precondition: joints sorted
 *  parents first. @param v [m/s] of the root's frame @param w [rad/s] */
void setJointSpeeds(dynamics::World* world, int root, const std::vector<double>& speeds, const Vector3& v, const Vector3& w);

double rmsJointSpeed(const dynamics::World& world);  ///< [rad/s or m/s] over moving joints
std::uint64_t hashOf(const dynamics::WorldState& state);

}  // namespace blem_sim
