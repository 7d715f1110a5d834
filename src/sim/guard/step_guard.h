// Steps that used up too much of a boundary layer, though step_prediction.h saw no danger: they are made again, shorter.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "contacts/constraints/made_solve.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/**
 * A pair is in danger if a step
 * - made its bare meshes cross, or
 * - used up more than 0.9 of its layer, at least 0.1 of it in this step, or more than 0.2 of it in this step, or
 * - carried a contact that existed before it, solved or left out, as far: then the pair may have passed through.
 * Pairs without a layer cannot be guarded.
 * @param made the step @param after contacts at its end @param threads that look at pairs at once
 */
bool usesUpLayer(const std::vector<contact::Collider>& colliders, const MadeSolve& made, const FoundContacts& after, StepThreads* threads);

/**
 * Divides one step into substeps of whole ticks. So a step costs at most MAX_SOLVES solves, and as many searches for contacts, whatever
 * happens in it.
 */
class Substeps {
 public:
  static constexpr int MAX_SUBSTEPS = 16, MAX_REDONE = 4, MAX_REPEATED = 4;
  static constexpr int MAX_SOLVES = MAX_SUBSTEPS + MAX_REDONE + 2 * MAX_REPEATED;

  /** @param most [ticks] of a substep, a power of 2 */
  explicit Substeps(int most = MAX_SUBSTEPS) : most_(most), size_(most) {}

  bool finished() const { return done_ == MAX_SUBSTEPS; }
  double fraction() const { return static_cast<double>(size_) / MAX_SUBSTEPS; }  ///< of the step, the substep at hand
  double fractionDone() const { return static_cast<double>(done_) / MAX_SUBSTEPS; }
  double fractionLeft() const { return static_cast<double>(MAX_SUBSTEPS - done_) / MAX_SUBSTEPS; }           ///< with the substep at hand
  double fractionAfter() const { return static_cast<double>(MAX_SUBSTEPS - done_ - size_) / MAX_SUBSTEPS; }  ///< without it
  /** The next substep takes at most this part (0 to 1) of the rest of the step, in whole ticks, at least one. */
  void plan(double part);
  bool canRedo() const { return redone_ < MAX_REDONE && (size_ > 1 || !redone_at_hand_); }
  /** Makes the substep at hand again, in this part (0 to 1) of its length in whole ticks, half of it at most, at least one. A substep of
   * one tick is made again once: its contacts are known farther then. */
  void redo(double part);
  /** Takes the longest solve, as a part of the step, that links in tension can take. If the substep at hand is longer, it and all that
   * follow are even parts of the step: swings that grow with the length of solves grow as well where it changes. */
  void bound(double part);
  /** The substep at hand is longer than that. */
  bool isBeyondBound() const { return size_ > most_; }
  /** [ticks] of the next step's substeps at most: twice as many as in this one where links could take them with some room. */
  int nextMost() const;
  bool canRepeat() const { return repeated_ < MAX_REPEATED && !repeated_at_hand_; }
  /** Makes the substep at hand again as long as it is, once: with contacts that are known better. */
  void repeat();
  void accept();
  int count() const { return count_; }                    ///< accepted so far
  int redone() const { return redone_ + 2 * repeated_; }  ///< solves thrown away so far
  /** The substep at hand is made again: its length is fixed. */
  bool isRedone() const { return redone_at_hand_ || repeated_at_hand_; }

 private:
  int most_, size_;                                           // ticks
  double longest_ = std::numeric_limits<double>::infinity();  // ticks that links in tension can take
  int done_ = 0, count_ = 0, redone_ = 0;
  int repeated_ = 0;
  bool redone_at_hand_ = false, repeated_at_hand_ = false;
};

}  // namespace blem_sim::sim
