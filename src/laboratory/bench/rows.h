// Results of bench as rows: for a table and for `bench --json` (docs/benchmarks.md).
#pragma once

#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "measures/relative_frames.h"

namespace lightgrid::lab {

// Lower bounds of a kernel's memory traffic and arithmetic, for its limit.
struct KernelCost {
  double bytes = 0, flops = 0;
};

// By the label of a launch; empty if the table does not contain it.
std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& work);

struct BenchRow {
  std::string name;  // a kernel's label, "pipeline", "pipeline_device", "plain_read", "upload_lights", …
  std::string kind;  // "limit", "kernel", "pipeline", "transfer", "overhead"
  std::string case_name;
  nlohmann::ordered_json params;
  Spread ms;
  std::optional<KernelCost> cost;
  std::optional<double> limit_ms;               // the cost's time at the machine's limits
  std::optional<double> ratio;                  // median relative to that of the first contestant
  std::optional<RelativeFrames> relative = {};  // of the pipeline: its time relative to the first's
};

// The limits of the whole run, one row each.
std::vector<BenchRow> limit_rows(const Limits& limits);

// The parameters of a contestant and case in its rows.
struct ContestantParams {
  std::string case_name;
  nlohmann::ordered_json params;
  KernelWork work;
};

// The rows of culling, whose frame has a plain read of its depth, or of the rasteriser, which has none.
std::vector<BenchRow> contestant_rows(const ContestantParams& about, const MeasuredRun& run,
                                      const MeasuredFrame& frame, const Limits& limits);

nlohmann::ordered_json to_json(const BenchRow& row, const std::string& device);
std::string table_line(const BenchRow& row);
std::string table_head();
// The slowest kernel in a sentence; empty if no row is a kernel's.
std::string slowest_kernel_text(const std::vector<BenchRow>& rows);

// The regular expression of `bench --filter`.
class RowFilter {
 public:
  // ECMAScript syntax; empty keeps all. Throws Error(input) if it is invalid or too long.
  explicit RowFilter(const std::string& expression);

  // True if it matches anywhere in "CASE/ROW".
  bool keeps(const std::string& case_name, const std::string& row_name) const;

 private:
  bool all_ = true;
  std::regex expression_;
};

}  // namespace lightgrid::lab
