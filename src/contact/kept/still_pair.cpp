#include "kept/still_pair.h"

#include <cstring>

namespace blem_sim::contact {
namespace {

bool haveSameBits(const Pose& X, const Pose& Y) { return std::memcmp(X.data(), Y.data(), sizeof(Pose::MatrixType)) == 0; }

bool areSame(const ContactRoles& a, const ContactRoles& b) {
  return a.a == b.a && a.radius.moving == b.radius.moving && a.radius.fixed == b.radius.fixed;
}

}  // namespace

bool StillPair::isSame(const MeshPair& pair) {
  if (moving_ == pair.moving.identity && fixed_ == pair.fixed.identity && range_ == pair.range && areSame(roles_, pair.roles) &&
      haveSameBits(X_FM_, pair.X_FM) && haveSameBits(X_WF_, pair.X_WF))
    return true;
  moving_ = pair.moving.identity;
  fixed_ = pair.fixed.identity;
  X_FM_ = pair.X_FM;
  X_WF_ = pair.X_WF;
  range_ = pair.range;
  roles_ = pair.roles;
  known_ = false;
  return false;
}

void StillPair::recall(ContactManifold* out) const { out->contacts = contacts_; }

void StillPair::keep(const ContactManifold& found) {
  known_ = !found.pierced;
  if (known_) contacts_ = found.contacts;
}

}  // namespace blem_sim::contact
