// Culling inputs from random bytes: a fixed sequence, so that a failure comes back.
#include "hard_cases/cull_fuzz.h"

#include <gtest/gtest.h>

#include "base/timer.h"
#include "scene/random.h"

namespace lightgrid::verify {
namespace {

std::vector<uint8_t> random_bytes(uint64_t seed) {
  Random random(seed);
  std::vector<uint8_t> bytes(200 + random.next() % 12000);
  for (uint8_t& byte : bytes) byte = uint8_t(random.next());
  return bytes;
}

TEST(CullFuzz, RandomInputsGiveWholeGridsThatBothShapesAgreeOn) {
  const auto engine = device_engine("");
  const Timer timer;
  uint64_t seed = 0;
  // Ten seconds, but at least a few inputs of each kind where kernels are still to be built.
  for (; seed < 30 || (seed < 20'000 && timer.elapsed_ms() < 8'000); ++seed) {
    const auto bytes = random_bytes(seed);
    const std::string wrong = fuzz_once(*engine, bytes.data(), bytes.size());
    ASSERT_EQ(wrong, "") << "seed " << seed;
  }
  RecordProperty("inputs", std::to_string(seed));
}

// 871: the eye 1e26 m from its lights, so that all squares are infinite; one shape dropped what the other kept.
// 3657: a near plane at 3e-53 m, so that the cut of halfz-modified is where nothing is.
TEST(CullFuzz, InputsThatOnceFailed) {
  const auto engine = device_engine("");
  for (const uint64_t seed : {871, 3657}) {
    const auto bytes = random_bytes(seed);
    EXPECT_EQ(fuzz_once(*engine, bytes.data(), bytes.size()), "") << "seed " << seed;
  }
}

}  // namespace
}  // namespace lightgrid::verify
