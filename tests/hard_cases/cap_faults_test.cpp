// The hard cases of capped lists distinguish right from wrong: each fault, planted into the text of the
// kernel, is found by the cases that are meant for it.
#include <gtest/gtest.h>

#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

struct CapFault {
  const char *name, *right, *wrong;  // a part of the kernel, and what stands there instead
  std::vector<const char*> by;
};

std::vector<CapFault> cap_faults() {
  return {
      {"one_too_few", "cells[cell].y = cap;", "cells[cell].y = cap - 1;", {"around_the_cap", "lights_alike"}},
      {"full_list_is_cut",
       "cells[cell].y <= cap) return;",
       "cells[cell].y < cap) return;\n  --cap;",
       {"around_the_cap"}},
      {"last_of_equal_keys",
       "for (uint i = 0; i < count; ++i) {\n    const index_t light",
       "for (uint i = count; i-- > 0;) {\n    const index_t light",
       {"lights_alike", "triples_at_the_cap"}},
      {"all_of_equal_keys", "|| (key == last && ties == 0)", "", {"triples_at_the_cap"}},
      {"no_ties", "|| (key == last && ties == 0)", "|| key == last", {"triples_at_the_cap"}},
      {"low_bits_ignored", "shift >= 0; shift -= 4", "shift >= 8; shift -= 4", {"cut_and_turned_views"}},
      {"counts_all_digits", "if ((key & known) == last)", "if (true)", {"of_every_brightness"}},
      {"nearest_to_the_eye",
       "const float d = fmax(fmin(distance, m.far), m.near)",
       "const float d = m.near",
       {"cut_and_turned_views"}},
      {"orthographic_slopes", "m.orthographic ? 1.0f : d;", "d;", {"cut_and_turned_views"}},
      {"distance_alone", "MOST_DISTANCE2) * light.w)", "MOST_DISTANCE2))", {"of_every_brightness"}},
      {"another_tile",
       "slot_of_tile(tx % BIN_TILES, ty % BIN_TILES)",
       "slot_of_tile(0, 0)",
       {"cut_and_turned_views"}},
  };
}

struct FaultyCaps : testing::TestWithParam<CapFault> {};

TEST_P(FaultyCaps, Fail) {
  const CapFault& fault = GetParam();
  int planted = 0;
  const auto engine = device_engine("", [&](std::string text) {
    const size_t kernel = text.find("kernel void cap_lists"), at = text.find(fault.right);
    if (kernel == std::string::npos || at == std::string::npos) return text;
    ++planted;
    return text.replace(at, std::string(fault.right).size(), fault.wrong);
  });
  for (const std::string name : fault.by) {
    const auto chosen = chosen_cases("^caps/" + name + "$");
    ASSERT_EQ(chosen.size(), 1u) << name;
    EXPECT_TRUE(fails(*chosen[0], *engine, 0)) << name;
  }
  EXPECT_GT(planted, 0) << "the kernel has no such text";
}

INSTANTIATE_TEST_SUITE_P(Verify, FaultyCaps, testing::ValuesIn(cap_faults()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lightgrid::lab::verify
