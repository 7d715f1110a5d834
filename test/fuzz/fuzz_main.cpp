// A target for libFuzzer: FUZZ_TARGET is its function, FUZZ_HEADER declares it.
#include <cstddef>
#include <cstdint>

#include FUZZ_HEADER

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blem_sim::FUZZ_TARGET(data, size);
  return 0;
}
