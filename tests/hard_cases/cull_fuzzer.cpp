// The libFuzzer entry: cmake -DLIGHTGRID_FUZZ=ON under clang; build/tests/cull_fuzzer CORPUS_DIR.
#include <cstdio>
#include <cstdlib>

#include "hard_cases/cull_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace lightgrid::lab::verify;
  static const auto engine = device_engine("");
  const std::string wrong = fuzz_once(*engine, data, size);
  if (!wrong.empty()) {
    std::fprintf(stderr, "%s\n", wrong.c_str());
    std::abort();
  }
  return 0;
}
