#include "frames/frame_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "measures/results.h"

namespace lightgrid::lab {
namespace {

uint32_t longest_list(const HostGrid& lists) {
  uint32_t longest = 0;
  for (const glm::uvec2& cell : lists.cells) longest = std::max(longest, cell.y);
  return longest;
}

double mean_list(const HostGrid& lists) {
  return lists.cells.empty() ? 0 : double(lists.indices.size()) / double(lists.cells.size());
}

}  // namespace

std::string summary_line(const CapturedFrame& frame, const FrameGrid& grid) {
  const HostGrid& lists = grid.lists;
  const std::string slices = lists.slices > 1 ? fmt::format("x{}", lists.slices) : "";
  return fmt::format("{}x{}, {} lights, {}x{}{} cells of {} pixels, {} indices ({:.1f} a cell, at most {})",
                     frame.view.width, frame.view.height, frame.lights.size(), lists.cells_x, lists.cells_y,
                     slices, grid.tile, lists.indices.size(), mean_list(lists), longest_list(lists));
}

std::string summary_json(const CapturedFrame& frame, const FrameGrid& grid, const std::string& device,
                         const std::optional<Spread>& time) {
  const HostGrid& lists = grid.lists;
  nlohmann::json out = {
      {"frame", frame.name},
      {"size", {frame.view.width, frame.view.height}},
      {"device", device},
      {"settings", settings_json(grid.settings)},
      {"lights", {{"total", frame.lights.size()}, {"listable", local_world_lights(frame).size()}}},
      {"grid",
       {{"cells", {lists.cells_x, lists.cells_y, lists.slices}},
        {"tile", grid.tile},
        {"indices", lists.indices.size()},
        {"mean", mean_list(lists)},
        {"max", longest_list(lists)}}}};
  if (time)
    out["cull_ms"] = {{"min", time->min}, {"median", time->median}, {"max", time->max}, {"runs", time->runs}};
  return json_text(out);
}

}  // namespace lightgrid::lab
