#include "inspect/judge.h"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "frames/frame_lists.h"
#include "measures/results.h"
#include "oracle/position.h"

namespace lightgrid::lab {
namespace {

bool is_listed(const ListedLights& lists, uint32_t cell, uint32_t light) {
  if (cell >= lists.first.size()) return false;
  const auto first = lists.indices.begin() + ptrdiff_t(lists.first[cell]);
  return std::find(first, first + lists.count[cell], light) != first + lists.count[cell];
}

std::vector<LostLight> lost_lights(const CapturedFrame& frame, const ListedLights& lists,
                                   const std::vector<uint32_t>& lost_of_pixel) {
  const std::vector<ViewLight> lights = local_lights(frame);
  std::vector<int> number;  // in the frame
  for (int i = 0; i < int(frame.lights.size()); ++i)
    if (!is_directional(frame.lights[size_t(i)])) number.push_back(i);
  std::map<int, LostLight> lost;
  const View& view = frame.view;
  for (int row = 0; row < view.height; ++row) {
    const int y = flipped_row(row, view.height);
    for (int x = 0; x < view.width; ++x) {
      const size_t pixel = view.grid().index(x, y);
      if (lost_of_pixel[pixel] == 0) continue;
      const glm::dvec3 position = position_from_depth(view, x, y, frame.depth[pixel]);
      for (const uint32_t light : lit_lights(lights, position)) {
        if (is_listed(lists, lists.cell_of_pixel[pixel], light)) continue;
        LostLight& l =
            lost.try_emplace(number[light], LostLight{number[light], 0, {x, row}, 0}).first->second;
        ++l.pixels;
        l.inside_m =
            std::max(l.inside_m, lights[light].radius_m - glm::length(lights[light].position - position));
      }
    }
  }
  std::vector<LostLight> all;
  for (const auto& [light, of] : lost) all.push_back(of);
  return all;
}

std::string name_in_text(const CapturedFrame& frame, int light) {
  return fmt::format("light {} \"{}\"", light, frame.lights[size_t(light)].name);
}

std::string loss_text(const LostLight& l) {
  return fmt::format("lost at {} pixels, the first {},{}; up to {:.3g} m within its range", l.pixels,
                     l.first.x, l.first.y, l.inside_m);
}

}  // namespace

Judgement judge(const CapturedFrame& frame, const FrameGrid& grid) {
  Judgement result{inspection_maps(frame, grid), {}, {}};
  const ListedLights lists = listed_lights(frame, grid);
  result.lost = lost_lights(frame, lists, result.maps.lost);
  std::map<uint32_t, CellPairs> cells;
  const std::vector<float> depth = covered_depth(frame);
  for (size_t pixel = 0; pixel < depth.size(); ++pixel) {
    const uint32_t cell = lists.cell_of_pixel[pixel];
    if (!(depth[pixel] > 0) || cell >= lists.first.size()) continue;
    CellPairs& c = cells.try_emplace(cell, CellPairs{cell}).first->second;
    ++c.pixels;
    c.listed += result.maps.listed[pixel];
    c.lit += result.maps.listed[pixel] - result.maps.false_positives[pixel] + result.maps.lost[pixel];
    c.lost += result.maps.lost[pixel];
  }
  for (const auto& [cell, of] : cells) result.cells.push_back(of);
  return result;
}

std::string judgement_text(const CapturedFrame& frame, const Judgement& j) {
  const PairCounts& p = j.maps.pairs;
  const auto per_pixel = [&](uint64_t count) {
    return j.maps.covered ? double(count) / double(j.maps.covered) : 0;
  };
  const auto lossy = std::ranges::count_if(j.cells, [](const CellPairs& c) { return c.lost > 0; });
  std::string text = fmt::format(
      "{}: lights per pixel: {:.2f} listed, {:.2f} lit; {} (pixel, light) pairs lost, {} wrong; {} of {} "
      "cells "
      "lose a light\n",
      frame.name, per_pixel(p.listed), per_pixel(p.lit), p.lost, p.wrong, lossy, j.cells.size());
  constexpr size_t max_shown = 20;
  for (size_t i = 0; i < std::min(j.lost.size(), max_shown); ++i)
    text += fmt::format("  {}: {}\n", name_in_text(frame, j.lost[i].light), loss_text(j.lost[i]));
  if (j.lost.size() > max_shown) text += fmt::format("  and {} more lights\n", j.lost.size() - max_shown);
  return text;
}

std::string judgement_json(const CapturedFrame& frame, const FrameGrid& grid, const Judgement& j) {
  using nlohmann::json;
  json lost = json::array(), cells = json::array();
  for (const LostLight& l : j.lost)
    lost.push_back({{"light", l.light},
                    {"name", frame.lights[size_t(l.light)].name},
                    {"pixels", l.pixels},
                    {"first_pixel_from_top", {l.first.x, l.first.y}},
                    {"inside_m", std::isfinite(l.inside_m) ? json(l.inside_m) : json()}});
  for (const CellPairs& c : j.cells)
    cells.push_back(
        {{"cell", c.cell}, {"pixels", c.pixels}, {"listed", c.listed}, {"lit", c.lit}, {"lost", c.lost}});
  return json_text(json{{"scene", frame.name},
                        {"size", {frame.view.width, frame.view.height}},
                        {"settings", settings_json(grid.settings)},
                        {"pairs", pairs_json(j.maps.pairs)},
                        {"covered_pixels", j.maps.covered},
                        {"lost_lights", lost},
                        {"cells", cells}});
}

std::string judgement_junit(const CapturedFrame& frame, const Judgement& j) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"lightgrid cull\" tests=\"{}\" "
      "failures=\"{}\" errors=\"0\">\n",
      frame.lights.size(), j.lost.size());
  for (int i = 0; i < int(frame.lights.size()); ++i) {
    const auto lost = std::ranges::find(j.lost, i, &LostLight::light);
    text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", xml_escaped(frame.name),
                        xml_escaped(name_in_text(frame, i)));
    text += lost == j.lost.end() ? "/>\n"
                                 : fmt::format("><failure type=\"lost\" message=\"{}\"/></testcase>\n",
                                               xml_escaped(loss_text(*lost)));
  }
  return text + "</testsuite>\n";
}

}  // namespace lightgrid::lab
