#include "bench/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "shared/raster_params.h"

namespace lightgrid::lab {
namespace {

constexpr double interval_bytes = 8, cell_bytes = 8, count_bytes = 4, id_bytes = 4;
constexpr double place_bytes = 16, z_bin_word_bytes = 4;
constexpr double bin_tiles = 64;

// Bytes of a light: position and radius, and with cones an axis and a cosine; in view space also its tile
// rectangle and index.
double world_bytes(const KernelWork& w) { return 4.0 * (w.cones ? 8 : 4); }
double view_bytes(const KernelWork& w) { return 4.0 * (w.cones ? 11 : 7); }

// Operations of kernels/culling/project.h and light_cell_tests.h, counted in their text: to view space with
// two pairs of tangents; sphere against box; additionally three Newton steps; additionally cone against
// sphere.
constexpr double project_flops = 100, box_flops = 18, exact_flops = 110, cone_flops = 60;
// view_sphere there takes these, with a range of distances from it.
constexpr double range_flops = 28;
double test_flops(const KernelWork& w) {
  return box_flops + (w.exact ? exact_flops : 0) + (w.cones ? cone_flops : 0);
}

// A bin has at least as many candidates as its longest list, and therefore at least its indices / 64.
double min_candidates(const KernelWork& w) { return double(w.indices) / bin_tiles; }

// The rasteriser: a position, a vertex in clip space, a triangle's corners, the pixels of its box, a pixel of
// the image. An instance's clusters are at least its triangles / 64.
constexpr double position_bytes = 12, clip_bytes = 16, corner_bytes = 12, box_bytes = 8,
                 visible_pixel_bytes = 8;
constexpr double transform_flops = 24;  // twelve multiply-adds
double min_clusters(const KernelWork& w) { return double(w.triangles) / RASTER_CLUSTER; }

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

// Lower bounds for any kernel with these inputs and outputs: each is read and written once, as if repeated
// accesses hit caches, with one test for each final list entry.
std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& w) {
  const std::map<std::string, KernelCost> costs = {
      {"depth_bounds", {4.0 * w.pixels + interval_bytes * w.tiles, 8.0 * w.tiles}},
      {"project_lights", {(world_bytes(w) + view_bytes(w)) * w.lights, project_flops * w.lights}},
      // These two are bounds of the CPU's form.
      {"cull_lights",
       {interval_bytes * w.tiles + view_bytes(w) * min_candidates(w) + count_bytes * w.cells + w.index_bytes,
        test_flops(w) * w.indices}},
      {"write_lists", {2.0 * w.index_bytes + (count_bytes + cell_bytes) * w.cells, 0}},
      // Launched only if the settings need their result.
      {"light_z_bins",
       {(place_bytes + z_bin_word_bytes) * w.lights + interval_bytes * w.z_bins, range_flops * w.lights}},
      {"lists_to_masks", {cell_bytes * w.cells + w.index_bytes + w.mask_bytes, 0}},
      // The rasteriser's on CPUs; GPUs launch the first two and the last two of them.
      {"raster_transform", {(position_bytes + clip_bytes) * w.vertices, transform_flops * w.vertices}},
      {"raster_clusters", {sizeof(RasterCluster) * min_clusters(w), 0}},
      {"raster_order", {min_clusters(w) + id_bytes * w.clusters, 0}},
      {"raster_setup", {(corner_bytes + sizeof(RasterRecord)) * w.records, 0}},
      {"raster_scan", {2.0 * count_bytes * w.tiles, 0}},
      {"raster_fill", {box_bytes * w.records + id_bytes * w.tile_entries, 0}},
      {"raster_tiles",
       {id_bytes * w.tile_entries + sizeof(RasterRecord) * w.records + visible_pixel_bytes * w.pixels, 0}},
      {"raster_clear", {visible_pixel_bytes * w.pixels, 0}},
      {"raster_keys", {2.0 * visible_pixel_bytes * w.pixels, 0}},
  };
  const auto found = costs.find(label);
  return found == costs.end() ? std::nullopt : std::optional(found->second);
}

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
      culls && depth_bytes > 0 ? 1e-6 * depth_bytes / frame.min_read_ms : limits.read_depth_gb_s();
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
    if (cost) {
      all.bytes += cost->bytes;
      all.flops += cost->flops;
    }
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
  if (row.relative) {
    json["relative_time"] = to_json(*row.relative);
    json["clock"] = row.relative->by_cpu ? "cpu" : "wall";
  }
  return json;
}

std::string table_head() {
  return fmt::format(
      "limit: the least time that this machine's memory and arithmetic allow; share: limit / min\n"
      "{:<24} {:<20} {:>10} {:>10} {:>10} {:>10} {:>6}\n",
      "case", "kernel", "min ms", "median ms", "p90 ms", "limit ms", "share");
}

std::string slowest_kernel_text(const std::vector<BenchRow>& rows) {
  const BenchRow* slowest = nullptr;
  size_t kernels = 0;
  for (const BenchRow& row : rows) {
    if (row.kind != "kernel") continue;
    ++kernels;
    if (!slowest || row.ms.median > slowest->ms.median) slowest = &row;
  }
  if (!slowest) return "";
  std::string text =
      fmt::format("slowest of {} kernel{}: {} in {}, {:.3g} ms", kernels, kernels == 1 ? "" : "s",
                  slowest->name, slowest->case_name, slowest->ms.median);
  if (slowest->limit_ms && slowest->ms.min > 0)
    text += fmt::format("; the machine's limit is {:.3g} ms", *slowest->limit_ms);
  return text + "\n";
}

std::string table_line(const BenchRow& row) {
  std::string line = fmt::format("{:<24} {:<20} {:>10.4f} {:>10.4f} {:>10.4f}", row.case_name, row.name,
                                 row.ms.min, row.ms.median, row.ms.p90);
  if (row.limit_ms && row.ms.min > 0) {
    line += fmt::format(" {:>10.4f} {:>5.0f}%", *row.limit_ms, 100 * *row.limit_ms / row.ms.min);
  } else {
    line += fmt::format("{:>18}", "");
  }
  if (row.params.contains("compared")) line += fmt::format("  {}", row.params["compared"].get<std::string>());
  if (row.relative) {
    line += fmt::format("  x {:.3f} ({:.3f} to {:.3f})", row.relative->estimate, row.relative->low,
                        row.relative->high);
  } else if (row.ratio) {
    line += fmt::format("  x {:.2f}", *row.ratio);
  }
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

}  // namespace lightgrid::lab
