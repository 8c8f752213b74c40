#include "cl/device.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "cl/error.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

ClDeviceInfo device(const char* platform, const char* name, bool cpu) {
  ClDeviceInfo info;
  info.platform = platform;
  info.name = name;
  info.cpu = cpu;
  return info;
}

const std::vector<ClDeviceInfo> three = {device("Portable Computing Language", "pthread-znver3", true),
                                         device("NVIDIA CUDA", "NVIDIA H200", false),
                                         device("NVIDIA CUDA", "NVIDIA H100", false)};

TEST(ClDeviceChoice, IsTheFirstGpuWhenNothingIsNamed) { EXPECT_EQ(choose_cl_device(three, ""), 1u); }

// Whatever the order in which the drivers are listed.
TEST(ClDeviceChoice, PrefersPoclToOtherCpusAndTheseToSimulators) {
  const ClDeviceInfo oclgrind = device("Oclgrind", "Oclgrind Simulator", true),
                     other = device("rusticl", "llvmpipe (LLVM 19)", true), pocl = three[0], gpu = three[1];
  EXPECT_EQ(choose_cl_device({oclgrind, pocl}, ""), 1u);
  EXPECT_EQ(choose_cl_device({oclgrind, other, pocl}, ""), 2u);
  EXPECT_EQ(choose_cl_device({oclgrind, other}, ""), 1u);
  EXPECT_EQ(choose_cl_device({other, oclgrind, pocl, gpu}, ""), 3u);
  EXPECT_EQ(choose_cl_device({oclgrind}, ""), 0u);
  EXPECT_EQ(choose_cl_device({oclgrind, pocl}, "oclgrind"), 0u);
  // A simulator that calls itself a GPU is none.
  ClDeviceInfo simulated = oclgrind;
  simulated.cpu = false;
  EXPECT_EQ(choose_cl_device({simulated, pocl}, ""), 1u);
}

TEST(ClDeviceChoice, TakesTheFirstWhosePlatformAndNameHoldTheSubstringInAnyCase) {
  EXPECT_EQ(choose_cl_device(three, "h100"), 2u);
  EXPECT_EQ(choose_cl_device(three, "nvidia"), 1u);
  EXPECT_EQ(choose_cl_device(three, "language PTHREAD"), 0u);
}

// Devices of the same name, as on a machine with several GPUs of one kind.
TEST(ClDeviceChoice, TakesTheOneAtAnIndexAfterAHash) {
  const std::vector<ClDeviceInfo> equal = {three[0], three[1], three[1]};
  EXPECT_EQ(choose_cl_device(equal, "H200"), 1u);
  EXPECT_EQ(choose_cl_device(equal, "#2"), 2u);
  EXPECT_EQ(choose_cl_device(equal, "#0"), 0u);
  for (const char* none : {"#3", "#", "#-1", "#1x", "#99999999999999999999"}) {
    try {
      choose_cl_device(equal, none);
      ADD_FAILURE() << none << " was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("#2 NVIDIA CUDA NVIDIA H200"));
    }
  }
}

TEST(ClDeviceInfo, SaysWhyItsBytesMayDiffer) {
  EXPECT_EQ(why_not_the_same_bytes({.exact_division = true, .denormals = true}), "");
  EXPECT_EQ(why_not_the_same_bytes({.exact_division = false, .denormals = true}),
            "it does not round division and square root correctly");
  EXPECT_EQ(why_not_the_same_bytes({.exact_division = true, .denormals = false}), "it flushes denormals");
  EXPECT_EQ(why_not_the_same_bytes({}),
            "it does not round division and square root correctly, and flushes denormals");
}

TEST(ClDeviceChoice, ThatMatchesNothingNamesTheSubstringAndTheDevices) {
  const std::string message = error_of([&] { choose_cl_device(three, "radeon"); }, ErrorKind::machine);
  EXPECT_THAT(message, HasSubstr("\"radeon\""));
  EXPECT_THAT(message, HasSubstr("NVIDIA CUDA NVIDIA H100"));
  EXPECT_THAT(message, HasSubstr("pthread-znver3"));
}

