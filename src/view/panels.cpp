#include "view/panels.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

namespace lightgrid {

namespace {

void show_status(const Controls& controls, const Shown& shown) {
  const double ms = shown.sides[0]->frame_ms() + shown.sides[1]->frame_ms();
  ImGui::TextUnformatted(fmt::format("{}: {} lights, {} in view", shown.scene.name, shown.scene.lights.size(),
                                     shown.sides[0]->run().view().plan.lights_in_view)
                             .c_str());
  ImGui::TextUnformatted(
      fmt::format("{} x {}, both sides {:.1f} ms", shown.picture_width, shown.picture_height, ms).c_str());
  if (shown.fraction < 1) {
    ImGui::SameLine();
    ImGui::TextColored({1, 0.8f, 0.3f, 1}, "%s",
                       fmt::format("(moving: drawn at {:.0f} %)", 100 * shown.fraction).c_str());
  }
  ImGui::TextDisabled("drag: look, WASD QE: fly, shift: faster, click: lights");
  for (size_t i = 0; i < 2; ++i) {
    if (!shown.sides[i]->problem().empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 0.4f, 0.3f, 1));
      ImGui::TextWrapped("%s: %s", controls.sides[i].technique.c_str(), shown.sides[i]->problem().c_str());
      ImGui::PopStyleColor();
    }
  }
}

bool section(const char* name, bool open) {
  return ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

}  // namespace

void show_panels(Controls& controls, const Shown& shown) {
  ImGui::SetNextWindowPos({float(shown.picture_width), 0});
  ImGui::SetNextWindowSize({float(panel_width), float(shown.picture_height)});
  constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                     ImGuiWindowFlags_NoBringToFrontOnFocus;
  ImGui::Begin("panel", nullptr, fixed);
  show_status(controls, shown);
  show_techniques(controls, shown);
  if (section("Settings", false)) show_settings(controls);
  if (shown.pixel_is_new) ImGui::SetNextItemOpen(true);
  if (section("Lights at a pixel", false)) show_pixel(controls, shown);
  if (section("Movement", true)) show_motion(controls, shown);
  if (section("This view again", true)) show_commands(controls, shown);
  if (section("Times of passes", true)) show_times(controls, shown);
  if (section("Plan", true)) show_plan(shown);
  ImGui::End();
}

void show_motion(Controls& controls, const Shown& shown) {
  constexpr const char* names[] = {"none", "orbit", "drift"};
  int motion = int(controls.lights);
  ImGui::SetNextItemWidth(90);
  if (ImGui::Combo("lights move", &motion, names, 3)) {
    controls.lights = LightMotion(motion);
    controls.playing = controls.lights != LightMotion::none || shown.motion.animated();
  }
  ImGui::SameLine();
  if (ImGui::Button(controls.playing ? "pause" : "play")) controls.playing = !controls.playing;
  ImGui::SameLine();
  if (ImGui::Button("step")) controls.step = true;
  ImGui::SameLine();
  if (ImGui::Button("start")) controls.seconds = 0;
  ImGui::SameLine();
  ImGui::TextUnformatted(fmt::format("{:.2f} s", shown.motion.seconds()).c_str());
  if (!shown.motion.can_play()) ImGui::TextDisabled("the file has no animation; lights can be moved");
  float rate = float(controls.rate);
  ImGui::SetNextItemWidth(150);
  if (ImGui::SliderFloat("frames/s to hold, 0: full picture", &rate, 0, 120, "%.0f")) controls.rate = rate;
  float speed = float(shown.camera.speed_m);
  ImGui::SetNextItemWidth(150);
  if (ImGui::SliderFloat("metres/s", &speed, 0.01f, 100, "%.2f", ImGuiSliderFlags_Logarithmic))
    shown.camera.speed_m = speed;
}

void show_commands(Controls& controls, const Shown& shown) {
  for (size_t i = 0; i < 2; ++i) {
    ImGui::PushID(int(i));
    std::string text = shown.commands[i];
    ImGui::SetNextItemWidth(-50);
    ImGui::InputText("##command", text.data(), text.size() + 1, ImGuiInputTextFlags_ReadOnly);
    ImGui::SameLine();
    if (ImGui::Button("copy")) ImGui::SetClipboardText(text.c_str());
    ImGui::PopID();
  }
  if (ImGui::Button("screenshot")) controls.screenshot = true;
  ImGui::SameLine();
  ImGui::TextDisabled("%s", shown.note.c_str());
}

namespace {

constexpr ImU32 ink = IM_COL32(255, 255, 255, 255), backdrop = IM_COL32(0, 0, 0, 170);

enum class Align { left, centre, right };

void label(ImDrawList& draw, const std::string& text, float x, float y, Align align) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  if (align == Align::centre) x -= size.x / 2;
  if (align == Align::right) x -= size.x;
  draw.AddRectFilled({x - 4, y - 2}, {x + size.x + 4, y + size.y + 2}, backdrop, 3);
  draw.AddText({x, y}, ink, text.c_str());
}

std::string name_of(const SideControls& side, const std::string& note) {
  if (side.map == SideMap::picture) return side.technique;
  const char* map = map_names()[int(side.map)];
  return note.empty() ? fmt::format("{}: {}", side.technique, map)
                      : fmt::format("{}: {} {}", side.technique, map, note);
}

}  // namespace

void show_overlay(const Controls& controls, const Shown& shown) {
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const auto width = float(shown.picture_width), height = float(shown.picture_height);
  const float line = std::floor(float(controls.line) * width);
  draw.PushClipRect({0, 0}, {width, height});
  draw.AddRectFilled({line - 1, 0}, {line + 1, height}, ink);
  label(draw, name_of(controls.sides[0], shown.map_notes[0]), 8, 4, Align::left);
  label(draw, name_of(controls.sides[1], shown.map_notes[1]), width - 8, 4, Align::right);
  if (shown.fraction < 1) {
    const std::string text = fmt::format("moving: {:.0f} x {:.0f} of {} x {} to hold {:.0f} frames a second",
                                         width * shown.fraction, height * shown.fraction, shown.picture_width,
                                         shown.picture_height, controls.rate);
    label(draw, text, width / 2, height - 20, Align::centre);
  }
  if (controls.pixel) {
    const ImVec2 at(float(controls.pixel->x) + 0.5f, height - float(controls.pixel->y) - 0.5f);
    draw.AddCircle(at, 7, backdrop, 0, 3);
    draw.AddCircle(at, 7, ink);
  }
  draw.PopClipRect();
}

}  // namespace lightgrid
