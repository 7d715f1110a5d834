// Status bits in words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace blem_sim::node {

/** Names of the bits that are set, in bit order. */
std::vector<std::string> statusNames(std::uint32_t status);

/** Advice of each bit that is set and asks for a change, in bit order. */
std::vector<std::string> statusAdvice(std::uint32_t status);

/** Why a service made fewer steps than it was asked for. @param status of those that were made */
std::string stoppedText(std::uint32_t made, std::uint32_t asked, std::uint32_t status);

}  // namespace blem_sim::node
