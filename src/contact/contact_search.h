// The contacts of two meshes, from lists of candidates that are kept while they are good.
#pragma once

#include "candidate_lists.h"
#include "contact_evaluation.h"
#include "mesh_pair.h"

namespace blem_sim {

/** Where a list of candidates was made: it is good while the meshes have not moved against each other by more than the margin. */
struct ListOrigin {
  bool known = false;
  Pose X_FM = Pose::Identity();
  double range = 0;  ///< [m]
  ListMargin margin;
};

/** What is kept of a pair of meshes from search to search; it saves time and changes no result. */
struct ContactSearchMemory {
  std::uint64_t moving = 0, fixed = 0;  ///< whose
  CandidateLists lists;                 ///< for many steps
  CandidatePairs nearest;               ///< those of them that matter for a few
  CandidateLists crossing_lists;        ///< only where the meshes may have met
  ListOrigin lists_origin, nearest_origin, crossings_origin;
  bool visited = false;
  Pose X_FM = Pose::Identity();  ///< at the last search
  double distance = 0;           ///< [m] of the meshes then, at least; 0 if they crossed
};

/** What searches of one thread work in. */
struct ContactSearchBuffers {
  CandidateSearchBuffers search;
  EvaluationBuffers evaluation;
  ContactSearchMemory unknown;  ///< for searches without a memory
};

/**
 * Finds the contacts of two meshes: every pair of simplices, each asked once by its two owners. Complete: see narrow_phase.h. The result
 * depends on the pair alone.
 * @param memory of this pair; null: everything is searched anew
 */
void searchContacts(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, FoundContacts* found);

}  // namespace blem_sim
