// The kernels that measure limits do the counted work: each value is read once, each operation done.
#include <gtest/gtest.h>

#include <numeric>

#include "cl/launch.h"
#include "cl/program_cache.h"

namespace lightgrid::lab {
namespace {

ClDevice& device() {
  static ClDevice device;
  return device;
}

template <typename T>
std::vector<T> read_back(const cl::Buffer& buffer, size_t count) {
  std::vector<T> values(count);
  device().queue().enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
  return values;
}

// The sum of all sums, of values 1, 2, 3, … in 32 bits, which wrap equally in any order.
uint32_t sum_of_plain_read(const std::string& name, size_t values, cl_uint vectors, size_t items,
                           size_t group) {
  std::vector<uint32_t> host(values);
  std::iota(host.begin(), host.end(), 1u);
  ProgramCache programs(device());
  cl::Kernel kernel = programs.kernel(name, "");
  const cl::Buffer buffer(device().context(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, values * 4,
                          host.data());
  const cl::Buffer sums(device().context(), CL_MEM_READ_WRITE, items * 4);
  launch(device(), name, kernel, items, group, buffer, vectors, sums);
  const auto parts = read_back<uint32_t>(sums, items);
  return std::accumulate(parts.begin(), parts.end(), 0u);
}

TEST(PlainRead, ReadsEachValueOnce) {
  for (const uint32_t blocks : {1u, 3u, 64u, 131u}) {
    const uint32_t values = blocks * 128, sum = uint32_t(uint64_t(values) * (values + 1) / 2);
    for (const size_t items : {1u, 2u, 7u, 200u}) {
      EXPECT_EQ(sum_of_plain_read("limits/cpu/limits_read", values, values / 16, items, 1), sum)
          << values << " by " << items;
    }
    for (const size_t groups : {1u, 3u}) {
      EXPECT_EQ(sum_of_plain_read("limits/gpu/limits_read", values, values / 4, 64 * groups, 64), sum)
          << values;
    }
  }
}

// One chain of the arithmetic kernels, as C++ computes it.
float chain(float factor, float term, unsigned steps, int index, float item) {
  float x = factor * float(index) + item;
  for (unsigned s = 0; s < steps; ++s) x = x * factor + term;
  return x;
}

TEST(Arithmetic, RunsAllOfItsChains) {
  constexpr float factor = 0.75f, term = 0.5f;
  constexpr unsigned steps = 9;
  ProgramCache programs(device());
  const cl::Buffer results(device().context(), CL_MEM_READ_WRITE, 4 * 4);
  for (const bool lanes : {true, false}) {
    cl::Kernel kernel = programs.kernel(lanes ? "limits/cpu/limits_flops" : "limits/gpu/limits_flops", "");
    launch(device(), "flops", kernel, 4, 1, factor, term, cl_uint(steps), results);
    const auto found = read_back<float>(results, 4);
    for (int item = 0; item < 4; ++item) {
      float sum = 0;
      for (int i = 0; i < 12; ++i) sum += chain(factor, term, steps, i, float(item));
      EXPECT_EQ(found[item], lanes ? sum + sum + sum : sum)
          << item;  // lanes: three of 16 equal lanes are added
    }
  }
}

}  // namespace
}  // namespace lightgrid::lab
