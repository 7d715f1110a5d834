// Was too much of a boundary layer used up by a step? Then it is made again in halves [Hauser 2013, 3.3].
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "simulated_world.h"

namespace blem_sim {

/**
 * A pair is in danger if a step
 * - made its bare meshes cross, or
 * - used up more than 0.9 of its layer, at least 0.1 of it in this step, or
 * - carried a contact that existed before it, solved or left out, as far: then the pair may have passed through.
 * Pairs without a layer cannot be guarded.
 * @param before, after manifolds at the two ends of the step, sorted by (a, b); bodies_before, bodies_after by body slot
 */
bool usesUpLayer(const std::vector<Collider>& colliders, const std::vector<ContactManifold>& before,
                 const std::vector<ContactManifold>& after, const std::vector<BodyState>& bodies_before,
                 const std::vector<BodyState>& bodies_after);

/** Divides one step into substeps, halved on demand, at most 16 of them. */
class Substeps {
 public:
  static constexpr int TICKS = 16;

  bool finished() const { return done_ == TICKS; }
  double fraction() const { return static_cast<double>(size_) / TICKS; }  ///< of the step, the substep at hand
  double fractionDone() const { return static_cast<double>(done_) / TICKS; }
  bool canHalve() const { return size_ > 1; }
  void halve() { size_ /= 2; }
  void accept() {
    done_ += size_;
    ++count_;
  }
  int count() const { return count_; }  ///< accepted so far

 private:
  int size_ = TICKS, done_ = 0, count_ = 0;
};

}  // namespace blem_sim
