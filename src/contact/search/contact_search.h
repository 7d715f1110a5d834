// The contacts of two meshes, from lists of candidates that are kept while they are good.
#pragma once

#include "evaluation/contact_evaluation.h"
#include "features/mesh_pair.h"
#include "kept/steady_motion.h"
#include "search/candidate_search.h"

namespace blem_sim::contact {

/** A listing, and its successor, made a part at a time. */
struct KeptListing {
  CandidateListing now, next;
};

/** Memory of a pair of meshes from search to search; it saves time and changes no result. */
struct ContactSearchMemory {
  std::uint64_t moving = 0, fixed = 0;  ///< identities of the two geometries
  KeptListing contacts;                 ///< for many steps
  CandidatePairs nearest;               ///< candidates of `contacts` that matter for a few steps
  ListOrigin nearest_origin;
  double growth = 0;      ///< [1/m] candidates that a list gains with its margin; 0: not known
  KeptListing crossings;  ///< only where the meshes may have met
  bool visited = false;
  Pose X_FM = Pose::Identity();  ///< at the last search
  SteadyMotion motion;           ///< of the moving mesh
  double distance = 0;           ///< [m] of the meshes at that search, at least; 0 if they crossed
};

/** Buffers of the searches of one thread. */
struct ContactSearchBuffers {
  static constexpr std::size_t ROOM = 512;  ///< so that the first search without a memory, in a warm step, asks for hardly any

  ContactSearchBuffers() {
    for (KeptListing* listing : {&unknown.contacts, &unknown.crossings}) listing->now.reserve(ROOM);
  }
  ContactSearchBuffers(const ContactSearchBuffers&) = delete;  // the evaluation's buffers refer to the search's

  CandidateSearchBuffers search;
  EvaluationBuffers evaluation{&search.surroundings};
  ContactSearchMemory unknown;  ///< for searches without a memory
};

/**
 * Finds the contacts of two meshes: every pair of simplices, each asked once by its two owners. Complete: see narrow_phase.h. The result
 * depends on the pair alone.
 * @param memory of this pair; null: everything is searched anew
 */
void searchContacts(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, EvaluatedContacts* found);

}  // namespace blem_sim::contact
