#include "cl/launch.h"

#include <gmock/gmock.h>

#include <numeric>

#include "cl/program_cache.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

struct Launch : testing::Test {
  ClDevice device;
  ProgramCache programs{device, ""};
  cl::Kernel scale = programs.kernel_of_source(
      "scale", "kernel void scale(global int* x, int by, local int* t) { x[get_global_id(0)] *= by; }", "");
  std::vector<cl_int> host = [] {
    std::vector<cl_int> values(17 * 9);
    std::iota(values.begin(), values.end(), 0);
    return values;
  }();
  cl::Buffer buffer{device.context(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, host.size() * 4, host.data()};

  void run(const char* label, cl_int by) {
    launch(device, label, scale, cl::NDRange(host.size()), cl::NDRange(17), buffer, by, cl::Local(64));
  }
};

TEST_F(Launch, SetsTheArgumentsInOrderAndRunsEveryItem) {
  run("scale", 3);
  std::vector<cl_int> result(host.size());
  device.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, result.size() * 4, result.data());
  for (size_t i = 0; i < host.size(); ++i) EXPECT_EQ(result[i], cl_int(3 * i));
}

TEST_F(Launch, IsCountedByLabelAndTimedOnlyWhenAsked) {
  run("a", 1);
  EXPECT_TRUE(device.profiler().collect().empty());
  device.profiler().time_launches(true);
  run("b", 1);
  run("a", 1);
  run("b", 1);
  const auto rows = device.profiler().collect();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].label, "b");
  EXPECT_EQ(rows[0].launches, 2);
  EXPECT_EQ(rows[1].label, "a");
  EXPECT_EQ(rows[1].launches, 1);
  EXPECT_GT(rows[0].ms, 0);
  EXPECT_LT(rows[0].ms, 10000);
  EXPECT_TRUE(device.profiler().collect().empty());
  EXPECT_EQ(device.profiler().count(), 4);
  EXPECT_EQ(device.profiler().count("a"), 2);
  EXPECT_EQ(device.profiler().count("never"), 0);
}

TEST_F(Launch, ThatFailsSaysWhichLabelAndCode) {
  device.profiler().time_launches(true);
  EXPECT_EQ(error_of(
                [&] {
                  launch(device, "scale wrongly", scale, cl::NDRange(16), cl::NDRange(5), buffer, cl_int(1),
                         cl::Local(64));
                },
                ErrorKind::machine),
            "scale wrongly: clEnqueueNDRangeKernel failed with CL_INVALID_WORK_GROUP_SIZE");
  EXPECT_TRUE(device.profiler().collect().empty());
}

// kernels/world_grid/world_scan.cl has the parameters values, count and total.
struct NamedLaunch : Launch {
  std::string refusal(const std::string& defines, const ClArguments& arguments) {
    NamedKernel kernel(programs, "world_grid/world_scan", defines);
    try {
      kernel.launch(device, "scan", cl::NDRange(1), cl::NDRange(1), arguments);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  const cl_uint count = 3;
  const ClArguments whole = {{"values", buffer}, {"count", count}, {"total", buffer}};
};

TEST_F(NamedLaunch, ArgumentsReachTheParametersOfTheirNames) {
  cl::Buffer total(device.context(), CL_MEM_READ_WRITE, 8);
  EXPECT_EQ(refusal("", {{"values", buffer}, {"count", count}, {"total", total}}), "");
  cl_uint sum[2];
  device.queue().enqueueReadBuffer(total, CL_TRUE, 0, sizeof sum, sum);
  EXPECT_EQ(sum[0], 0u + 1 + 2);
}

std::string mismatch(int index, const std::string& parameter, const std::string& argument) {
  return fmt::format("kernels/world_grid/world_scan.cl: its parameter {} is \"{}\", the argument is \"{}\"",
                     index, parameter, argument);
}

TEST_F(NamedLaunch, ARenamedParameterIsNamed) {
  EXPECT_EQ(refusal("-Dtotal=sum_of_all", whole), mismatch(2, "sum_of_all", "total"));
}

TEST_F(NamedLaunch, AMissingAnExcessOrAMisplacedArgumentIsNamed) {
  EXPECT_EQ(refusal("", {{"values", buffer}, {"total", buffer}}), mismatch(1, "count", "total"));
  EXPECT_EQ(refusal("", {{"values", buffer}, {"count", count}}), mismatch(2, "total", ""));
  EXPECT_EQ(refusal("", whole + ClArguments{{"scale", 1.0f}}), mismatch(3, "", "scale"));
  EXPECT_EQ(refusal("", {{"total", buffer}, {"count", count}, {"values", buffer}}),
            mismatch(0, "values", "total"));
}

}  // namespace
}  // namespace lightgrid
