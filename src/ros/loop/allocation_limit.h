// A bound on what bytes of strangers can make a thread allocate.
#pragma once

#include <cstddef>
#include <limits>

namespace blem_sim::node {

/**
 * While it lives, operator new of this thread refuses larger blocks by std::bad_alloc (in programs with ros_node/limited_new.cpp): a list
 * in a message may claim a length that it has not, and roscpp makes room before it looks for the entries. The innermost limit holds.
 */
class AllocationLimit {
 public:
  static constexpr std::size_t NONE = std::numeric_limits<std::size_t>::max();

  /** @param largest [bytes] of one block */
  explicit AllocationLimit(std::size_t largest);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;

  /** [bytes] that this thread may allocate at once. */
  static std::size_t present();

 private:
  std::size_t before_;
};

}  // namespace blem_sim::node
