#include "blem_sim/geometry/large_blocks.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "support/sanitizers.h"

namespace blem_sim::geometry {
namespace {

TEST(LargeBlocks, beginAtAHugePageAndAreGivenBackByFree) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, LARGE_BLOCK - 1, LARGE_BLOCK, LARGE_BLOCK + 12345}) {
    void* const block = blockOfMemory(size);
    ASSERT_NE(block, nullptr);
    if (size >= LARGE_BLOCK) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % HUGE_PAGE, 0u);
    }
    std::memset(block, 1, size);
    std::free(block);
  }
}

TEST(LargeBlocks, thatCannotBeThereAreRefused) {
  if (SANITIZED) GTEST_SKIP() << "the address sanitizer ends programs that ask for so much";
  for (const std::size_t size : {static_cast<std::size_t>(-1), static_cast<std::size_t>(-1) / 2 - 1, static_cast<std::size_t>(1) << 50})
    EXPECT_THROW(blockOfMemory(size), std::bad_alloc) << size;
}

}  // namespace
}  // namespace blem_sim::geometry
