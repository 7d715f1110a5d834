// Bytes of files with a few of them changed, added or cut.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

namespace blem_sim {

/** One to three changes; half of them in the first 200 bytes, where headers are. */
inline std::string damaged(std::string bytes, std::mt19937* random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>((*random)()) % n; };
  for (std::size_t change = 1 + below(3); change > 0; --change) {
    const std::size_t at = below(2) == 0 ? below(bytes.size()) : below(std::min<std::size_t>(200, bytes.size()));
    switch (below(4)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.resize(at + 1);
        break;
      default:
        bytes.insert(at, 1, "0123456789-. \n"[below(14)]);
    }
  }
  return bytes;
}

/** One number of a text, or four bytes of another file, replaced by one that is large, negative or none. */
inline std::string withAbsurdNumber(std::string bytes, std::mt19937* random) {
  static const std::string WORDS[] = {"1e39",   "-1e300", "nan", "inf", "-1", "4294967295", "2147483648", "99999999999999999999",
                                      "1e-320", "0"};
  static const std::string BYTES[] = {std::string("\0\0\300\177", 4),     std::string("\0\0\200\377", 4),
                                      std::string("\377\377\177\177", 4), std::string("\377\377\377\377", 4),
                                      std::string("\0\0\0\200", 4),       std::string("\1\0\0\0", 4)};
  const std::size_t place = (*random)() % bytes.size();
  const std::size_t digit = bytes.find_first_of("0123456789", place);
  const bool text = bytes.find('\0') == std::string::npos;
  if (text && digit == std::string::npos) return bytes;
  if (!text) return place + 4 > bytes.size() ? bytes : bytes.replace(place, 4, BYTES[(*random)() % std::size(BYTES)]);
  const std::size_t begin = bytes.find_last_of(" \n/", digit) + 1, end = std::min(bytes.find_first_of(" \r\n/", digit), bytes.size());
  return bytes.replace(begin, end - begin, WORDS[(*random)() % std::size(WORDS)]);
}

}  // namespace blem_sim
