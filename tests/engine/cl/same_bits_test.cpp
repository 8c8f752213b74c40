// "The same bits everywhere" depends on the options that all kernels share: no product and sum fused into one
// rounding, division and square root correctly rounded if the device supports it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cl/launch.h"
#include "cl/program_cache.h"

namespace lightgrid {
namespace {

constexpr int count = 16 * 64;

struct SameBits : testing::Test {
  ClDevice device;
  ProgramCache programs{device, ""};
  std::vector<float> a = std::vector<float>(count), b = a, c = a;

  void SetUp() override {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(1, 2);
    for (int i = 0; i < count; ++i) {
      a[i] = uniform(random);
      b[i] = uniform(random);
      c[i] = -(a[i] * b[i]);  // plain: exactly 0; fused: the product's rounding error
    }
  }

  // out[i] = `expression` of a, b and c, which have the type `type`.
  std::vector<float> evaluate(const std::string& type, int lanes, const std::string& expression) {
    const std::string source =
        "kernel void f(global const T* pa, global const T* pb, global const T* pc, "
        "global T* out) { size_t i = get_global_id(0); T a = pa[i], b = pb[i], c = pc[i]; "
        "out[i] = " +
        expression + "; }";
    cl::Kernel kernel = programs.kernel_of_source("f", source, "-DT=" + type);
    auto buffer = [&](std::vector<float>& values) {
      return cl::Buffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, values.size() * 4,
                        values.data());
    };
    std::vector<float> result(count);
    cl::Buffer out = buffer(result);
    launch(device, "f", kernel, cl::NDRange(count / lanes), cl::NullRange, buffer(a), buffer(b), buffer(c),
           out);
    device.queue().enqueueReadBuffer(out, CL_TRUE, 0, count * sizeof(float), result.data());
    return result;
  }
};

TEST_F(SameBits, TheInputTellsFusedFromPlain) {
  int differ = 0;
  for (int i = 0; i < count; ++i) differ += std::fma(a[i], b[i], c[i]) != a[i] * b[i] + c[i];
  EXPECT_GT(differ, count * 9 / 10);
}

TEST_F(SameBits, AnAskedForFmaIsFused) {
  const std::vector<float> result = evaluate("float", 1, "fma(a, b, c)");
  for (int i = 0; i < count; ++i) ASSERT_EQ(result[i], std::fma(a[i], b[i], c[i])) << i;
}

TEST_F(SameBits, ProductAndSumAreNotFused) {
  for (const auto& [type, lanes] : {std::pair("float", 1), {"float4", 4}, {"float8", 8}, {"float16", 16}}) {
    const std::vector<float> result = evaluate(type, lanes, "a * b + c");
    for (int i = 0; i < count; ++i) ASSERT_EQ(result[i], 0) << type << " item " << i;
  }
}

TEST_F(SameBits, DivisionAndSquareRootAreCorrectlyRounded) {
  if (!(device.device().getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT))
    GTEST_SKIP() << device.info().name << " does not offer it";
  for (const auto& [type, lanes] : {std::pair("float", 1), {"float16", 16}}) {
    const std::vector<float> quotient = evaluate(type, lanes, "a / b");
    const std::vector<float> root = evaluate(type, lanes, "sqrt(a)");
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(quotient[i], a[i] / b[i]) << type << " item " << i;
      ASSERT_EQ(root[i], std::sqrt(a[i])) << type << " item " << i;
    }
  }
}

TEST_F(SameBits, DenormalsAreKept) {
  if (!(device.device().getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_DENORM))
    GTEST_SKIP() << device.info().name << " flushes them";
  for (float& value : a) value *= 1e-20f;
  for (float& value : b) value *= 1e-20f;
  for (const auto& [type, lanes] : {std::pair("float", 1), {"float16", 16}}) {
    const std::vector<float> result = evaluate(type, lanes, "a * b");
    for (int i = 0; i < count; ++i) ASSERT_EQ(result[i], a[i] * b[i]) << type << " item " << i;
    ASSERT_NE(result[0], 0);
  }
}

}  // namespace
}  // namespace lightgrid
