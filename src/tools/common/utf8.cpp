#include "utf8.h"

namespace blem_sim {

namespace {

const std::size_t LONGEST = 4;  ///< [bytes] of a character

unsigned char byteAt(const std::string& text, std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0; }

}  // namespace

std::size_t utf8Length(const std::string& text, std::size_t at) {
  const unsigned char first = byteAt(text, at), second = byteAt(text, at + 1);
  if (at >= text.size()) return 0;
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? LONGEST : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byteAt(text, at + i) & 0xc0) != 0x80) return 0;
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool surrogate = first == 0xed && second >= 0xa0, beyond = first == 0xf4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

std::string utf8(std::uint32_t number) {
  const auto last = [&](int shift) { return static_cast<char>(0x80 | ((number >> shift) & 0x3f)); };
  if (number < 0x80) return {static_cast<char>(number)};
  if (number < 0x800) return {static_cast<char>(0xc0 | number >> 6), last(0)};
  if (number < 0x10000) return {static_cast<char>(0xe0 | number >> 12), last(6), last(0)};
  return {static_cast<char>(0xf0 | number >> 18), last(12), last(6), last(0)};
}

}  // namespace blem_sim
