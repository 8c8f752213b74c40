// Text over the picture: names of the sides, the line, the inspected pixel, and the size of the drawn
// picture.
#include <fmt/format.h>
#include <imgui.h>

#include "view/panels.h"

namespace lightgrid {
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
