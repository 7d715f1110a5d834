// Order, patience and end of the thread that draws.
#include "sending/drawing_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace blem_sim::node {
namespace {

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

TEST(DrawingThread, DoesAllJobsInOrder) {
  DrawingThread thread;
  std::vector<int> done;
  for (int i = 0; i < 40; ++i)
    thread.add([&done, i] {
      if (i % 7 == 0) rest();
      done.push_back(i);
    });
  thread.drain();
  ASSERT_EQ(done.size(), 40u);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(done[i], i);
  thread.drain();  // nothing to wait for
}

TEST(DrawingThread, IsNeverManyJobsBehind) {
  DrawingThread thread;
  std::atomic<int> done{0};
  for (int i = 0; i < 40; ++i) {
    thread.add([&done] {
      rest();
      ++done;
    });
    EXPECT_GE(done, i - 9) << "eight wait, one is at hand";
  }
}

TEST(DrawingThread, EndsWithoutTheJobsThatWait) {
  std::atomic<int> done{0};
  {
    DrawingThread thread;
    for (int i = 0; i < 8; ++i)
      thread.add([&done] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        ++done;
      });
  }
  EXPECT_LE(done, 2);
}

}  // namespace
}  // namespace blem_sim::node
