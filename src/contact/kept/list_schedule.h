// The schedule of candidate lists: how far they reach, how long they are kept, when the next one is begun. It costs or saves time alone:
// with any numbers the contacts are the same bits.
#pragma once

#include <cstddef>

#include "kept/list_margin.h"

namespace blem_sim::contact {

/** Figures of a pair by which its lists are planned. */
struct ListFigures {
  bool known = false;                          ///< the pair was searched before, so that its motion is known
  double range = 0;                            ///< [m] of contacts
  double motion = 0;                           ///< [m] since the last search, of the point near the other mesh that moved farthest
  double turn = 0;                             ///< the same of unit vectors: length of the difference
  double growth = 0;                           ///< [1/m] candidates that a list gains with its margin; 0: not known
  std::size_t leaf_pairs = 0, candidates = 0;  ///< of the list at hand
  double margin = 0;                           ///< [m] of the list at hand
};

/** Numbers and rules. Steps are searches of a pair, one per solve; parts are of the range, unless another whole is named. */
struct ListSchedule {
  // ---- reach of lists for contacts
  static constexpr double MARGIN_STEPS = 15;    ///< steps of the present motion while growth is not known; raise if new pairs list often
  static constexpr double FEWEST_STEPS = 3;     ///< steps that a list must last; raise if fast pairs leave new lists at once
  static constexpr double MOST_STEPS = 50;      ///< steps that a list may last; raise if slow pairs list anew for no reason
  static constexpr double LEAST_PART = 0.7;     ///< of those steps, see partOf; lower it if many pairs list anew in one step
  static constexpr double LEAST_MARGIN = 0.02;  ///< part; raise if what trembles lists anew
  static constexpr double MOST_MARGIN = 0.8;    ///< part while growth is not known; raise if first lists are used up early
  static constexpr double MOST_KNOWN_MARGIN = 2.2;      ///< part where growth is known; raise if lists of sparse meshes are made often
  static constexpr double MOST_MARGIN_OF_MANY = 0.3;    ///< part with many pairs of leaves, since such lists grow faster; raise with MANY
  static constexpr std::size_t MANY_LEAF_PAIRS = 4000;  ///< pairs of leaves; raise if large lists turn out cheap
  static constexpr double FIRST_MARGIN = 0.1;           ///< part while the motion is not known; raise if second searches list anew
  static constexpr double LEAST_TURN = 0.005;           ///< of unit vectors; raise if what rocks lists anew
  static constexpr double FIRST_TURN = 0.05;            ///< of unit vectors while the motion is not known; raise with FIRST_MARGIN

  // ---- cost of lists, in candidates that are looked at when the nearest are chosen
  static constexpr double LEAF_PAIR_COST = 40;  ///< of a pair of leaves; raise if searching leaves has become dearer
  static constexpr double CANDIDATE_COST = 8;   ///< of listing a candidate; raise if listing has become dearer
  static constexpr double CHOICE_STEPS = 8;     ///< steps that a choice of the nearest lasts; raise if choices last longer

  // ---- the next list, made in parts while the one at hand is good
  static constexpr std::size_t PARTS = 4;  ///< steps that share its pairs of leaves; raise if steps with new lists stand out
  static constexpr std::size_t FEW_LEAF_PAIRS =
      64;                                     ///< so few are listed in one go; raise if parts of small lists cost more than they spread
  static constexpr double LASTING_STEPS = 5;  ///< steps that a list must last to be made in parts; raise with PARTS

  // ---- the pose ahead that a list is made for
  static constexpr double AHEAD = 0.9;           ///< part of the margin to that pose; raise if ways are straight, so that lists last longer
  static constexpr double AHEAD_AT_MOST = 0.98;  ///< part of the margin within which the pair must be of that pose; raise with AHEAD
  static constexpr double AHEAD_STEPS = 16;      ///< most steps ahead; raise if slow bodies go straight for longer
  static constexpr double NEWEST = 0.3;          ///< share of the last motion in the expected one; raise if ways bend quickly

