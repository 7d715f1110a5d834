// Counts the allocations of a test program. Included by one file of a program, where glibc is without the sanitizers' heap.
#pragma once

#include <malloc.h>

#include <atomic>
#include <cstdlib>

namespace {
std::atomic<long> allocations{0};
std::atomic<long> held_bytes{0};  // of allocations that were not given back, as malloc rounds them up
}  // namespace

// Stand before glibc's own in this program, so that Eigen's allocations are seen like those of new.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void __libc_free(void* memory);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  void* const memory = __libc_malloc(size);
  held_bytes += static_cast<long>(malloc_usable_size(memory));
  return memory;
}
extern "C" void free(void* memory) {
  held_bytes -= static_cast<long>(malloc_usable_size(memory));
  __libc_free(memory);
}
