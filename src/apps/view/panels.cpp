#include "view/panels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "scenes/builtin.h"

namespace lightgrid::app {
using namespace lab;

namespace {

std::string rate_words(double frames) { return fmt::format("{:.{}f} frames/s", frames, frames < 10 ? 1 : 0); }

bool close_lists = false;  // in this frame

std::string about_scene(const std::string& name) {
  const BuiltinScene* scene = find_builtin_scene(name);
  return scene ? scene->summary : name;
}

void show_status(Controls& controls, const Shown& shown) {
  const std::string current = std::filesystem::path(shown.scene_name).filename().string();
  if (const auto chosen = combo("##scene", current, shown.scenes, about_scene))
    controls.scene = shown.scenes[*chosen];
  ImGui::TextUnformatted(fmt::format("{}: {} lights, {} in view", shown.scene.name, shown.scene.lights.size(),
                                     shown.sides[0]->run().view().plan.lights.in_view)
                             .c_str());
  ImGui::TextUnformatted(fmt::format("{} x {}{}", shown.picture_width, shown.picture_height,
                                     shown.rate > 0 ? ", window " + rate_words(shown.rate) : "")
                             .c_str());
  if (shown.fraction < 1) {
    ImGui::SameLine();
    ImGui::TextColored({1, 0.8f, 0.3f, 1}, "%s",
                       fmt::format("(drawn at {:.0f} %)", 100 * shown.fraction).c_str());
  }
  ImGui::TextDisabled("drag: look, WASD QE: fly, click: lights, H: all keys");
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

void tooltip(const std::string& text) {
  constexpr float widest = 360;
  if (text.empty() || !ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(widest);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

std::optional<size_t> combo(const char* id, const std::string& current, const std::vector<std::string>& names,
                            const std::function<std::string(const std::string&)>& about) {
  std::optional<size_t> chosen;
  ImGui::SetNextItemWidth(-1);
  const bool open = ImGui::BeginCombo(id, current.c_str(), ImGuiComboFlags_HeightLarge);
  if (!open && about) tooltip(about(current));
  if (!open) return {};
  for (size_t i = 0; i < names.size(); ++i) {
    if (ImGui::Selectable(names[i].c_str(), names[i] == current)) chosen = i;
    if (about) tooltip(about(names[i]));
  }
  if (close_lists) ImGui::CloseCurrentPopup();
  ImGui::EndCombo();
  return chosen;
}

static void show_keys(float picture_width) {
  constexpr float room = 560;  // for the list over the picture; else over the panel too
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float middle = picture_width >= room ? picture_width / 2 : size.x / 2;
  ImGui::SetNextWindowPos({middle, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::Begin("keys", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  for (const KeyHelp& key : key_help()) {
    if (*key.shown) ImGui::TextUnformatted(fmt::format("{:<14} {}", key.shown, key.does).c_str());
  }
  ImGui::End();
}

void show_panels(Controls& controls, const Shown& shown) {
  close_lists = std::exchange(controls.close_lists, false);
  if (close_lists) controls.show_keys = false;
  ImGui::SetNextWindowPos({float(shown.picture_width), 0});
  ImGui::SetNextWindowSize({float(panel_width), float(shown.picture_height)});
  constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                     ImGuiWindowFlags_NoBringToFrontOnFocus;
  ImGui::Begin("panel", nullptr, fixed);
  show_status(controls, shown);
  show_techniques(controls, shown);
  if (section("Settings", false)) show_settings(controls, false);
  if (section("Shadows", false)) show_shadows(controls, shown);
  if (shown.pixel_is_new) ImGui::SetNextItemOpen(true);
  if (section("Lights at a pixel", false)) show_pixel(controls, shown);
  if (section("Camera", true)) show_camera(controls, shown);
  if (section("Movement", true)) show_motion(controls, shown);
  if (section("This view again", true)) show_commands(controls, shown);
  if (section("Times of passes", true)) show_times(controls, shown);
  if (section("Plan", true)) show_plan(shown);
  ImGui::End();
  if (controls.show_keys) show_keys(float(shown.picture_width));
}

void show_camera(Controls& controls, const Shown& shown) {
  std::vector<std::string> names;
  for (size_t i = 0; i < shown.scene.cameras.size(); ++i)
    names.push_back(fmt::format("{} {}", i, shown.scene.cameras[i].name));
  if (!names.empty()) {
    const auto chosen = combo("##camera", "cameras of the scene", names);
    if (chosen) controls.camera = std::to_string(*chosen);
  }
  if (ImGui::Button("reset")) controls.camera = shown.start_camera;
  for (int i = 0; i < 3; ++i) {
    auto& bookmark = controls.bookmarks[i];
    ImGui::SameLine();
    if (ImGui::Button(fmt::format("{} {}", bookmark ? "go to" : "keep", i + 1).c_str())) {
      if (bookmark) controls.camera = bookmark;
      if (!bookmark) bookmark = shown.camera.text();
    }
    tooltip(fmt::format("a bookmark: shift+{} keeps this camera, {} goes there", i + 1, i + 1));
  }
  ImGui::SameLine();
  ImGui::Checkbox("signs at lights", &controls.show_lights);
  float speed = float(shown.camera.speed_m);
  ImGui::SetNextItemWidth(150);
  if (ImGui::SliderFloat("metres/s", &speed, 0.01f, 100, "%.2f", ImGuiSliderFlags_Logarithmic))
    shown.camera.speed_m = speed;
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

constexpr float margin = 8, gap = 6;

// `x`: of its left end, its right end if `anchor` is 1, or its middle, 0.5. Wrapped in the picture's width.
ImVec2 label(const std::string& text, float x, float y, float anchor, float width) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, width - 2 * margin);
  x = std::max(std::floor(x - anchor * size.x), margin);
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddRectFilled({x - 4, y - 2}, {x + size.x + 4, y + size.y + 2}, backdrop, 3);
  draw.AddText(nullptr, 0, {x, y}, ink, text.c_str(), nullptr, width - 2 * margin);
  return size;
}

std::string name_of(const SideControls& side, const std::string& note, double ms) {
  std::string name = side.technique;
  if (side.map != SideMap::picture) name += fmt::format(": {}", map_names()[int(side.map)]);
  if (!note.empty()) name += " " + note;
  return ms > 0 ? fmt::format("{}  {}, {:.1f} ms", name, rate_words(1000 / ms), ms) : name;
}

// A dot at each light that has a place, or only at the chosen one (null: none is), with a spot's direction.
// That under the pointer, else the chosen one, has its range and a text.
void light_signs(const Shown& shown, bool all, const Light* chosen, float width, float height) {
  constexpr float dot = 4, reach = 9;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const View& view = shown.view;
  const auto seen = [&](const glm::dvec3& place, ImVec2& at) {
    const glm::dvec4 clip = view.clip_from_view * (view.view_from_world * glm::dvec4(place, 1));
    at = {float((0.5 + 0.5 * clip.x / clip.w) * width), float((0.5 - 0.5 * clip.y / clip.w) * height)};
    return clip.w > 0 && clip.z > 0 && clip.z <= clip.w;
  };
  const Light* pointed = nullptr;
  ImVec2 pointed_at;
  float nearest = reach;
  for (const Light& light : shown.scene.lights) {
    const bool is_chosen = chosen == &light;
    if (!all && !is_chosen) continue;
    ImVec2 at, tip;
    if (is_directional(light) || !seen(light.position, at)) continue;
    const float peak = std::max({light.color.r, light.color.g, light.color.b, 1e-9f});
    const ImU32 colour =
        ImGui::ColorConvertFloat4ToU32({light.color.r / peak, light.color.g / peak, light.color.b / peak, 1});
    const float length = std::isfinite(light.radius_m) ? light.radius_m / 4 : 1;
    if (has_cone(light) && seen(light.position + glm::dvec3(light.direction * length), tip))
      draw.AddLine(at, tip, colour, 2);
    draw.AddCircleFilled(at, dot + 1.5f, backdrop);
    draw.AddCircleFilled(at, dot, colour);
    const float away = std::hypot(at.x - float(shown.pointer[0]), at.y - float(shown.pointer[1]));
    if (away >= nearest && !(is_chosen && !pointed)) continue;
    nearest = std::min(away, reach);
    pointed = &light;
    pointed_at = at;
  }
  if (!pointed) return;
  const double away = glm::distance(pointed->position, view.eye);
  const double deep = view.orthographic ? 1 : away;  // the ball's outline, but for its perspective
  const double radius = view.clip_from_view[1][1] * height / 2 * pointed->radius_m / deep;
  if (std::isfinite(radius)) draw.AddCircle(pointed_at, float(std::min(radius, 1e5)), ink, 96);
  const std::string name =
      pointed->name.empty() ? fmt::format("light {}", pointed - shown.scene.lights.data()) : pointed->name;
  const std::string range =
      std::isfinite(pointed->radius_m) ? fmt::format("range {:.3g} m", pointed->radius_m) : "without a range";
  label(fmt::format("{}: {}, {:.3g} cd, {}, {:.3g} m away", name, name_of(pointed->type), pointed->intensity,
                    range, away),
        pointed_at.x + 10, pointed_at.y - 24, pointed_at.x > width / 2 ? 1 : 0, width);
}

// Between two columns, at the picture's lower edge.
void colour_bar(const MapScale& scale, float left, float right, float bottom) {
  constexpr float longest = 260, shortest = 100, high = 10, black = 18;
  if (right - left < shortest + 2 * margin || !scale.ramp) return;
  const float from = std::floor(left + margin + 4),
              to = std::floor(std::min(right - margin - 4, from + longest));
  const float line = ImGui::GetTextLineHeight(), y = bottom - line - high - 14;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddRectFilled({from - 6, y - 6}, {to + 6, bottom - 4}, backdrop, 3);
  draw.AddRectFilled({from, y}, {from + black, y + high}, IM_COL32(0, 0, 0, 255));
  const float start = from + black + 2;
  for (float x = start; x < to; ++x) {
    const glm::u8vec3 c = (*scale.ramp)[size_t((x - start) / (to - start) * float(scale.ramp->size()))];
    draw.AddRectFilled({x, y}, {x + 1, y + high}, IM_COL32(c.r, c.g, c.b, 255));
  }
  const auto number = [&](const std::string& text, float x, float anchor) {
    draw.AddText({std::floor(x - anchor * ImGui::CalcTextSize(text.c_str()).x), y + high + 2}, ink,
                 text.c_str());
  };
  number("0", from + black / 2, 0.5f);
  number(scale.least, start + 2, 0);
  if (to - from > 200) number(scale.middle, (start + to) / 2, 0.5f);
  number(scale.most, to, 1);
}

}  // namespace

// Below the left label where the picture is too narrow for both side by side.
float second_label_y(float left_width, float left_height, float right_width, float picture_width) {
  const bool fit = margin + left_width + gap + right_width + margin + 8 <= picture_width;
  return fit ? first_label_y : first_label_y + left_height + gap;
}

void show_overlay(const Controls& controls, const Shown& shown) {
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const auto width = float(shown.picture_width), height = float(shown.picture_height);
  const float line = std::floor(float(controls.line) * width);
  draw.PushClipRect({0, 0}, {width, height});
  draw.AddRectFilled({line - 1, 0}, {line + 1, height}, ink);
  std::string names[2];
  for (int i = 0; i < 2; ++i) {
    names[i] = name_of(controls.sides[i], shown.notes[i], shown.sides[i]->frame_ms());
    if (controls.sides[i].map != SideMap::picture && shown.notes[i].empty())
      colour_bar(shown.maps[i]->scale(), i ? line : 0, i ? width : line, height);
  }
  const Light* chosen = controls.light ? &shown.scene.lights[size_t(*controls.light)] : nullptr;
  if (controls.show_lights || chosen) light_signs(shown, controls.show_lights, chosen, width, height);
  const ImVec2 left = label(names[0], margin, first_label_y, 0, width);
  const float right_width = ImGui::CalcTextSize(names[1].c_str()).x;
  label(names[1], width - margin, second_label_y(left.x, left.y, right_width, width), 1, width);
  if (shown.fraction < 1) {
    const std::string text = fmt::format("drawn at {:.0f} x {:.0f} of {} x {} to hold {:.0f} frames a second",
                                         width * shown.fraction, height * shown.fraction, shown.picture_width,
                                         shown.picture_height, controls.rate);
    label(text, width / 2, height - 20 - (ImGui::CalcTextSize(text.c_str()).x > width ? 16 : 0), 0.5f, width);
  }
  if (shown.note_is_new && !shown.note.empty()) label(shown.note, width / 2, height / 2, 0.5f, width);
  if (controls.pixel) {
    const ImVec2 at(float(controls.pixel->x) + 0.5f, float(controls.pixel->y) + 0.5f);
    draw.AddCircle(at, 7, backdrop, 0, 3);
    draw.AddCircle(at, 7, ink);
  }
  draw.PopClipRect();
}

}  // namespace lightgrid::app
