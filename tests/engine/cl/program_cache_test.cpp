#include "cl/program_cache.h"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "base/compiling.h"
#include "cl/launch.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

const std::string source = "kernel void fill(global int* out) { out[get_global_id(0)] = VALUE; }";

struct ProgramCacheTest : testing::Test {
  ClDevice device;
  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("lightgrid_cache_" + std::to_string(getpid()));

  void SetUp() override {
    std::filesystem::remove_all(folder);
    unsetenv("LIGHTGRID_CL_CACHE");  // continuous integration keeps no binaries
  }
  void TearDown() override {
    std::filesystem::remove_all(folder);
    unsetenv("LIGHTGRID_CL_CACHE");
  }

  int run(ProgramCache& programs, int value) {
    cl::Kernel kernel = programs.kernel_of_source("fill", source, "-DVALUE=" + std::to_string(value));
    cl::Buffer out(device.context(), CL_MEM_READ_WRITE, sizeof(cl_int));
    launch(device, "fill", kernel, cl::NDRange(1), cl::NullRange, out);
    cl_int result = 0;
    device.queue().enqueueReadBuffer(out, CL_TRUE, 0, sizeof result, &result);
    return result;
  }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    if (std::filesystem::exists(folder))
      for (const auto& entry : std::filesystem::directory_iterator(folder)) found.push_back(entry.path());
    return found;
  }

  void expect_counts(const ProgramCache& programs, int built, int from_disk, int from_memory) {
    EXPECT_EQ(programs.counts().built, built);
    EXPECT_EQ(programs.counts().from_disk, from_disk);
    EXPECT_EQ(programs.counts().from_memory, from_memory);
  }
};

TEST_F(ProgramCacheTest, BuildsOnceThenTakesFromMemory) {
  ProgramCache programs(device, folder);
  EXPECT_EQ(run(programs, 7), 7);
  EXPECT_EQ(run(programs, 7), 7);
  expect_counts(programs, 1, 0, 1);
}

TEST_F(ProgramCacheTest, TakesFromDiskWhatAnotherBuilt) {
  ProgramCache first(device, folder), second(device, folder);
  EXPECT_EQ(run(first, 7), 7);
  EXPECT_EQ(run(second, 7), 7);
  expect_counts(second, 0, 1, 0);
}

TEST_F(ProgramCacheTest, ReportsOnlyKernelsThatLaterStartsLoadFromDisk) {
  std::vector<std::pair<int, int>> calls;
  set_first_compilation_function([&](int kernels, int total) { calls.emplace_back(kernels, total); });
  ProgramCache first(device, folder), second(device, folder);
  run(first, 1);
  run(first, 2);
  run(second, 2);
  setenv("LIGHTGRID_CL_CACHE", "driver", 1);
  ProgramCache without(device, folder);
  run(without, 3);
  set_first_compilation_function({});
  ASSERT_THAT(calls, testing::SizeIs(4));
  const auto [first_kernel, first_total] = calls[0];
  EXPECT_GT(first_kernel, 0);
  EXPECT_EQ(first_total, first_kernel);
  EXPECT_THAT(calls,
              testing::ElementsAre(testing::Pair(first_kernel, first_kernel), testing::Pair(0, 0),
                                   testing::Pair(first_kernel + 1, first_kernel + 1), testing::Pair(0, 0)));
}

TEST_F(ProgramCacheTest, CompilesAheadWhatADryRunRequests) {
  const char* const files[] = {"culling/light_z_bins", "culling/straighten_depth", "culling/cap_lists"};
  std::vector<std::pair<int, int>> calls;
  set_first_compilation_function([&](int kernels, int total) { calls.emplace_back(kernels, total); });
  {
    ProgramCache programs(device, folder);
    device.dry_run = true;
    for (const char* file : files) EXPECT_TRUE(programs.request(file, ""));
    EXPECT_TRUE(programs.request(files[0], ""));
    device.dry_run = false;
    EXPECT_FALSE(programs.request(files[0], ""));
    programs.finish_requests();
    EXPECT_EQ(this->files().size(), std::size(files));
    programs.throw_if_missing(true);
    for (const char* file : files) programs.kernel(file, "");
    expect_counts(programs, int(std::size(files)), 0, 0);
    EXPECT_THROW(programs.kernel("culling/tile_masks", ""), KernelMissing);
  }
  set_first_compilation_function({});
  ASSERT_THAT(calls, testing::SizeIs(std::size(files) + 1));
  EXPECT_EQ(calls.back(), std::pair(0, 0));
  const auto [last, total] = calls[std::size(files) - 1];
  EXPECT_EQ(last, total) << "it ends at the total";
}

TEST_F(ProgramCacheTest, KeepsProgramsOfOtherDefinesApart) {
  ProgramCache first(device, folder), second(device, folder);
  EXPECT_EQ(run(first, 1), 1);
  EXPECT_EQ(run(first, 2), 2);
  expect_counts(first, 2, 0, 0);
  EXPECT_EQ(run(second, 2), 2);
  EXPECT_EQ(run(second, 1), 1);
  expect_counts(second, 0, 2, 0);
}

