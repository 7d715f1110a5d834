// Joint wrenches from motion: Newton-Euler backwards over one accepted step.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene/stepper.h"

namespace blem_sim::dynamics {

/**
 * Wrench from every joint's parent on its child (constraint, motor and friction together): world axes, about the joint frame's origin at
 * the start of the step, where the equations of the step hold: lever arms, contact points and inertias are those of the start, momenta
 * change over the step. So a chain at rest carries exactly its weight, and in motion the wrench is the solver's own to its
 * residual. ODE's implicit gyroscopic torque is taken into account as ODE does [Lacoursiere 2006]. A joint that closes a loop is not
 * determined by motion: there ODE's feedback is taken. Precondition: the scene is at the end of the step, its pending wrenches still those
 * of the step.
 */
void jointWrenches(const Scene& scene, const std::vector<BodyBits>& start, const StepInput& input, const SolveResult& result,
                   std::vector<Wrench>* wrenches);

}  // namespace blem_sim::dynamics
