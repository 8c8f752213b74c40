// Pass times: a stacked bar for each of the last frames, and the means in figures.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "view/panels.h"

namespace lightgrid {
namespace {

constexpr float chart_height = 70;
constexpr ImU32 chart_background = IM_COL32(30, 33, 38, 255);

// The same colour for a pass on both sides: hues a golden angle apart, in the order in which names first
// appear.
ImU32 colour_of_pass(const std::vector<std::string>& names, const std::string& name) {
  const auto place = std::ranges::find(names, name) - names.begin();
  const float hue = std::fmod(0.58f + 0.381966f * float(place), 1.f);
  float r = 0, g = 0, b = 0;
  ImGui::ColorConvertHSVtoRGB(hue, 0.55f, place % 2 ? 0.75f : 0.95f, r, g, b);
  return ImGui::ColorConvertFloat4ToU32({r, g, b, 1});
}

std::vector<std::string> pass_names(const Shown& shown) {
  std::vector<std::string> names;
  for (const Side* side : shown.sides) {
    for (const FrameTimes& frame : side->timings().frames()) {
      for (const PassMs& pass : frame.passes) {
        if (std::ranges::find(names, pass.name) == names.end()) names.push_back(pass.name);
      }
    }
  }
  return names;
}

// The common top of both charts, so that their bars are comparable. Excludes the slowest frames, which build
// programs.
double top_of_charts(const Shown& shown) {
  std::vector<double> totals;
  for (const Side* side : shown.sides) {
    for (const FrameTimes& frame : side->timings().frames()) totals.push_back(frame.total_ms());
  }
  if (totals.empty()) return 1;
  const size_t at = totals.size() * 9 / 10;
  std::nth_element(totals.begin(), totals.begin() + ptrdiff_t(at), totals.end());
  return std::max(1.15 * totals[at], 0.01);
}

void chart(const Timings& timings, const std::vector<std::string>& names, double top_ms, float width) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(corner, {corner.x + width, corner.y + chart_height}, chart_background);
  const float bar = width / float(Timings::kept_frames);
  float x = corner.x + width - bar * float(timings.frames().size());
  draw.PushClipRect(corner, {corner.x + width, corner.y + chart_height}, true);
  for (const FrameTimes& frame : timings.frames()) {
    float y = corner.y + chart_height;
    for (const PassMs& pass : frame.passes) {
      const float height = chart_height * float(pass.ms / top_ms);
      draw.AddRectFilled({x, y - height}, {x + std::max(bar - 0.5f, 1.f), y},
                         colour_of_pass(names, pass.name));
      y -= height;
    }
    x += bar;
  }
  draw.PopClipRect();
  draw.AddText({corner.x + 4, corner.y + 2}, IM_COL32(180, 180, 180, 255),
               fmt::format("{:.1f} ms", top_ms).c_str());
  ImGui::Dummy({width, chart_height});
}

void figures(const Timings& timings, const std::vector<std::string>& names) {
  const FrameTimes mean = timings.mean(20);
  for (const PassMs& pass : mean.passes) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_of_pass(names, pass.name));
    ImGui::TextUnformatted(fmt::format("{:7.2f} {}", pass.ms, pass.name).c_str());
    ImGui::PopStyleColor();
  }
  ImGui::TextUnformatted(
      fmt::format("{:7.2f} ms, {} frames", mean.total_ms(), timings.frames().size()).c_str());
}

}  // namespace

void show_times(Controls& controls, const Shown& shown) {
  const std::vector<std::string> names = pass_names(shown);
  const double top_ms = top_of_charts(shown);
  if (ImGui::BeginTable("times", 2)) {
    ImGui::TableNextRow();
    for (const Side* side : shown.sides) {
      ImGui::TableNextColumn();
      chart(side->timings(), names, top_ms, ImGui::GetContentRegionAvail().x);
      figures(side->timings(), names);
    }
    ImGui::EndTable();
  }
  ImGui::Checkbox("measure", &controls.measure_passes);
  ImGui::SameLine();
  ImGui::Checkbox("draw even if nothing changes", &controls.draw_always);
}

}  // namespace lightgrid
