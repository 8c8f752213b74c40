// The packed range test of bins (kernels/culling/packed_range.h), run as it is on the device.
#include <gmock/gmock.h>

#include <limits>

#include "base/embedded.h"
#include "cl/launch.h"
#include "culling/culled_grid.h"

namespace lightgrid {
namespace {

// OpenCL does not specify which zero max(-0.0f, 0.0f) is: this one returns its first operand, as x86's
// instruction may.
constexpr const char* first_operand_max = "#define max(x, y) ((x) < (y) ? (y) : (x))\n";

constexpr const char* kernel_text = R"(
kernel void lights_that_meet(float near, float far, global uint* out) {
  Cell bin = {near, far, -1.0f, 1.0f, -1.0f, 1.0f};
  ViewSphere s = {0.0f, 0.0f, 5.0f, 1.0f};
  TileRect rect = {0, 7 | 7 << 16};
  const PackedRange asks = packed_range_of_bin(0, 0, &bin);
  out[0] = popcount(mask_bits(meets_bin(tiles_in_region(rect, 0, 0), span_of(s), asks)));
}
)";

// Returns which of 16 lights between 4 and 6 m a bin between two distances keeps.
uint32_t kept(float near, float far, const std::string& before) {
  const std::string source =
      before + "#define LANES 16\n" + with_includes("kernels/culling/packed_range.h") + kernel_text;
  cl::Kernel kernel = test_programs().kernel_of_source("lights_that_meet", source, "-DCULL_TEST=3");
  const cl::Buffer out = buffer_of(std::vector<cl_uint>{99});
  launch(test_device(), "lights_that_meet", kernel, cl::NDRange(1), cl::NDRange(1), near, far, out);
  cl_uint count = 0;
  test_device().queue().enqueueReadBuffer(out, CL_TRUE, 0, sizeof count, &count);
  return count;
}

TEST(BinRanges, KeepLightsWhateverZeroTheBinBeginsAt) {
  for (const char* before : {"", first_operand_max}) {
    EXPECT_EQ(kept(0.0f, 10.0f, before), 16u);
    EXPECT_EQ(kept(-0.0f, 10.0f, before), 16u);
    EXPECT_EQ(kept(-3.0f, 10.0f, before), 16u);
    EXPECT_EQ(kept(7.0f, 10.0f, before), 0u);  // the test does reject lights
    EXPECT_EQ(kept(-0.0f, -0.0f, before), 0u);
    EXPECT_EQ(kept(-2.0f, 3.0f, before), 0u);
  }
}

}  // namespace
}  // namespace lightgrid
