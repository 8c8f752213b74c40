// A machine whose points' true times are known: what the statistics of a sweep are held to.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "frontier/paired_times.h"

namespace lightgrid {

struct SimulatedMachine {
  int processes = 1, rounds = 11;  // rounds of each process
  // Standard deviations of logarithms: of one time, of what all times of a round share, of what a point has
  // for a process' whole life.
  double own_noise = 0.0134, round_noise = 0.027, process_noise = 0;
  double drift = 0.1;       // the last round's slowness over the first's, of every point
  double heavy_tails = 0;   // the share of times with five times the noise
  double slow_mode = 0;     // the logarithm by which a bimodal point's slow runs are slower
  double slow_share = 0.4;  // of its runs
};

// The logarithms of times of points whose true ones are `truths`, over the median of `baselines` runs of a
// baseline whose true time is 1. The first `bimodal` points have two modes; their truth is the fast one.
inline std::vector<LogTimes> simulated_times(const SimulatedMachine& m, const std::vector<double>& truths,
                                             std::mt19937_64& random, size_t bimodal = 0,
                                             int baselines = 21) {
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto noise = [&] { return m.own_noise * normal(random) * (uniform(random) < m.heavy_tails ? 5 : 1); };
  std::vector<LogTimes> all(truths.size());
  for (int process = 0; process < m.processes; ++process) {
    std::vector<double> of_process;
    for (size_t i = 0; i <= truths.size(); ++i) of_process.push_back(m.process_noise * normal(random));
    for (int round = 0; round < m.rounds; ++round) {
      const double shared = m.round_noise * normal(random) + m.drift * round / m.rounds;
      std::vector<double> baseline;
      for (int i = 0; i < baselines; ++i) baseline.push_back(shared + of_process.back() + noise());
      std::nth_element(baseline.begin(), baseline.begin() + baselines / 2, baseline.end());
      for (size_t i = 0; i < truths.size(); ++i) {
        const double slow = i < bimodal && uniform(random) < m.slow_share ? m.slow_mode : 0;
        all[i][{0, process, round}] =
            std::log(truths[i]) + shared + of_process[i] + slow + noise() - baseline[size_t(baselines) / 2];
      }
    }
  }
  return all;
}

}  // namespace lightgrid
