// Crowds of contacts on noise or curved surfaces, thinned before the choice.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/reduction/reduction.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

/**
 * Keeps in every cell of alike normals (some degrees) the contacts that are extreme in some mixture of place and tilt across its normal,
 * contacts that do not touch yet standing back; the deepest; and those of the ids `spared`.
 * The choice depends on the set of members only, not on their order.
 * @param scale of all contacts @param members indices of contacts
 * @param kept overwritten by those to keep
 */
void thinCrowd(const std::vector<contact::Contact>& contacts, const PatchScale& scale, const std::vector<int>& members,
               const ContactIds& spared, std::vector<int>* kept);

}  // namespace blem_sim::reduction
