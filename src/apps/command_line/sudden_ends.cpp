#include "command_line/sudden_ends.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>

#include <fmt/format.h>

#include "base/error.h"

namespace lightgrid::app {

namespace {

constexpr uint64_t full_below_bytes = 4 << 20;  // the files of one kernel take less
constexpr size_t spare_bytes = 64 << 20;        // no crash is for lack of memory while these can be had
// SIGABRT: of the C library's own abort(), as where a driver without memory frees twice (OSMesa).
constexpr int faults[] = {SIGSEGV, SIGBUS, SIGABRT};

// The handlers read this. They call only what a signal handler may.
struct Ends {
  std::string cache, full_line;
  struct sigaction before[NSIG] = {};
  std::terminate_handler terminate = nullptr;
  volatile sig_atomic_t main_runs = 0;
};

Ends& ends() {
  static Ends* const shared = new Ends;  // outlives every handler
  return *shared;
}

bool cache_is_full() {
  struct statvfs disk;
  if (statvfs(ends().cache.c_str(), &disk) != 0) return false;
  return uint64_t(disk.f_bavail) * disk.f_frsize < full_below_bytes ||
         (disk.f_files > 0 && disk.f_favail == 0);
}

bool memory_is_short() {
  void* const spare =
      mmap(nullptr, spare_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (spare == MAP_FAILED) return true;
  munmap(spare, spare_bytes);
  return false;
}

// The line to say if the disk or memory is short, else nothing.
std::string_view lacking() {
  return cache_is_full() ? ends().full_line : memory_is_short() ? out_of_memory_line : std::string_view();
}

[[noreturn]] void end_with(std::string_view line) {
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
  _exit(int(ErrorKind::machine));
}

void at_exit() {
  if (!ends().main_runs) return;
  const std::string_view why = lacking();
  end_with(why.empty() ? "lightgrid: a driver of OpenCL or OpenGL ended the program\n" : why);
}

void on_terminate() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end_with(out_of_memory_line);
  } catch (...) {
  }
  ends().terminate();
}

void on_fault(int signal) {
  if (const std::string_view why = lacking(); ends().main_runs && !why.empty()) end_with(why);
  sigaction(signal, &ends().before[signal], nullptr);  // the instruction is then repeated
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigaction(signal, nullptr, &ends().before[signal]);
  if (ends().before[signal].sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
}

std::filesystem::path nearest_existing(std::filesystem::path folder) {
  std::error_code unreadable;
  while (folder.has_relative_path() && !std::filesystem::exists(folder, unreadable))
    folder = folder.parent_path();
  return folder;
}

}  // namespace
}  // namespace lightgrid::app

// Takes the place of the C library's, for drivers too. A handler of SIGABRT would not do: LLVM puts its own
// in its place, after which abort() calls no other.
extern "C" void abort() {
  using namespace lightgrid;
  using namespace lightgrid::app;
  if (const std::string_view why = lacking(); ends().main_runs && !why.empty()) end_with(why);
  raise(SIGABRT);
  signal(SIGABRT, SIG_DFL);
  raise(SIGABRT);
  _exit(128 + SIGABRT);
}

namespace lightgrid::app {

SuddenEnds::SuddenEnds(const std::filesystem::path& cache) {
  Ends& s = ends();
  s.cache = nearest_existing(cache);
  s.full_line = fmt::format(
      "lightgrid: {}: no room for compiled kernels: free some on its disk, or set POCL_CACHE_DIR to a folder "
      "on "
      "another one\n",
      cache.string());
  s.terminate = std::set_terminate(on_terminate);
  for (const int signal : faults) handle(signal, on_fault);
  s.main_runs = 1;
  std::atexit(at_exit);
}

SuddenEnds::~SuddenEnds() { ends().main_runs = 0; }

}  // namespace lightgrid::app
