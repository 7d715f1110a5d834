// Threads that share the short loops of one solve: loops of a few microseconds, hundreds in a row, one after the other.
#pragma once

#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace blem_sim::dynamics {

/**
 * While a thread works `with` helpers, they stand by and take chunks of its loops. Chance decides which thread takes a chunk, so chunks
 * must not depend on each other, and sums over them are made in the order of chunks. A helper that the scheduler holds back costs nothing:
 * the others take its chunks.
 */
class Team {
 public:
  /** Calls work(); meanwhile up to `helpers` threads of the calling thread's TBB arena take part in its loops. */
  template <typename Work>
  void with(int helpers, const Work& work) {
    if (helpers < 1 || gathered_) return work();
    tbb::task_group group;
    gather(helpers, &group);
    work();
    dismiss(&group);
  }

  bool isGathered() const { return gathered_; }

  /** Calls body(chunk) for chunks 0 to count - 1, in any order and at once; returns when all are done. */
  template <typename Body>
  void forChunks(int count, const Body& body) {
    if (!gathered_ || count < 2) {
      for (int chunk = 0; chunk < count; ++chunk) body(chunk);
      return;
    }
    run(count, &body, [](const void* context, int chunk) { (*static_cast<const Body*>(context))(chunk); });
  }

  /** Calls body(first, last) for pieces of the range from begin to end, each of at most `piece`, as chunks. */
  template <typename Body>
  void forRanges(std::size_t begin, std::size_t end, std::size_t piece, const Body& body) {
    if (begin == end) return;
    forChunks(static_cast<int>((end - begin + piece - 1) / piece), [&](int chunk) {
      const std::size_t first = begin + chunk * piece;
      body(first, std::min(end, first + piece));
    });
  }

 private:
  using Call = void (*)(const void* body, int chunk);
  void gather(int helpers, tbb::task_group* group);
  void dismiss(tbb::task_group* group);
  void run(int count, const void* body, Call call);
  bool takeChunk();
  void help();

  bool gathered_ = false;
  // The loop at hand: written before chunks are offered, and left alone until the last one is done.
  const void* body_ = nullptr;
  Call call_ = nullptr;
  alignas(64) std::atomic<int> left_{0};  // chunks that nobody has taken
  alignas(64) std::atomic<int> done_{0};
  alignas(64) std::atomic<bool> dismissed_{true};
};

}  // namespace blem_sim::dynamics
