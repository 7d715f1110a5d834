#include "loop/allocation_limit.h"

namespace blem_sim::node {

namespace {
thread_local std::size_t largest_block = AllocationLimit::NONE;
}

AllocationLimit::AllocationLimit(std::size_t largest) : before_(largest_block) { largest_block = largest; }
AllocationLimit::~AllocationLimit() { largest_block = before_; }
std::size_t AllocationLimit::present() { return largest_block; }

}  // namespace blem_sim::node
