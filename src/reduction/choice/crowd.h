// Crowds of contacts on noise or curved surfaces, thinned before the choice.
#pragma once

#include <memory>
#include <vector>

#include "choice/choice_question.h"

namespace blem_sim::reduction {

/** Thins crowds; keeps its room. */
class CrowdThinner {
 public:
  CrowdThinner();
  ~CrowdThinner();

  /**
   * Keeps in every cell of alike normals (some degrees) the contacts that are extreme in some mixture of place and tilt across its normal,
   * contacts that do not touch yet standing back; the deepest; and those chosen before.
   * The choice depends on the set of members only, not on their order.
   * @param kept overwritten by those to keep, indices of contacts
   */
  void thin(const ChoiceQuestion& asked, std::vector<int>* kept);

 private:
  struct Room;
  std::unique_ptr<Room> room_;
};

}  // namespace blem_sim::reduction
