// A plain parallel for over [0, count), for work on the CPU that is not a kernel: the oracle, metrics,
// loading.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lightgrid {

// Calls body(i) once for each i, on all cores, in unspecified order. The first exception is rethrown.
template <typename Body>
void parallel_for(int count, const Body& body) {
  const int workers = std::clamp<int>(std::thread::hardware_concurrency(), 1, std::max(count, 1));
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failure_lock;
  auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) body(i);
    } catch (...) {
      std::lock_guard lock(failure_lock);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < workers; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lightgrid
