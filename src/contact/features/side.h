// The two sides of a pair of meshes. No Eigen here: the kernels include it.
#pragma once

#include <cstdint>

namespace blem_sim::contact {

/** The mesh with fewer elements moves and is seen from the frame of the other one, which is fixed; over a half-space the mesh moves. Which
 * of them is A, and which B, is known where contacts are placed and named (ContactRoles). */
enum class Side : std::uint8_t { FIXED, MOVING };

/** The order in which the sides are gone through. */
constexpr Side SIDES[] = {Side::MOVING, Side::FIXED};

/** The other side. */
constexpr Side operator!(Side side) { return side == Side::MOVING ? Side::FIXED : Side::MOVING; }

/** One value for each side. */
template <typename T>
struct PerSide {
  T moving, fixed;

  T& operator[](Side side) { return side == Side::MOVING ? moving : fixed; }
  const T& operator[](Side side) const { return side == Side::MOVING ? moving : fixed; }
};

}  // namespace blem_sim::contact
