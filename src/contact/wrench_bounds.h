// How far the wrenches of two contacts can differ.
#pragma once

namespace blem_sim {

// A largest component changes by no more than these times the way to another place [radii], and to another normal: both stem from
// |g.n + mu |g - (g.n) n|| <= sqrt(1 + mu^2) |g|, with mu 0.5, |g| <= sqrt(2), and angles up to pi / 2 times their chords.
constexpr float PER_PLACE = 1.12f, PER_NORMAL = 2.49f;
constexpr float ROUNDING = 1e-3f;  // of unit forces: components are floats

}  // namespace blem_sim
