// operator new of the programs without ROS, with huge pages for large blocks.
#include "blem_sim/geometry/large_blocks.h"

void* operator new(std::size_t size) { return blem_sim::geometry::blockOfMemory(size); }

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
