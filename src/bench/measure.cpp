#include "bench/measure.h"

#include <algorithm>

namespace lightgrid {
namespace {

constexpr int transfer_runs = 5;

// The samples of one contestant over all rounds.
struct Samples {
  std::vector<double> wall, device, overhead;
  std::vector<ClProfiler::Row> first;        // labels and launches
  std::vector<std::vector<double>> kernels;  // by label, in the order of `first`
};

double wall_ms(ClDevice& device, const std::function<void()>& work) {
  device.profiler().time_launches(false);
  const Timer timer;
  work();
  return timer.elapsed_ms();
}

// A run whose launches are timed by events, which have a cost: separate from the wall-clock run.
struct DeviceRun {
  std::vector<ClProfiler::Row> rows;
  double wall_ms = 0;
};

DeviceRun device_run(ClDevice& device, const std::function<void()>& work) {
  device.profiler().time_launches(true);
  device.profiler().collect();
  const Timer timer;
  work();
  const double wall = timer.elapsed_ms();
  return {device.profiler().collect(), wall};
}

void take(Samples& samples, double wall, const DeviceRun& run) {
  if (samples.first.empty()) samples.first = run.rows, samples.kernels.resize(run.rows.size());
  double device = 0;
  for (size_t i = 0; i < run.rows.size() && i < samples.kernels.size(); ++i) {
    samples.kernels[i].push_back(run.rows[i].ms);
    device += run.rows[i].ms;
  }
  samples.wall.push_back(wall);
  samples.device.push_back(device);
  samples.overhead.push_back(std::max(0.0, run.wall_ms - device));
}

MeasuredRun result_of(const Samples& samples) {
  MeasuredRun run;
  run.wall = spread_of(samples.wall);
  run.device = spread_of(samples.device);
  run.overhead = spread_of(samples.overhead);
  for (size_t i = 0; i < samples.first.size(); ++i) {
    run.kernels.push_back({samples.first[i].label, samples.first[i].launches, spread_of(samples.kernels[i])});
  }
  return run;
}

void measure_transfers(CullingRun& run, MeasuredRun& result) {
  result.lights_upload = time_alone(transfer_runs, [&] { run.upload_lights(); });
  run.run();
  result.grid_download = time_alone(transfer_runs, [&] { run.download_grid(); });
}

}  // namespace

std::vector<MeasuredRun> time_in_turn(ClDevice& device, const std::vector<std::function<void()>>& work,
                                      const Rounds& rounds,
                                      const std::function<void(bool counts)>& end_of_round) {
  std::vector<Samples> samples(work.size());
  for (int round = -rounds.warmup; round < rounds.timed; ++round) {
    for (size_t i = 0; i < work.size(); ++i) {
      // The wall-clock run comes second: its caches are as after a frame of its own.
      const DeviceRun timed = device_run(device, work[i]);
      const double wall = wall_ms(device, work[i]);
      if (round >= 0) take(samples[i], wall, timed);
    }
    end_of_round(round >= 0);
    if (rounds.progress) rounds.progress(double(round + rounds.warmup + 1) / (rounds.timed + rounds.warmup));
  }
  device.profiler().time_launches(false);
  std::vector<MeasuredRun> runs;
  for (const Samples& of_one : samples) runs.push_back(result_of(of_one));
  return runs;
}

MeasuredFrame measure_in_turn(ClDevice& device, const std::vector<CullingRun*>& contestants, PlainRead& read,
                              const Rounds& rounds) {
  const cl::Buffer& depth = contestants.front()->depth();
  const size_t bytes = contestants.front()->depth_bytes();
  const double least = read.fit(depth, bytes);
  std::vector<std::function<void()>> work;
  for (CullingRun* run : contestants) work.push_back([run] { run->run(); });
  std::vector<double> reads;
  MeasuredFrame measured;
  measured.runs = time_in_turn(device, work, rounds, [&](bool counts) {
    device.profiler().time_launches(true);
    const double read_ms = read.run(depth, bytes);
    if (counts) reads.push_back(read_ms);
  });
  for (size_t i = 0; i < contestants.size(); ++i) measure_transfers(*contestants[i], measured.runs[i]);
  measured.plain_read = spread_of(reads);
  measured.least_read_ms = std::min(least, measured.plain_read.min);
  return measured;
}

}  // namespace lightgrid
