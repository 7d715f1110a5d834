#include "messages/status_text.h"

#include "blem_sim/sim/step_status.h"

namespace blem_sim::node {

std::vector<std::string> statusNames(std::uint32_t status) {
  std::vector<std::string> names;
  for (const sim::StatusBit& row : sim::STEP_STATUS) {
    if ((status & row.bit) != 0) names.emplace_back(row.name);
  }
  return names;
}

std::vector<std::string> statusAdvice(std::uint32_t status) {
  std::vector<std::string> texts;
  for (const sim::StatusBit& row : sim::STEP_STATUS) {
    if ((status & row.bit) != 0 && *row.cure) texts.push_back(std::string(row.meaning) + ": " + row.cure);
  }
  return texts;
}

std::string stoppedText(std::uint32_t made, std::uint32_t asked, std::uint32_t status) {
  const std::string text = "stopped after " + std::to_string(made) + " of " + std::to_string(asked) + " steps";
  return (status & sim::STATE_NOT_FINITE) != 0 ? text + ": " + statusAdvice(sim::STATE_NOT_FINITE).front() : text;
}

}  // namespace blem_sim::node
