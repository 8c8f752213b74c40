// The panel of the last frames: times of passes, the lights at the clicked pixel, and the plan with its
// witnesses.
#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <imgui.h>

#include "view/panels.h"

namespace lightgrid::app {
using namespace lab;
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

constexpr size_t max_rows = 200;
constexpr float lines_high = 16;  // always, so that what is below stays where it is

// Lights in range; those out of range; hidden ones; lost, leaked and acned ones.
const ImVec4 lit_colour(1, 0.95f, 0.7f, 1), dark_colour(0.55f, 0.55f, 0.55f, 1),
    hidden_colour(0.55f, 0.7f, 1, 1), wrong_colour(1, 0.3f, 0.3f, 1);

ImVec4 colour_of(const ShadowVerdict& shadow) {
  if (shadow.leaked() || shadow.acned()) return wrong_colour;
  return shadow.truth.sight == Sight::hidden ? hidden_colour : lit_colour;
}

// Below its light's name.
void shadow_text(const std::string& text, const ShadowVerdict& shadow) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour_of(shadow));
  ImGui::Indent(8);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::Unindent(8);
  ImGui::PopStyleColor();
}

// A click on it chooses the light.
void light_name(const std::string& text, const ImVec4& colour, int light, Controls& controls) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushID(light);
  if (ImGui::Selectable(text.c_str(), controls.light == light)) toggle_light(controls, light);
  ImGui::PopID();
  ImGui::PopStyleColor();
}

void show_lights(const PixelInspection& pixel, const Scene& scene, Controls& controls) {
  if (!pixel.covered) {
    ImGui::TextUnformatted("no opaque surface");
    return;
  }
  ImGui::TextUnformatted(
      fmt::format("{} listed, {} lit, {} lost", pixel.listed(), pixel.lit(), pixel.lost()).c_str());
  ImGui::TextUnformatted(fmt::format("surface {:.3g} m away", pixel.distance_m).c_str());
  const std::string shadows = shadows_at_pixel(pixel);
  if (!shadows.empty()) ImGui::TextUnformatted(shadows.c_str());
  ImGui::BeginChild("lights", {0, 0});
  for (size_t i = 0; i < std::min(pixel.lights.size(), max_rows); ++i) {
    const LightVerdict& light = pixel.lights[i];
    const bool lost = light.lit && !light.listed;
    const auto [where, decided, shadow] = lines_of(light, scene);
    light_name(where,
               lost           ? wrong_colour
               : light.shadow ? colour_of(*light.shadow)
               : light.lit    ? lit_colour
                              : dark_colour,
               light.light, controls);
    if (!decided.empty()) ImGui::TextDisabled("  %s", decided.c_str());
    if (light.shadow) shadow_text(shadow, *light.shadow);
  }
  for (const DirectionalShadow& light : pixel.directional_shadows) {
    const auto [name, shadow] = lines_of(light, scene);
    light_name(name, colour_of(light.shadow), light.light, controls);
    shadow_text(shadow, light.shadow);
  }
  ImGui::EndChild();
}

constexpr double news_s = 3;  // how long a change is highlighted

void show_decision(const Decision& decision, bool is_new) {
  const ImVec4 colour = is_new            ? ImVec4(1, 0.85f, 0.3f, 1)
                        : decision.needed ? ImVec4(0.55f, 0.9f, 0.6f, 1)
                                          : ImVec4(0.5f, 0.5f, 0.5f, 1);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextWrapped(
      "%s", fmt::format("{} {}: {}", decision.needed ? "+" : "-", decision.effect, decision.why).c_str());
  ImGui::PopStyleColor();
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

void show_pixel(Controls& controls, const Shown& shown) {
  if (!controls.pixel) {
    ImGui::TextDisabled("click a pixel of the picture");
    return;
  }
  ImGui::TextUnformatted(fmt::format("pixel {},{}", controls.pixel->x, controls.pixel->y).c_str());
  ImGui::SameLine();
  const bool clear = ImGui::SmallButton("clear");
  const float height = lines_high * ImGui::GetTextLineHeightWithSpacing();
  if (ImGui::BeginTable("pixel", 2)) {
    ImGui::TableNextRow();
    for (int i = 0; i < 2; ++i) {
      ImGui::TableNextColumn();
      ImGui::PushID(i);
      ImGui::BeginChild("side", {0, height});
      if (shown.pixel[i]) {
        show_lights(*shown.pixel[i], shown.scene, controls);
      } else {
        ImGui::TextDisabled(shown.sides[i]->ready() ? "when the camera rests" : "not drawn");
      }
      ImGui::EndChild();
      ImGui::PopID();
    }
    ImGui::EndTable();
  }
  if (clear) controls.pixel.reset();
}

void PlanHistory::follow(const FramePlan& plan, double now_s) {
  for (const Decision& decision : plan.decisions) {
    const std::string text = (decision.needed ? "+" : "-") + decision.why;
    const double never = -std::numeric_limits<double>::infinity();
    const auto [entry, is_new] = entries_.try_emplace(decision.effect, Entry{text, first_ ? never : now_s});
    if (entry->second.text != text) entry->second = {text, now_s};
  }
  first_ = false;
}

double PlanHistory::age_s(const std::string& effect, double now_s) const {
  const auto found = entries_.find(effect);
  return found == entries_.end() ? std::numeric_limits<double>::infinity() : now_s - found->second.changed_s;
}

void show_plan(const Shown& shown) {
  if (!ImGui::BeginTabBar("plans")) return;
  for (int i = 0; i < 2; ++i) {
    if (!ImGui::BeginTabItem(i ? "right" : "left")) continue;
    for (const bool needed : {true, false}) {
      for (const Decision& decision : shown.sides[i]->run().view().plan.decisions) {
        if (decision.needed == needed)
          show_decision(decision, shown.plans[i].age_s(decision.effect, shown.now_s) < news_s);
      }
    }
    ImGui::EndTabItem();
  }
  ImGui::EndTabBar();
}

}  // namespace lightgrid::app
