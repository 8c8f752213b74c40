#include "bench/measure.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "base/cpu_clock.h"
#include "cl/buffers.h"
#include "cl/transfer.h"

namespace lightgrid::lab {
namespace {

constexpr size_t depth_bytes = size_t(1920) * 1080 * sizeof(float);
constexpr size_t gpu_group = 256;
constexpr int chains = 12, vector_width = 16;  // shape of the arithmetic kernels

double device_ms(ClDevice& device) {
  double ms = 0;
  for (const auto& row : device.profiler().collect()) ms += row.ms;
  return ms;
}

// Twice the cache, at least 256 MiB, at most an eighth of the memory.
size_t large_size(ClDevice& device) {
  const size_t cache = device.device().getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
  const size_t wanted = std::max<size_t>(size_t(256) << 20, 2 * cache);
  const size_t most = std::min(device.info().max_allocation_bytes, device.info().global_bytes / 8);
  return PlainRead::bytes_read(std::min(wanted, most));
}

Spread copy_ms(ClDevice& device, const cl::Buffer& from, size_t bytes, int runs) {
  const cl::Buffer to = device_buffer(device, bytes);
  return repeat(runs, [&] {
    copy_buffer(device, "limits_copy", from, to, bytes);
    return device_ms(device);
  });
}

Spread flops_ms(ClDevice& device, ProgramCache& programs, int runs, double& operations) {
  const bool cpu = device.info().cpu;
  cl::Kernel kernel = programs.kernel(cpu ? "limits/cpu/limits_flops" : "limits/gpu/limits_flops", "");
  const size_t items =
      cpu ? 4 * size_t(device.info().compute_units) : gpu_group * 32 * device.info().compute_units;
  const cl_uint steps = cpu ? 20000 : 4000;
  const cl::Buffer results = device_buffer(device, items * sizeof(float));
  operations = 2.0 * chains * steps * double(items) * (cpu ? vector_width : 1);
  return repeat(runs, [&] {
    launch(device, "limits_flops", kernel, items, cpu ? 1 : gpu_group, 0.999f, 0.001f, steps, results);
    return device_ms(device);
  });
}

double launches_ms(ClDevice& device, cl::Kernel& empty, const cl::Buffer& unused, int count) {
  const Timer timer;
  for (int i = 0; i < count; ++i) launch(device, "limits_empty", empty, 1, 1, unused);
  finish_queue(device, "limits");
  return timer.elapsed_ms();
}

void measure_launches(ClDevice& device, ProgramCache& programs, int runs, Limits& limits) {
  constexpr int many = 33;
  cl::Kernel empty = programs.kernel("limits/limits_empty", "");
  const cl::Buffer unused = device_buffer(device, 64);
  limits.launch_wait = repeat(4 * runs, [&] { return launches_ms(device, empty, unused, 1); });
  const double one = limits.launch_wait.median;
  limits.more_launch = repeat(
      runs, [&] { return std::max(0.0, (launches_ms(device, empty, unused, many) - one) / (many - 1)); });
}

void measure_transfers(ClDevice& device, int runs, Limits& limits) {
  const cl::Buffer buffer = device_buffer(device, depth_bytes);
  std::vector<char> host(depth_bytes, 1);
  limits.to_device =
      time_alone(runs, [&] { write_buffer(device, "limits", buffer, host.data(), depth_bytes); });
  limits.to_host = time_alone(runs, [&] { read_buffer(device, "limits", buffer, host.data(), depth_bytes); });
}

Spread read_ms(ClDevice& device, PlainRead& read, const cl::Buffer& buffer, size_t bytes, int runs) {
  fill_buffer(device, "limits", buffer, 1, bytes);  // pages that were never written are read too fast
  read.fit(buffer, bytes, bytes > depth_bytes ? 2 : 5);
  return repeat(runs, [&] { return read.run(buffer, bytes); });
}

constexpr int transfer_runs = 5;

// The samples of one contestant over all rounds.
struct Samples {
  std::vector<double> wall, cpu, device, overhead;
  std::vector<ClProfiler::Row> first;        // labels and launches
  std::vector<std::vector<double>> kernels;  // by label, in the order of `first`
};

struct HostTime {
  double wall_ms = 0, cpu_ms = 0;
};

HostTime host_time(ClDevice& device, const std::function<void()>& work) {
  device.profiler().time_launches(false);
  const double cpu_before_ms = process_cpu_ms();
  const Timer timer;
  work();
  return {timer.elapsed_ms(), process_cpu_ms() - cpu_before_ms};
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

void take(Samples& samples, const HostTime& host, const DeviceRun& run) {
  if (samples.first.empty()) {
    samples.first = run.rows;
    samples.kernels.resize(run.rows.size());
  }
  double device = 0;
  for (size_t i = 0; i < run.rows.size() && i < samples.kernels.size(); ++i) {
    samples.kernels[i].push_back(run.rows[i].ms);
    device += run.rows[i].ms;
  }
  samples.wall.push_back(host.wall_ms);
  samples.cpu.push_back(host.cpu_ms);
  samples.device.push_back(device);
  samples.overhead.push_back(std::max(0.0, run.wall_ms - device));
}

MeasuredRun result_of(const Samples& samples) {
  MeasuredRun run;
  run.wall = spread_of(samples.wall);
  run.wall_ms = samples.wall;
  run.cpu_ms = samples.cpu;
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

Spread repeat(int runs, const std::function<double()>& run) {
  for (int i = 0; i < 2; ++i) run();
  std::vector<double> samples;
  for (int i = 0; i < runs; ++i) samples.push_back(run());
  return spread_of(samples);
}

Spread time_alone(int runs, const std::function<void()>& work) {
  return repeat(runs, [&] {
    const Timer timer;
    work();
    return timer.elapsed_ms();
  });
}

PlainRead::PlainRead(ClDevice& device, ProgramCache& programs)
    : device_(device),
      kernel_(programs.kernel(device.info().cpu ? "limits/cpu/limits_read" : "limits/gpu/limits_read", "")),
      group_(device.info().cpu ? 1 : gpu_group) {
  items_ = group_ * size_t(device.info().compute_units);
  sums_ = device_buffer(device, 64 * items_ * sizeof(cl_uint));
}

double PlainRead::run(const cl::Buffer& buffer, size_t bytes) {
  const size_t vector_bytes = device_.info().cpu ? 64 : 16;
  launch(device_, "plain_read", kernel_, items_, group_, buffer, cl_uint(bytes_read(bytes) / vector_bytes),
         sums_);
  return device_ms(device_);
}

double PlainRead::fit(const cl::Buffer& buffer, size_t bytes, int tries) {
  device_.profiler().time_launches(true);
  const size_t units = group_ * size_t(device_.info().compute_units);
  double best_ms = std::numeric_limits<double>::infinity();
  size_t best = units;
  // More than one item a unit: otherwise a unit that starts late would delay the whole run by its part.
  for (const size_t times : {4, 8, 16, 32, 64}) {
    items_ = times * units;
    for (int i = 0; i < tries + 1; ++i) {
      const double ms = run(buffer, bytes);
      if (i > 0 && ms < best_ms) {
        best_ms = ms;
        best = items_;
      }
    }
  }
  items_ = best;
  return best_ms;
}

Limits measure_limits(ClDevice& device, ProgramCache& programs, int runs, bool with_large) {
  device.profiler().time_launches(true);
  Limits limits;
  limits.depth_bytes = PlainRead::bytes_read(depth_bytes);
  PlainRead read(device, programs);
  if (with_large) {
    limits.large_bytes = large_size(device);
    const cl::Buffer large = device_buffer(device, limits.large_bytes);
    limits.read_large = read_ms(device, read, large, limits.large_bytes, std::min(runs, 10));
    limits.copy = copy_ms(device, large, limits.large_bytes, std::min(runs, 10));
  }
  limits.read_depth = read_ms(device, read, device_buffer(device, depth_bytes), depth_bytes, runs);
  limits.flops = flops_ms(device, programs, runs, limits.operations);
  device.profiler().time_launches(false);
  measure_launches(device, programs, runs, limits);
  measure_transfers(device, runs, limits);
  return limits;
}

std::vector<MeasuredRun> time_in_turn(ClDevice& device, const std::vector<std::function<void()>>& work,
                                      const Rounds& rounds,
                                      const std::function<void(bool counts)>& end_of_round) {
  std::vector<Samples> samples(work.size());
  std::vector<size_t> order(work.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::mt19937_64 random(1);
  for (int round = -rounds.warmup; round < rounds.timed; ++round) {
    // Rounds are in random order and back, in turn: drifts cancel in ratios.
    if (round % 2 == 0) {
      std::ranges::shuffle(order, random);
    } else {
      std::ranges::reverse(order);
    }
    for (const size_t i : order) {
      // The wall-clock run comes second: its caches are as after a frame of its own.
      const DeviceRun timed = device_run(device, work[i]);
      const HostTime host = host_time(device, work[i]);
      if (round >= 0) take(samples[i], host, timed);
    }
    end_of_round(round >= 0);
    if (rounds.progress) rounds.progress(double(round + rounds.warmup + 1) / (rounds.timed + rounds.warmup));
  }
  device.profiler().time_launches(false);
  std::vector<MeasuredRun> runs;
  for (const Samples& of_one : samples) runs.push_back(result_of(of_one));
  return runs;
}

MeasuredFrame measure_in_turn(ClDevice& device, ProgramCache& programs,
                              const std::vector<std::unique_ptr<CullingRun>>& contestants,
                              const Rounds& rounds) {
  PlainRead read(device, programs);
  const cl::Buffer& depth = contestants.front()->depth();
  const size_t bytes = contestants.front()->depth_bytes();
  const double least = read.fit(depth, bytes);
  std::vector<std::function<void()>> work;
  for (const auto& run : contestants) work.push_back([&run = *run] { run.run(); });
  std::vector<double> reads;
  MeasuredFrame measured;
  measured.runs = time_in_turn(device, work, rounds, [&](bool counts) {
    device.profiler().time_launches(true);
    const double read_ms = read.run(depth, bytes);
    if (counts) reads.push_back(read_ms);
  });
  for (size_t i = 0; i < contestants.size(); ++i) measure_transfers(*contestants[i], measured.runs[i]);
  measured.plain_read = spread_of(reads);
  measured.min_read_ms = std::min(least, measured.plain_read.min);
  return measured;
}

}  // namespace lightgrid::lab
