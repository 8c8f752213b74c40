#include "bench/tune.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/measure.h"
#include "cl/error.h"
#include "plan/settings/kernels.h"

namespace lightgrid::lab {
namespace {

std::vector<std::string> values_of(const std::string& key) {
  for (const SettingRow& help : setting_rows()) {
    if (help.key != key) continue;
    std::vector<std::string> values = help.values;
    std::erase(values, "auto");
    return values;
  }
  return {};
}

// One value of the tuned key.
struct Candidate {
  std::string value;
  Settings settings;
  std::string failure;
  double log_sum = 0;  // sum over the frames, of the medians
};

std::vector<Candidate> candidates_of(const std::string& key, const Settings& best) {
  std::vector<Candidate> candidates;
  for (const std::string& value : values_of(key)) {
    candidates.push_back({value, best, "", 0});
    apply_setting(candidates.back().settings, key + "=" + value);
  }
  return candidates;
}

void run_on(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const TuneOptions& options,
            std::vector<Candidate>& candidates) {
  std::vector<std::unique_ptr<CullingRun>> runs;
  std::vector<Candidate*> running;
  const cl::Buffer depth = upload_depth(device, frame);
  for (Candidate& candidate : candidates) {
    if (!candidate.failure.empty()) continue;
    const auto failure = failure_of([&] {
      runs.push_back(std::make_unique<CullingRun>(device, programs, frame, depth, candidate.settings));
      running.push_back(&candidate);
    });
    if (failure) candidate.failure = failure->what();
  }
  if (runs.empty()) return;
  const MeasuredFrame measured =
      measure_in_turn(device, programs, runs, {options.warmup, options.frames, {}});
  for (size_t i = 0; i < running.size(); ++i) running[i]->log_sum += std::log(measured.runs[i].wall.median);
}

const Candidate* fastest(const std::vector<Candidate>& candidates) {
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates) {
    if (candidate.failure.empty() && (!best || candidate.log_sum < best->log_sum)) best = &candidate;
  }
  return best;
}

}  // namespace

TuneResult tune_kernels(ClDevice& device, const TuneOptions& options) {
  std::vector<CapturedFrame> frames;
  for (const int lights : {256, 4096, 65536}) frames.push_back(make_standard_frame({.lights = lights}));
  ProgramCache programs(device);
  TuneResult result;
  Settings settings;
  for (const std::string& key : tunable_settings()) {
    if (key == "group-size" && settings[setting::kernel_shape] != KernelShape::group)
      continue;  // applies to that shape alone
    std::vector<Candidate> candidates = candidates_of(key, settings);
    for (size_t i = 0; i < frames.size(); ++i) {
      if (options.step) options.step(double(i) / double(frames.size()), key);
      run_on(device, programs, frames[i], options, candidates);
    }
    if (options.step) options.step(1, key);
    const Candidate* best = fastest(candidates);
    if (!best) continue;
    for (const Candidate& c : candidates) {
      const double ratio = std::exp((c.log_sum - best->log_sum) / double(frames.size()));
      result.trials.push_back({fmt::format("{}={}", key, c.value), c.failure.empty() ? ratio : 0, c.failure});
    }
    settings = best->settings;
    result.best[key] = best->value;
  }
  return result;
}

}  // namespace lightgrid::lab
