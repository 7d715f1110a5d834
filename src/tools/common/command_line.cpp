#include "command_line.h"

#include <cmath>
#include <locale>
#include <sstream>

namespace blem_sim {

double numberOf(const std::string& option, const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value) || value < 0)
    throw InputError(fmt::format("{}: '{}' is not a number of at least 0", option, text));
  return value;
}

std::string textOf(const std::string& option, const std::string& text) {
  if (text.empty()) throw InputError(fmt::format("{}: its value is empty; give one, or leave the option out", option));
  return text;
}

std::pair<std::string, std::string> assignment(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw InputError(fmt::format("{}: '{}' is not NAME=VALUE", option, text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace blem_sim
