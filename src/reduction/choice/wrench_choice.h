// Choice of the k contacts that span the wrenches of all of them best.
#pragma once

#include <memory>
#include <vector>

#include "blem_sim/contact/contact_order.h"
#include "choice/choice_question.h"

namespace blem_sim::reduction {

/** Chooses by wrenches; keeps its room. */
class WrenchChoice {
 public:
  WrenchChoice();
  ~WrenchChoice();

  /**
   * Chooses at most k contacts: the deepest, then greedily the extreme contact of that fixed 6-D wrench direction in which the contacts
   * chosen so far lack most; then, with the rest of k, the same where depth counts too, and at last the deepest. Contacts that do not touch
   * yet stand back.
   * A choice made before is gone on with, completed by the same rule, while it spans nearly as much as a fresh one: among equals no noise
   * decides anew from step to step.
   * The result depends on the sets given only, not on their order.
   * Precondition: candidates are there.
   * @param candidates those of the members that may be extreme; reordered
   * @param chosen overwritten by indices
   * @return lack of those chosen in the candidates' wrenches, in the direction that lacks most, of a unit force; lengths in the scale's
   * radius
   */
  float choose(const ChoiceQuestion& asked, std::vector<int>* candidates, std::vector<int>* chosen);

  /** Lack of `kept`, as choose tells it, in the wrenches of all contacts. @return 1 if some contact is not sound */
  float lack(const std::vector<contact::Contact>& all, const std::vector<contact::Contact>& kept);

 private:
  class Spans;
  std::unique_ptr<Spans> spans_;
  contact::CanonicalOrder order_;
  std::vector<int> continued_, rest_, taken_;

  void addDeepest(const ChoiceQuestion& asked, std::vector<int>* chosen);
};

}  // namespace blem_sim::reduction
