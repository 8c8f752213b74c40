// Wall-clock time, and statistics of repeated runs.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

namespace lightgrid {

class Timer {
 public:
  double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The median of an even number of samples is the mean of the two middle ones. p90 is one of the samples;
// fewer than a tenth of them are above it.
struct Spread {
  double min = 0, median = 0, p90 = 0, max = 0;
  int runs = 0;
};

inline Spread spread_of(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const size_t n = samples.size();
  const double median = 0.5 * (samples[(n - 1) / 2] + samples[n / 2]);
  return {samples[0], median, samples[n * 9 / 10], samples[n - 1], static_cast<int>(n)};
}

}  // namespace lightgrid