TEST_F(ProgramCacheTest, KeepsProgramsOfOtherSourcesApart) {
  ProgramCache first(device, folder), second(device, folder);
  first.kernel_of_source("fill", source, "-DVALUE=1");
  first.kernel_of_source("fill", source + "\n", "-DVALUE=1");
  expect_counts(first, 2, 0, 0);
  second.kernel_of_source("fill", source + "\n\n", "-DVALUE=1");
  expect_counts(second, 1, 0, 0);
}

void flip_byte(const std::filesystem::path& path, std::streamoff at) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const char byte = static_cast<char>(file.seekg(at).get());
  file.seekp(at).put(static_cast<char>(~byte));
}

TEST_F(ProgramCacheTest, RebuildsAndReplacesADamagedFile) {
  ProgramCache first(device, folder);
  run(first, 7);
  ASSERT_EQ(files().size(), 1u);
  const std::filesystem::path file = files()[0];
  const auto whole = std::filesystem::file_size(file);
  const std::vector<std::function<void()>> damages = {
      [&] { std::filesystem::resize_file(file, 0); },
      [&] { std::filesystem::resize_file(file, 20); },
      [&] { std::filesystem::resize_file(file, whole / 2); },
      [&] { std::filesystem::resize_file(file, whole + 1); },
      [&] { flip_byte(file, whole - 100); },
      [&] { flip_byte(file, 40); },
      [&] { std::ofstream(file) << "not a program at all, but long enough to hold a header of its own"; },
  };
  for (size_t i = 0; i < damages.size(); ++i) {
    SCOPED_TRACE(i);
    damages[i]();
    ProgramCache rebuilding(device, folder), after(device, folder);
    EXPECT_EQ(run(rebuilding, 7), 7);
    expect_counts(rebuilding, 1, 0, 0);
    EXPECT_EQ(run(after, 7), 7);
    expect_counts(after, 0, 1, 0);
  }
}

TEST_F(ProgramCacheTest, TouchesNoDiskWhenSwitchedOff) {
  setenv("LIGHTGRID_CL_CACHE", "off", 1);
  ProgramCache first(device, folder), second(device, folder);
  EXPECT_EQ(run(first, 7), 7);
  EXPECT_EQ(run(second, 7), 7);
  expect_counts(second, 1, 0, 0);
  EXPECT_TRUE(files().empty());
}

TEST_F(ProgramCacheTest, WorksInAFolderThatCannotBeMade) {
  ProgramCache programs(device, "/dev/null/lightgrid");
  EXPECT_EQ(run(programs, 7), 7);
  expect_counts(programs, 1, 0, 0);
}

TEST_F(ProgramCacheTest, MayBeSharedByCachesThatBuildAtOnce) {
  constexpr int programs_each = 6;
  auto build_all = [&] {
    ClDevice own;
    ProgramCache programs(own, folder);
    for (int i = 0; i < programs_each; ++i)
      programs.kernel_of_source("fill", source, "-DVALUE=" + std::to_string(i));
  };
  { std::jthread first(build_all), second(build_all); }
  EXPECT_EQ(files().size(), size_t(programs_each));  // no unfinished file remains either
  ProgramCache after(device, folder);
  for (int i = 0; i < programs_each; ++i) EXPECT_EQ(run(after, i), i);
  expect_counts(after, 0, programs_each, 0);
}

TEST_F(ProgramCacheTest, ShowsTheBuildLogOfAnErrorWithFileDefinesAndDevice) {
  ProgramCache programs(device, folder);
  const std::string message = error_of(
      [&] {
        programs.kernel_of_source("broken", "kernel void broken() { undeclared_thing = 1; }", "-DLANES=16");
      },
      ErrorKind::machine);
  EXPECT_THAT(message, HasSubstr("kernels/broken.cl"));
  EXPECT_THAT(message, HasSubstr("-DLANES=16"));
  EXPECT_THAT(message, HasSubstr("CL_BUILD_PROGRAM_FAILURE"));
  EXPECT_THAT(message, HasSubstr("undeclared_thing"));
  EXPECT_THAT(message, HasSubstr("choose another device with --device"));
  EXPECT_THAT(message, HasSubstr(device.info().name));
  EXPECT_TRUE(files().empty());
}

// PoCL's clang prints "1 warning generated." to the process's own stderr.
TEST_F(ProgramCacheTest, PrintsNothingAboutWarnings) {
  ProgramCache programs(device, folder);
  testing::internal::CaptureStderr();
  programs.kernel_of_source("warned",
                            "int nothing(void) {} kernel void warned(global int* a) { *a = nothing(); }", "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ProgramCacheTest, SaysWhenTheEntryIsNotInTheSource) {
  ProgramCache programs(device, folder);
  try {
    programs.kernel_of_source("other", source, "-DVALUE=1");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("kernels/other.cl"));
    EXPECT_THAT(error.what(), HasSubstr("CL_INVALID_KERNEL_NAME"));
  }
}

TEST(ProgramCacheFolder, FollowsXdgThenHomeAndElseThereIsNone) {
  const char* home = std::getenv("HOME");
  const std::string kept = home ? home : "";
  setenv("XDG_CACHE_HOME", "/x", 1);
  setenv("HOME", "/h", 1);
  EXPECT_EQ(ProgramCache::default_folder(), "/x/lightgrid/cl");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(ProgramCache::default_folder(), "/h/.cache/lightgrid/cl");
  unsetenv("HOME");
  EXPECT_EQ(ProgramCache::default_folder(), "");
  if (home) setenv("HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace lightgrid
