// Quantities of a whole world that theory knows: gaps of joints, momenta, hashes. World axes.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/dynamics/world.h"

namespace blem_sim {

/** Pose of a joint's frame as the parent has it. */
Pose jointFrame(const World& world, int joint);
/** [m] between the parent's and the child's idea of the joint's origin (of a sliding one: off its line). */
double jointGap(const World& world, int joint);
/** [rad] between the parent's and the child's idea of the joint's axis (of a fixed one: of the whole frame). */
double jointTilt(const World& world, int joint);
/** The worst of all joints. */
double worstJointGap(const World& world);
double worstJointTilt(const World& world);

Vector3 bodyCom(const World& world, int body);
double totalMass(const World& world, const std::vector<int>& bodies);
Vector3 centreOfMass(const World& world, const std::vector<int>& bodies);
Vector3 momentum(const World& world, const std::vector<int>& bodies);                               ///< [kg m/s]
Vector3 angularMomentum(const World& world, const std::vector<int>& bodies, const Vector3& about);  ///< [kg m^2/s]
/** [J] kinetic, in the frame that moves with their centre of mass. */
double innerKineticEnergy(const World& world, const std::vector<int>& bodies);
/** Wrench that the bodies' motion over a step needs, less gravity, about a point; lever arms and inertias of the step's start. */
Wrench neededWrench(const World& world, const std::vector<BodyState>& before, const std::vector<int>& bodies, double dt,
                    const Vector3& about);
std::vector<BodyState> bodyStates(const World& world);

/** Bodies of a tree get the velocities that joint speeds (one per joint slot) and the root's twist give. Precondition: joints sorted
 *  parents first. @param v [m/s] of the root's frame @param w [rad/s] */
void setJointSpeeds(World* world, int root, const std::vector<double>& speeds, const Vector3& v, const Vector3& w);

double rmsJointSpeed(const World& world);  ///< [rad/s or m/s] over moving joints
std::uint64_t hashOf(const WorldState& state);

}  // namespace blem_sim
