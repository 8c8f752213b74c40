#include "bench/rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace lightgrid {
namespace {

constexpr size_t max_length = 200;

// libstdc++'s default matcher takes exponential time on some expressions; its other one does not, and only
// lacks back-references.
constexpr auto syntax = std::regex::ECMAScript
#ifdef __GLIBCXX__
                        | std::regex_constants::__polynomial
#endif
    ;

BenchRow limit_row(const char* name, const char* kind, const Spread& ms, double bytes, double flops = 0) {
  BenchRow row{name, kind, "limits", nlohmann::ordered_json::object(), ms, {}, {}, {}};
  row.cost = KernelCost{bytes, flops};
  if (bytes + flops > 0 && std::string(kind) == "limit") row.limit_ms = ms.min;
  return row;
}

// The least time for a cost: memory at a rate of reading, arithmetic at its limit, together.
double least_ms(const KernelCost& cost, double read_gb_s, const Limits& limits) {
  return std::max(1e-6 * cost.bytes / read_gb_s, 1e-6 * cost.flops / limits.gflop_s());
}

}  // namespace

std::vector<BenchRow> limit_rows(const Limits& l) {
  const double large = double(l.large_bytes), depth = double(l.depth_bytes);
  return {limit_row("read_large", "limit", l.read_large, large),
          limit_row("read_depth_sized", "limit", l.read_depth, depth),
          limit_row("copy", "limit", l.copy, 2 * large),
          limit_row("arithmetic", "limit", l.flops, 0, l.operations),
          limit_row("launch_and_wait", "overhead", l.launch_wait, 0),
          limit_row("further_launch", "overhead", l.more_launch, 0),
          limit_row("to_device", "transfer", l.to_device, depth),
          limit_row("to_host", "transfer", l.to_host, depth)};
}

std::vector<BenchRow> contestant_rows(const ContestantParams& about, const MeasuredRun& run,
                                      const MeasuredFrame& frame, const Limits& limits) {
  const double depth_bytes = double(PlainRead::bytes_read(4 * about.work.pixels));
  const bool culls = frame.plain_read.runs > 0;
  const double read_gb_s =
      culls && depth_bytes > 0 ? 1e-6 * depth_bytes / frame.least_read_ms : limits.read_depth_gb_s();
  const auto row = [&](const std::string& name, const char* kind, const Spread& ms,
                       std::optional<KernelCost> cost) {
    BenchRow r{name, kind, about.case_name, about.params, ms, cost, {}, {}};
    if (cost) r.limit_ms = least_ms(*cost, read_gb_s, limits);
    return r;
  };
  std::vector<BenchRow> rows;
  KernelCost all;
  bool all_known = true;
  for (const MeasuredRun::Kernel& kernel : run.kernels) {
    const auto cost = kernel_cost(kernel.label, about.work);
    rows.push_back(row(kernel.label, "kernel", kernel.ms, cost));
    rows.back().params["launches"] = kernel.launches;
    all_known &= cost.has_value();
    if (cost) all.bytes += cost->bytes, all.flops += cost->flops;
  }
  const std::optional<KernelCost> sum = all_known ? std::optional(all) : std::nullopt;
  if (culls) {
    rows.push_back(row("plain_read", "limit", frame.plain_read, KernelCost{depth_bytes, 0}));
    rows.push_back(row("lights_upload", "transfer", run.lights_upload, {}));
    rows.push_back(row("grid_download", "transfer", run.grid_download, {}));
  }
  rows.push_back(row("launch_overhead", "overhead", run.overhead, {}));
  rows.push_back(row("pipeline_device", "pipeline", run.device, sum));
  rows.push_back(row("pipeline", "pipeline", run.wall, sum));
  return rows;
}

nlohmann::ordered_json to_json(const BenchRow& row, const std::string& device) {
  nlohmann::ordered_json params = {{"case", row.case_name}, {"kind", row.kind}};
  params.update(row.params);
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json json = {{"name", row.name},
                                 {"device", device},
                                 {"params", params},
                                 {"runs", row.ms.runs},
                                 {"min_ms", row.ms.min},
                                 {"median_ms", row.ms.median},
                                 {"p90_ms", row.ms.p90},
                                 {"bytes", row.cost ? nlohmann::ordered_json(row.cost->bytes) : nullptr},
                                 {"flops", row.cost ? nlohmann::ordered_json(row.cost->flops) : nullptr},
                                 {"limit_ms", number(row.limit_ms)},
                                 {"share_of_limit", nullptr}};
  if (row.limit_ms && row.ms.min > 0) json["share_of_limit"] = *row.limit_ms / row.ms.min;
  if (row.ratio) json["ratio_to_first"] = *row.ratio;
  return json;
}

std::string table_head() {
  return fmt::format("{:<18}{:<20}{:>9}{:>9}{:>9}{:>9}{:>7}  {}\n", "case", "", "min ms", "median", "p90",
                     "limit", "share", "");
}

std::string table_line(const BenchRow& row) {
  std::string line = fmt::format("{:<18}{:<20}{:>9.4f}{:>9.4f}{:>9.4f}", row.case_name, row.name, row.ms.min,
                                 row.ms.median, row.ms.p90);
  if (row.limit_ms && row.ms.min > 0) {
    line += fmt::format("{:>9.4f}{:>6.0f}%", *row.limit_ms, 100 * *row.limit_ms / row.ms.min);
  } else {
    line += fmt::format("{:>16}", "");
  }
  if (row.params.contains("compared")) line += fmt::format("  {}", row.params["compared"].get<std::string>());
  if (row.ratio) line += fmt::format("  x {:.2f}", *row.ratio);
  return line + "\n";
}

RowFilter::RowFilter(const std::string& expression) : all_(expression.empty()) {
  if (expression.size() > max_length) throw input_error("filter: longer than {} characters", max_length);
  try {
    expression_ = std::regex(expression, syntax);
  } catch (const std::regex_error& error) {
    throw input_error("filter {}: not a regular expression: {}", expression, error.what());
  }
}

bool RowFilter::keeps(const std::string& case_name, const std::string& row_name) const {
  return all_ || std::regex_search(case_name + "/" + row_name, expression_);
}

}  // namespace lightgrid
