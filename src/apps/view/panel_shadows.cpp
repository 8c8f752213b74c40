// The lights that cast shadows: which they are, how shadows are found, and what the plan says of each.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "plan/settings/kernels.h"
#include "plan/settings/shadows.h"
#include "view/panels.h"

namespace lightgrid::app {
using namespace lab;
namespace {

constexpr float casting_lines_high = 9;  // height of the list

bool has_shadows_found(const LightShadow& light, const FramePlan& plan) {
  return plan.shadows.light_reaches &&
         (plan.settings[setting::everything_on] || light.need == ShadowNeed::rays);
}

const char* found_by(const FramePlan& plan) {
  return plan.settings[setting::shadows] == ShadowMethod::map ? "maps" : "rays";
}

std::string why_none(const FramePlan& plan) {
  return std::ranges::find(plan.decisions, "shadows", &Decision::effect)->why;
}

void choose_casters(Controls& controls) {
  const std::vector<std::string> names = {"as the scene says", "none", "1", "4", "16", "64", "256", "all"};
  const std::string current = controls.casters.empty() ? names[0] : controls.casters;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("lights that cast");
  ImGui::SameLine();
  const auto chosen = combo("##casters", current, names,
                            [](const std::string&) { return "all, none, or so many of the most important"; });
  if (chosen) controls.casters = *chosen == 0 ? "" : names[*chosen];
}

void list_lights(Controls& controls, const FramePlan& plan, const Scene& scene) {
  ImGui::TextWrapped("%s", casting_summary(plan).c_str());
  ImGui::BeginChild("casting", {0, casting_lines_high * ImGui::GetTextLineHeightWithSpacing()});
  ImGuiListClipper rows;
  rows.Begin(int(plan.shadows.casting.size()));
  while (rows.Step()) {
    for (int i = rows.DisplayStart; i < rows.DisplayEnd; ++i) {
      const LightShadow& light = plan.shadows.casting[size_t(i)];
      const ImVec4 colour =
          has_shadows_found(light, plan) ? ImVec4(0.55f, 0.9f, 0.6f, 1) : ImVec4(0.55f, 0.55f, 0.55f, 1);
      const std::string line = casting_line(light, plan, scene);
      ImGui::PushStyleColor(ImGuiCol_Text, colour);
      if (ImGui::Selectable(line.c_str(), controls.light == light.light)) toggle_light(controls, light.light);
      ImGui::PopStyleColor();
      tooltip(line);
    }
  }
  ImGui::EndChild();
}

}  // namespace

std::string casting_summary(const FramePlan& plan) {
  if (plan.shadows.casting.empty()) return "no light casts a shadow";
  if (!plan.shadows.light_reaches)
    return fmt::format("{} lights cast shadows: {}", plan.shadows.casting.size(), why_none(plan));
  const auto found = std::ranges::count_if(plan.shadows.casting,
                                           [&](const LightShadow& l) { return has_shadows_found(l, plan); });
  return fmt::format("{} lights cast shadows: {} by {}, {} need none", plan.shadows.casting.size(), found,
                     found_by(plan), plan.shadows.casting.size() - size_t(found));
}

std::string casting_line(const LightShadow& light, const FramePlan& plan, const Scene& scene) {
  const bool found = has_shadows_found(light, plan);
  const std::string how = !plan.shadows.light_reaches ? "none" : found ? found_by(plan) : "none";
  return fmt::format("{} \"{}\": {}, {}", light.light, scene.lights[size_t(light.light)].name, how,
                     plan.shadows.light_reaches ? words_of(light, scene) : why_none(plan));
}

void show_shadows(Controls& controls, const Shown& shown) {
  choose_casters(controls);
  show_settings(controls, true);
  if (controls.light) {
    const std::string& name = shown.scene.lights[size_t(*controls.light)].name;
    ImGui::TextUnformatted(fmt::format("maps count light {} \"{}\" alone", *controls.light, name).c_str());
    ImGui::SameLine();
    if (ImGui::SmallButton("count all")) controls.light.reset();
  }
  if (!ImGui::BeginTabBar("casting lights")) return;
  for (int i = 0; i < 2; ++i) {
    if (!ImGui::BeginTabItem(i ? "right" : "left")) continue;
    list_lights(controls, shown.sides[i]->run().view().plan, shown.scene);
    ImGui::EndTabItem();
  }
  ImGui::EndTabBar();
}

}  // namespace lightgrid::app
