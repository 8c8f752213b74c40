// A machine whose points' true times are known: what the statistics of a sweep are held to.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "frontier/answer_steps.h"
#include "frontier/paired_times.h"
#include "support/long_tests.h"

namespace lightgrid::lab {

inline int trials() { return long_tests() ? 2000 : 400; }

// The deviation of shares of n trials is at most this.
inline double three_deviations(double share, int n) { return 3 * std::sqrt(share * (1 - share) / n); }

struct SimulatedMachine {
  int processes = 1, rounds = 11;  // rounds of each process
  // Standard deviations of logarithms: of one time, of what all times of a round share, of what a point has
  // for a process' whole life.
  double own_noise = 0.0134, round_noise = 0.027, process_noise = 0;
  double drift = 0.1;       // the last round's slowness over the first's, of every point
  double heavy_tails = 0;   // the share of times with five times the noise
  double skew = 0;          // lognormal slowness of one time, the median of it as a share
  double spike_share = 0;   // share of times with interruptions
  double spike = 0;         // a time takes up to this share longer
  double slow_mode = 0;     // the logarithm by which a bimodal point's slow runs are slower
  double slow_share = 0.4;  // share of its runs
};

// The logarithm of one time over the true one, but for what the round and the process share.
inline double own_noise(const SimulatedMachine& m, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  double noise = m.own_noise * normal(random) * (uniform(random) < m.heavy_tails ? 5 : 1);
  if (m.skew > 0) noise += std::log1p(m.skew * std::exp(normal(random)));
  if (m.spike_share > 0 && uniform(random) < m.spike_share) noise += std::log1p(m.spike * uniform(random));
  return noise;
}

// The logarithms of times of points whose true ones are `truths`, over runs of a baseline whose true time is
// 1. The first `bimodal` points have two modes; their truth is the fast one.
inline std::vector<LogTimes> simulated_times(const SimulatedMachine& m, const std::vector<double>& truths,
                                             std::mt19937_64& random, size_t bimodal = 0) {
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<LogTimes> all(truths.size());
  for (int process = 0; process < m.processes; ++process) {
    std::vector<double> of_process;
    for (size_t i = 0; i <= truths.size(); ++i) of_process.push_back(m.process_noise * normal(random));
    for (int round = 0; round < m.rounds; ++round) {
      const double shared = m.round_noise * normal(random) + m.drift * round / m.rounds;
      const auto two_frames = [&] {
        return std::log(0.5 * (std::exp(own_noise(m, random)) + std::exp(own_noise(m, random))));
      };
      const double baseline = shared + of_process.back() + two_frames();
      for (size_t i = 0; i < truths.size(); ++i) {
        const double slow = i < bimodal && uniform(random) < m.slow_share ? m.slow_mode : 0;
        const double time = std::log(truths[i]) + shared + of_process[i] + slow + two_frames();
        all[i][{0, process, round}] = time - baseline;
      }
    }
  }
  return all;
}

// Records of a scene's points and controls in two views, of which each takes 10 and 30 ms as the baseline
// does. In each round they are timed in a new order, a baseline run, two of them, a baseline run, two, ..., and
// then once more.
inline std::vector<FrontierRecord> simulated_records(const SimulatedMachine& m, int points, int controls,
                                                     std::mt19937_64& random) {
  constexpr double true_ms[] = {10, 30};
  std::normal_distribution<double> normal(0, 1);
  std::vector<FrontierRecord> records;
  std::vector<size_t> order;
  for (int i = 0; i < points + controls; ++i) {
    for (int view = 0; view < 2; ++view) {
      FrontierRecord& record = records.emplace_back();
      record.point = {.scene = "hall", .technique = "forward_plus", .label = "point " + std::to_string(i)};
      record.view = view;
      record.frames_per_round = 2;
      if (i < points) {
        record.point.settings["tile"] = std::to_string(i);
      } else {
        record.series = "control " + std::to_string(i - points);
      }
    }
    order.push_back(size_t(i));
  }
  for (int round = 0; round < m.rounds; ++round) {
    for (size_t view = 0; view < 2; ++view) {
      const double shared = m.round_noise * normal(random);
      const auto time = [&] { return true_ms[view] * std::exp(shared + own_noise(m, random)); };
      std::shuffle(order.begin(), order.end(), random);
      for (int pass = 0; pass < 2; ++pass) {
        double beside = time();
        for (size_t i = 0; i < order.size(); ++i) {
          if (i % 2 == 1) beside = time();
          FrontierRecord& record = records[2 * order[i] + view];
          record.frame_ms.push_back(time());
          record.baseline_ms.push_back(beside);
        }
      }
    }
  }
  return records;
}

}  // namespace lightgrid::lab
