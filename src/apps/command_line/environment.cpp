#include "command_line/environment.h"

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

#include "base/log.h"
#include "cl/cache_folder.h"

namespace lightgrid::app {

namespace {

// PoCL pins worker i to processor i, even if this process may use only others (taskset, a container's
// cpuset).
bool may_use_every_processor() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return false;
  for (long i = 0; i < sysconf(_SC_NPROCESSORS_ONLN); ++i) {
    if (!CPU_ISSET(i, &allowed)) return false;
  }
  return true;
}

}  // namespace

void prepare_environment() {
  if (may_use_every_processor()) setenv("POCL_AFFINITY", "1", 0);
  // Otherwise PoCL compiles each kernel twice: for work-groups of any size, for the binary that ProgramCache
  // stores, and for the size of its first launch. Most kernels for CPUs declare theirs (one_item.h).
  setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
  const char* cache = std::getenv("LIGHTGRID_CL_CACHE");
  if (cache && std::string_view(cache) == "off") setenv("POCL_KERNEL_CACHE", "0", 0);
  // Mesa prints a warning about each device that it cannot use; the program reports what matters itself.
  setenv("EGL_LOG_LEVEL", "fatal", 0);
}

namespace {

constexpr uintmax_t room_bytes = 32 << 20;  // all kernels of a comparison of every technique take 8 MB

bool has_room(const std::filesystem::path& folder) {
  std::error_code unknown;
  const std::filesystem::space_info disk = std::filesystem::space(folder, unknown);
  return unknown || disk.available >= room_bytes;
}

// By a process that waits for the end of a pipe, which this one alone holds open: however this one ends. A
// handler of signals would not do: LLVM puts its own in its place, which two interrupts in a row pass by.
void remove_after_the_end(const std::string& folder) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) return;
  if (fork() != 0) {  // or no process can be made
    close(pipe_ends[0]);
    return;
  }
  setsid();
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  const int nowhere = open("/dev/null", O_RDWR);
  for (int stream = 0; stream <= 2; ++stream) dup2(nowhere, stream);  // whoever reads them need not wait
  close(pipe_ends[1]);
  char none;
  while (read(pipe_ends[0], &none, 1) < 0 && errno == EINTR) continue;
  // Twice: a linker that PoCL started may still write while the first one runs.
  execl("/bin/sh", "sh", "-c", "rm -rf -- \"$0\"; sleep 0.5; exec rm -rf -- \"$0\"", folder.c_str(), nullptr);
  _exit(1);
}

}  // namespace

TemporaryCache::TemporaryCache() {
  const char* named = std::getenv("POCL_CACHE_DIR");
  const std::filesystem::path usual = pocl_cache_folder();
  if (named && *named) return;
  const bool writable = why_not_writable(usual).empty();
  if (writable && has_room(usual)) return;
  std::error_code failure;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(failure);
  if (failure || (writable && !has_room(temporary))) return;
  std::string name = (temporary / "lightgrid_XXXXXX").string();
  if (!mkdtemp(name.data())) return;
  folder_ = name;
  remove_after_the_end(name);
  why_ = fmt::format("{}: {}", usual.string(), writable ? "its disk is full" : "cannot be written");
  setenv("POCL_CACHE_DIR", name.c_str(), 1);
}

TemporaryCache::~TemporaryCache() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

void TemporaryCache::tell() const {
  if (folder_.empty()) return;
  log_info("{}; kernels are compiled in each run (set XDG_CACHE_HOME to a writable folder with room)", why_);
}

}  // namespace lightgrid::app
