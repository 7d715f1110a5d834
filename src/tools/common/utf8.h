// UTF-8 [RFC 3629].
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace blem_sim {

/** Bytes of the character that begins at a place, 1 to 4; 0 where none does: a stray or overlong byte, a surrogate, a cut end. */
std::size_t utf8Length(const std::string& text, std::size_t at);

/** Precondition: a character's number, no surrogate. */
std::string utf8(std::uint32_t number);

}  // namespace blem_sim
