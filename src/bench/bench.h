// The benchmark of the culling pipeline: limits first, then each case with its contestants in turn.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/cases.h"
#include "bench/rows.h"

namespace lightgrid {

struct BenchContestant {
  std::string compared;  // "cull-test=exact", or empty where there is only one
  Settings settings;
};

struct BenchOptions {
  std::vector<BenchCase> cases;
  std::vector<BenchContestant> contestants;  // the first is what ratios refer to
  std::string filter;                        // a regular expression that must be found in "CASE/ROW"; empty: all
  bool own_tile = true;                      // a captured frame's tile size, where the contestants give none
  int frames = 30, warmup = 3;
  std::function<void(const std::vector<BenchRow>&)> found;         // rows, as soon as a case is done; may be empty
  std::function<void(double done, const std::string& what)> step;  // progress; may be empty
};

struct BenchReport {
  nlohmann::ordered_json machine;
  Limits limits;
  std::string device;
  std::vector<BenchRow> rows;
};

// Writes the frames of those cases that the filter names, each into a folder of the case's name below `folder`.
void write_frames(const std::filesystem::path& folder, const BenchOptions& options);

// Throws Error(input) where the filter is no regular expression or nothing matches it.
BenchReport run_bench(ClDevice& device, const BenchOptions& options);

nlohmann::ordered_json to_json(const BenchReport& report);

}  // namespace lightgrid
