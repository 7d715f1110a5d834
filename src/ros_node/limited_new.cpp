// operator new of the node, which keeps to AllocationLimit.
#include <cstdlib>
#include <new>

#include "loop/allocation_limit.h"

void* operator new(std::size_t size) {
  if (size > blem_sim::node::AllocationLimit::present()) throw std::bad_alloc();
  if (void* block = std::malloc(size == 0 ? 1 : size)) return block;
  throw std::bad_alloc();
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
