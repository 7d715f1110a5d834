// Memory for a program's operator new: large blocks in huge pages.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace blem_sim::geometry {

/** Blocks of so many bytes and more ask for huge pages. */
constexpr std::size_t LARGE_BLOCK = std::size_t{1} << 25, HUGE_PAGE = std::size_t{1} << 21;

/** A block that std::free gives back. Arrays of millions of triangles are mapped in pages of 2 MB where the system has them: a third of the
 * processor time of a load is else spent on pages of 4 kB, one fault and one entry of the page table each. @throws std::bad_alloc */
inline void* blockOfMemory(std::size_t size) {
  const bool large = size >= LARGE_BLOCK && size < static_cast<std::size_t>(-1) / 2;
  const std::size_t whole = large ? (size + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE : size == 0 ? 1 : size;
  void* const block = large ? std::aligned_alloc(HUGE_PAGE, whole) : std::malloc(whole);
  if (!block) throw std::bad_alloc();
  if (large) madvise(block, whole, MADV_HUGEPAGE);  // advice alone: without it pages are small
  return block;
}

}  // namespace blem_sim::geometry
