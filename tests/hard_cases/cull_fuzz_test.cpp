// Culling inputs from random bytes: a fixed sequence of a fixed length, so that every run does the same.
#include <gtest/gtest.h>

#include "hard_cases/fuzz_files.h"
#include "scene/random.h"
#include "support/paths.h"
#include "support/temp_folder.h"

namespace lightgrid::verify {
namespace {

constexpr uint64_t inputs = 80;

std::vector<uint8_t> random_bytes(uint64_t seed) {
  Random random(seed);
  std::vector<uint8_t> bytes(200 + random.next() % 12000);
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

// eye_1e26_m_off: all squares are infinite; one shape dropped a light that the other kept.
// near_plane_at_3e-53_m: halfz-modified cuts where there is no surface.
TEST(CullFuzz, InputsThatOnceFailed) {
  const std::filesystem::path folder = std::filesystem::path(source_folder) / "tests/hard_cases/fuzz_inputs";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_EQ(fuzz_once(engine(), read_fuzz_input(entry.path())), "") << entry.path();
    ++files;
  }
  EXPECT_GE(files, 2);
}

TEST(CullFuzz, AFileHoldsEveryBitOfAnInput) {
  const TempFolder folder;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const auto bytes = random_bytes(seed);
    const FuzzInput in = fuzz_input(Bytes(bytes.data(), bytes.size()));
    write_fuzz_input(folder.path / "a", in);
    write_fuzz_input(folder.path / "b", read_fuzz_input(folder.path / "a"));
    const auto text = [&](const char* name) {
      std::ifstream stream(folder.path / name);
      return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    EXPECT_EQ(text("a"), text("b"));
    EXPECT_EQ(read_fuzz_input(folder.path / "a").lights.size(), in.lights.size());
  }
}

}  // namespace
}  // namespace lightgrid::verify
