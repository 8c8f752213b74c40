// The lights at the pixel that was clicked.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "view/panels.h"

namespace lightgrid {
namespace {

constexpr size_t most_rows = 200;
constexpr float lines_high = 16;  // always, so that what is below stays where it is

void show_lights(const PixelInspection& pixel, const Scene& scene) {
  if (!pixel.covered) {
    ImGui::TextUnformatted("no opaque surface");
    return;
  }
  ImGui::TextUnformatted(
      fmt::format("{} listed, {} lit, {} lost", pixel.listed(), pixel.lit(), pixel.lost()).c_str());
  ImGui::TextUnformatted(fmt::format("surface {:.3g} m away", pixel.distance_m).c_str());
  ImGui::BeginChild("lights", {0, 0});
  for (size_t i = 0; i < std::min(pixel.lights.size(), most_rows); ++i) {
    const LightVerdict& light = pixel.lights[i];
    const bool lost = light.lit && !light.listed;
    const ImVec4 colour = lost        ? ImVec4(1, 0.3f, 0.3f, 1)
                          : light.lit ? ImVec4(1, 0.95f, 0.7f, 1)
                                      : ImVec4(0.55f, 0.55f, 0.55f, 1);
    const auto [where, decided] = lines_of(light, scene);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(where.c_str());
    ImGui::PopStyleColor();
    if (!decided.empty()) ImGui::TextDisabled("  %s", decided.c_str());
  }
  ImGui::EndChild();
}

}  // namespace

void show_pixel(Controls& controls, const Shown& shown) {
  if (!controls.pixel) {
    ImGui::TextDisabled("click a pixel of the picture");
    return;
  }
  ImGui::TextUnformatted(
      fmt::format("pixel {},{} from the lower left", controls.pixel->x, controls.pixel->y).c_str());
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
        show_lights(*shown.pixel[i], shown.scene);
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

}  // namespace lightgrid
