// operator new of the node, which keeps to AllocationLimit, with huge pages for large blocks.
#include "blem_sim/geometry/large_blocks.h"
#include "loop/allocation_limit.h"

void* operator new(std::size_t size) {
  if (size > blem_sim::node::AllocationLimit::present()) throw std::bad_alloc();
  return blem_sim::geometry::blockOfMemory(size);
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