TEST(ClDeviceChoice, WithNoDeviceNamesThePackageThatBringsOne) {
  EXPECT_THAT(error_of([&] { choose_cl_device({}, ""); }, ErrorKind::machine), HasSubstr("pocl-opencl-icd"));
}

TEST(ClDevice, IsTheOneThatTheChoiceNames) {
  const std::vector<ClDeviceInfo> devices = list_cl_devices();
  ClDevice made;
  EXPECT_EQ(made.info().name, devices[choose_cl_device(devices, "")].name);
  EXPECT_GE(made.info().compute_units, 1);
  EXPECT_LE(made.info().max_allocation_bytes, made.info().global_bytes);
  EXPECT_NE(made.queue().getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_PROFILING_ENABLE, 0u);
  EXPECT_EQ(made.queue().getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, 0u);
}

TEST(ClDevice, ThatDoesNotExistIsAMachineError) { EXPECT_THROW(ClDevice("no device is called this"), Error); }

TEST(ClDevice, MayBeWhatTheHostProgramHasMade) {
  ClDevice first;
  const cl::Context context(first.device());
  const cl::CommandQueue queue(context, first.device());
  ClDevice own(first.device(), context, queue);
  EXPECT_EQ(own.info().name, first.info().name);
  EXPECT_EQ(own.context()(), context());
  EXPECT_EQ(own.queue()(), queue());
  // Writes a buffer of that context.
  const cl::Buffer buffer(context, CL_MEM_READ_WRITE, 64);
  own.queue().enqueueFillBuffer(buffer, cl_uint(7), 0, 64);
  cl_uint read = 0;
  queue.enqueueReadBuffer(buffer, CL_TRUE, 60, sizeof read, &read);
  EXPECT_EQ(read, 7u);
}

TEST(ClDevice, TakesNoQueueOfAnotherContext) {
  ClDevice first;
  const cl::Context context(first.device());
  EXPECT_THAT(error_of([&] { ClDevice own(first.device(), context, first.queue()); }),
              HasSubstr("context or device differs"));
}

TEST(ClDevice, TakesNoQueueOutOfOrder) {
  ClDevice first;
  cl_int refused = CL_SUCCESS;
  cl_command_queue made = clCreateCommandQueue(first.context()(), first.device()(),
                                               CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, &refused);
  if (refused != CL_SUCCESS) GTEST_SKIP() << first.info().name << " has none: " << cl_error_name(refused);
  const cl::CommandQueue queue(made);  // takes it over
  EXPECT_THAT(error_of([&] { ClDevice own(first.device(), first.context(), queue); }),
              HasSubstr("out of order"));
}

// Only the program's own: drivers add variables.
std::vector<std::string> environment() {
  std::vector<std::string> values;
  for (const char* name : {"POCL_AFFINITY", "POCL_KERNEL_CACHE"}) {
    const char* value = std::getenv(name);
    values.push_back(value ? value : "(not set)");
  }
  return values;
}

// A library may not call setenv: another thread of the host program may be reading the environment.
TEST(ClDevice, LeavesTheEnvironmentOfTheHostProgramAsItIs) {
  setenv("LIGHTGRID_CL_CACHE", "off", 1);
  const std::vector<std::string> before = environment();
  ClDevice made;
  EXPECT_EQ(environment(), before);
  unsetenv("LIGHTGRID_CL_CACHE");
}

TEST(ClErrors, AreNamedWithTheCallAndTheCode) {
  EXPECT_EQ(cl_error_name(CL_INVALID_KERNEL_ARGS), "CL_INVALID_KERNEL_ARGS");
  EXPECT_EQ(cl_error_name(-12345), "code -12345");
  EXPECT_STREQ(cl_machine_error(cl::Error(CL_OUT_OF_RESOURCES, "clFinish"), "cull").what(),
               "cull: clFinish failed with CL_OUT_OF_RESOURCES");
}

}  // namespace
}  // namespace lightgrid