  // ---- the nearest candidates of long lists
  static constexpr std::size_t FEW_CANDIDATES = 50;  ///< so few are tested all; raise if choosing has become dearer than testing
  static constexpr double NEAREST_STEPS = 3;         ///< steps of a choice while growth is not known; raise if first choices are made often
  static constexpr double FEWEST_NEAREST_STEPS = 2;  ///< raise if choices are made in most steps
  static constexpr double MOST_NEAREST_STEPS = 8;    ///< raise if slow pairs choose anew for no reason
  static constexpr double MOST_NEAREST_PART = 0.4;   ///< part of the list's margin; raise if lists are long though margins are small
  static constexpr double LEAST_NEAREST_MARGIN = 0.005;  ///< part; raise if what trembles chooses anew
  static constexpr double LEAST_NEAREST_TURN = 0.001;    ///< of unit vectors; raise if what rocks chooses anew

  // ---- lists for crossings
  static constexpr double CROSSING_STEPS = 10;  ///< steps of the present motion, or those that fit into the largest margin; raise if what
                                                ///< touches lists crossings often
  static constexpr double BEND = 0.05;          ///< part of the way that pairs may leave it by; raise if ways bend quickly

  /** Whether the pair is too fast for lists to last. */
  static bool isFast(const ListFigures& now) { return FEWEST_STEPS * now.motion > MOST_MARGIN * now.range; }
  /** Whether lists grow faster than their margins. */
  static bool areMany(const ListFigures& now) { return now.leaf_pairs > MANY_LEAF_PAIRS; }
  /** Largest margin [m] of lists whose growth is not known. */
  static double mostMargin(const ListFigures& now) { return (areMany(now) ? MOST_MARGIN_OF_MANY : MOST_MARGIN) * now.range; }
  /** A number from LEAST_PART to 1 that is another for every pose: pairs that set out together shall not all need new lists in one step. */
  static double partOf(const Pose& X_FM);

  /** Steps of the cheapest list. A longer list is made less often, but its additional candidates are looked at whenever the nearest are
   * chosen. A list of margin m lasts 2 m / motion steps; it takes some cost anyway and some more in proportion to m. */
  static double cheapestSteps(const ListFigures& now);
  /** Margin of the next list for contacts. @param part of the steps that it is made for, see partOf */
  static ListMargin contactMargin(const ListFigures& now, double part);
  /** Steps of the next list for crossings. */
  static double crossingSteps(const ListFigures& now);

  /** Pairs of leaves that a step looks at for the next list. */
  static std::size_t partOfPairs(std::size_t leaf_pairs) { return (leaf_pairs + PARTS - 1) / PARTS; }
  /** Whether a list of that margin [m] is good for much longer than its making takes. */
  static bool lasts(double margin, const ListFigures& now) { return LASTING_STEPS * now.motion <= margin; }
  /** Whether a list is good for no longer than making the next one takes, if the pair goes on to leave it so. @param before, used parts of
   * its margin that were used up at the last search, and are now */
  static bool endsSoon(double before, double used) {
    constexpr double STEPS = PARTS + 1;
    return used > before && used + STEPS * (used - before) > 1;
  }

  /** Steps to the pose ahead that a list of that margin [m] is best made for. */
  static double stepsAhead(double margin, const ListFigures& now);
  /** Margin within which the pair must be of the pose ahead. */
  static ListMargin marginAhead(const ListMargin& margin) {
    return {AHEAD_AT_MOST * margin.motion, AHEAD_AT_MOST * margin.turn, AHEAD_AT_MOST * margin.ways};
  }

  /** Steps that the nearest are chosen for: for more there are more to test, for fewer all are looked at more often. To look at one takes
   * about as long as to test it; a choice of margin m lasts 2 m / motion steps. Few enough for a choice, if the list's margin is not too
   * small for any. */
  static double nearestSteps(const ListFigures& now);
  /** Margin of the nearest for so many steps of the present motion. */
  static ListMargin nearestMargin(const ListFigures& now);
  /** Whether the nearest, within that margin [m], are worth a choice. */
  static bool isWorthChoosing(double margin, const ListFigures& now) {
    return now.candidates > FEW_CANDIDATES && margin < 0.5 * now.margin;
  }
  /** Growth [1/m] of lists, as a choice shows it. @param near candidates within that margin [m] */
  static double growth(std::size_t near, double margin, const ListFigures& now);
};

}  // namespace blem_sim::contact
