// Form of a refusal's text.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

/** Text of the InputError that `action` throws; empty if it throws none. Other exceptions pass and fail the test. */
template <typename Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/** One line that holds each word. */
inline bool isOneLineWith(const std::string& text, const std::vector<std::string>& words) {
  if (text.empty() || text.find('\n') != std::string::npos) return false;
  for (const std::string& word : words)
    if (text.find(word) == std::string::npos) return false;
  return true;
}

}  // namespace blem_sim
