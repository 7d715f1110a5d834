#include "gazebo/gazebo_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace blem_sim::sim {
namespace {

constexpr std::size_t LONGEST_WORDS = 300;  // characters
constexpr std::size_t LISTED = 20;          // names in a line, and lines on faults

}  // namespace

void GazeboNotes::List::tell(const std::string& beginning, const std::string& end, std::vector<std::string>* lines) const {
  if (names_.empty()) return;
  const auto last = names_.begin() + static_cast<std::ptrdiff_t>(std::min(names_.size(), LISTED));
  const std::string more = names_.size() > LISTED ? fmt::format(" and {} more", names_.size() - LISTED) : "";
  lines->push_back(fmt::format("{}: {}{}{}", beginning, fmt::join(names_.begin(), last, ", "), more, end));
}

std::string GazeboNotes::shortened(const std::string& words) {
  return words.size() > LONGEST_WORDS ? words.substr(0, LONGEST_WORDS) + "..." : words;
}

std::vector<std::string> GazeboNotes::lines() const {
  std::vector<std::string> lines;
  sensors_.tell("sensors of its <gazebo> blocks", "", &lines);
  drives_.tell("drives of its <gazebo> blocks", "", &lines);
  unknown_.tell("<gazebo>: not read", "; docs/gazebo_urdf.md lists what is", &lines);
  without_effect_.tell("<gazebo>: without effect here", "; docs/gazebo_urdf.md says why", &lines);
  anisotropic_.tell("<mu2> other than <mu1>, which friction of all directions is taken from", "", &lines);
  lines.insert(lines.end(), faults_.begin(), faults_.begin() + static_cast<std::ptrdiff_t>(std::min(faults_.size(), LISTED)));
  if (faults_.size() > LISTED)
    lines.push_back(fmt::format("{}: {} more faults in <gazebo> blocks; correct these first", source_, faults_.size() - LISTED));
  return lines;
}

}  // namespace blem_sim::sim
