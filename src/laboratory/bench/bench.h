// The benchmark of the culling pipeline and of the rasteriser: limits first, then each case with its
// contestants in turn.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/rows.h"
#include "bench/standard_frames.h"

namespace lightgrid::lab {

struct BenchContestant {
  std::string compared;  // "cull-test=exact", or empty if there is only one contestant
  Settings settings;
};

struct BenchOptions {
  std::vector<BenchCase> cases;
  std::vector<BenchContestant> contestants;  // ratios refer to the first
  std::string filter;                        // a regular expression searched in "CASE/ROW"; empty: all
  bool own_tile = true;                      // use a captured frame's tile size, unless the contestants set
                                             // one
  int frames = 30, warmup = 3;
  std::function<void(const std::vector<BenchRow>&)> found;         // called with a case's rows when it is
                                                                   // done; may be empty
  std::function<void(double done, const std::string& what)> step;  // progress; may be empty
};

struct BenchReport {
  nlohmann::ordered_json machine;
  Limits limits;
  std::string device;
  std::vector<BenchRow> rows;
};

// Writes the frames of the cases that the filter selects, each into a folder of the case's name in `folder`.
void write_frames(const std::filesystem::path& folder, const BenchOptions& options);

// Throws Error(input) if the filter is no regular expression or nothing matches it.
BenchReport run_bench(ClDevice& device, const BenchOptions& options);

nlohmann::ordered_json to_json(const BenchReport& report);

}  // namespace lightgrid::lab
