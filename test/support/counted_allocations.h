// Counts what a test program asks the heap for. Included by one file of a program, where glibc is without the sanitizers' heap.
#pragma once

#include <atomic>
#include <cstdlib>

namespace {
std::atomic<long> allocations{0};
}

// Stands before glibc's own in this program, so that Eigen's allocations are seen like those of new.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
