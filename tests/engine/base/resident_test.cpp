// How much memory this process may use: files of the kernel, made by hand.
#include "base/resident.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "base/error.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

struct FakeSystem : TempFolder {
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
  }
  FakeSystem() { write("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable: 8000 kB\n"); }
};

TEST(UsableMemory, IsWhatTheMachineHasFree) { EXPECT_EQ(usable_memory(FakeSystem().path), 8000u * 1024); }

TEST(UsableMemory, GroupsOfVersion2LimitItUpToTheRoot) {
  const FakeSystem system;
  system.write("proc/self/cgroup", "0::/a/b\n");
  system.write("sys/fs/cgroup/a/b/memory.max", "max\n");
  EXPECT_EQ(usable_memory(system.path), 8000u * 1024) << "no limit";
  system.write("sys/fs/cgroup/a/memory.max", "4000000\n");
  system.write("sys/fs/cgroup/a/memory.current", "3000000\n");
  system.write("sys/fs/cgroup/a/memory.stat", "anon 1000\ninactive_file 500000\n");
  EXPECT_EQ(usable_memory(system.path), 1500000u) << "caches of files can be dropped";
  system.write("sys/fs/cgroup/a/b/memory.max", "1000\n");
  system.write("sys/fs/cgroup/a/b/memory.current", "5000\n");
  EXPECT_EQ(usable_memory(system.path), 0u) << "already past the limit";
}

TEST(UsableMemory, GroupsOfVersion1LimitItToo) {
  const FakeSystem system;
  system.write("proc/self/cgroup", "12:cpu,cpuacct:/x\n3:memory:/docker/c\n0::/\n");
  system.write("sys/fs/cgroup/memory/docker/c/memory.limit_in_bytes", "2000000\n");
  system.write("sys/fs/cgroup/memory/docker/c/memory.usage_in_bytes", "500000\n");
  system.write("sys/fs/cgroup/memory/docker/c/memory.stat", "inactive_file 1\ntotal_inactive_file 100000\n");
  EXPECT_EQ(usable_memory(system.path), 1600000u);
  // A container sees its own group as the mount.
  system.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "300000\n");
  EXPECT_EQ(usable_memory(system.path), 300000u);
}

TEST(UsableMemory, AddressSpaceLimitsIt) {
  const FakeSystem system;
  system.write("proc/meminfo", "MemAvailable: 9000000000000 kB\n");
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  rlimit limited = before;
  limited.rlim_cur = rlim_t(1) << 40;
  setrlimit(RLIMIT_AS, &limited);
  system.write("proc/self/statm", "0 0 0\n");
  EXPECT_EQ(usable_memory(system.path), uint64_t(1) << 40);
  system.write("proc/self/statm", "268435456 1 1\n");  // pages
  EXPECT_EQ(usable_memory(system.path), 0u);
  setrlimit(RLIMIT_AS, &before);
}

// The system counts memory as free until it is written.
TEST(UsableMemory, PromisedMemoryIsNotUsable) {
  const FakeSystem system;
  EXPECT_EQ(usable_memory(system.path, 1000 * 1024), 7000u * 1024);
  EXPECT_EQ(usable_memory(system.path, 9000 * 1024), 0u);
}

TEST(UsableMemory, TooMuchIsAnErrorOfTheMachine) {
  EXPECT_NO_THROW(require_memory(1, "x", "y"));
  const std::string message =
      error_of([&] { require_memory(uint64_t(1) << 60, "size 9x9", "a smaller --size needs less"); },
               ErrorKind::machine);
  EXPECT_THAT(message, testing::HasSubstr("size 9x9: needs at least 1073741824.0 GiB of memory"));
  EXPECT_THAT(message, testing::HasSubstr("a smaller --size needs less"));
}

}  // namespace
}  // namespace lightgrid
