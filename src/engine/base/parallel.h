// A plain parallel for over [0, count), for work on the CPU that is not a kernel: the oracle, metrics,
// loading.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace lightgrid {

// True in the bodies of a parallel_for.
inline thread_local bool in_parallel_for = false;

// Calls body(i) once for each i, on all cores, in unspecified order; within another's body on this thread
// alone. The first exception is rethrown.
template <typename Body>
void parallel_for(int count, const Body& body) {
  const int workers =
      in_parallel_for ? 1 : std::clamp<int>(std::thread::hardware_concurrency(), 1, std::max(count, 1));
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failure_lock;
  auto work = [&] {
    const bool outer = std::exchange(in_parallel_for, true);
    try {
      for (int i = next++; i < count; i = next++) body(i);
    } catch (...) {
      std::lock_guard lock(failure_lock);
      if (!failure) failure = std::current_exception();
      next = count;
    }
    in_parallel_for = outer;
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < workers; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

// The same in runs of up to `run`: body(first, end).
template <typename Body>
void parallel_runs(size_t count, size_t run, const Body& body) {
  parallel_for(int((count + run - 1) / run),
               [&](int i) { body(size_t(i) * run, std::min(count, (size_t(i) + 1) * run)); });
}

}  // namespace lightgrid
