// Culling inputs from random bytes: a fixed sequence of a fixed length, so that every run does the same.
#include <gtest/gtest.h>

#include "hard_cases/cull_fuzz.h"
#include "support/long_tests.h"

namespace lightgrid::lab::verify {
namespace {

const uint64_t inputs = long_tests() ? 400 : 48;

std::vector<uint8_t> random_bytes(uint64_t seed) {
  Random random(seed);
  std::vector<uint8_t> bytes(13 + random.next() % 600);
  for (uint8_t& byte : bytes) byte = uint8_t(random.next());
  return bytes;
}

CullEngine& engine() {
  static CullEngine* const made = device_engine("").release();  // never closed, as support/devices.h says
  return *made;
}

TEST(CullFuzz, RandomInputsGiveWholeGridsThatBothShapesAgreeOn) {
  uint64_t refused = 0;
  for (uint64_t seed = 0; seed < inputs; ++seed) {
    const auto bytes = random_bytes(seed);
    bool refused_this = false;
    const std::string wrong = fuzz_once(engine(), bytes.data(), bytes.size(), &refused_this);
    ASSERT_EQ(wrong, "") << "seed " << seed;
    refused += refused_this;
  }
  EXPECT_LT(refused, inputs / 2) << "most inputs are refused before a kernel runs";
}

}  // namespace
}  // namespace lightgrid::lab::verify
