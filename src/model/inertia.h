// Masses and inertias: sums over frames, repair, and substitutes where the URDF gives none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blem_sim/model/robot_model.h"

namespace blem_sim::model {

/** The same inertial seen from frame A. @param X_AB pose of the frame B it is given in */
Inertial movedTo(const Pose& X_AB, const Inertial& inertial);

/** Sum of two inertials in the same frame, about their common centre of mass. Massless ones add their inertia only. */
Inertial sum(const Inertial& a, const Inertial& b);

/** A body in texts: where it is from, which notes need not say, and its name. */
struct NamedBody {
  std::string source, name;
};

/**
 * Makes the inertia of a body with mass positive definite where rounding or a zero spoilt it; says so in `notes`.
 * @throws InputError if it is far from positive definite
 */
void repairInertia(const NamedBody& body, Inertial* inertial, std::vector<std::string>* notes);

/** Inertial of collision shapes at 1000 kg/m^3, in the shapes' frame: solid where closed, else a shell of 1 mm. None without a shape. */
std::optional<Inertial> inertialOfShapes(const std::vector<CollisionShape>& shapes);

/** A solid ball of 0.01 kg and 1 cm. */
Inertial smallBall();

}  // namespace blem_sim::model
