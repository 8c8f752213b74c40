// Techniques, maps and settings of both sides, as controls generated from the table of settings.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "techniques/technique.h"
#include "view/panels.h"

namespace lightgrid::app {
using namespace lab;
namespace {

std::string about_technique(const std::string& name) {
  const Technique& technique = find_technique(name);
  return fmt::format("{}: {}. {}", name, technique.summary, technique.source);
}

void choose_technique(SideControls& side) {
  std::vector<std::string> names;
  for (const Technique* t : techniques()) names.emplace_back(t->name);
  if (const auto chosen = combo("##technique", side.technique, names, about_technique))
    side.technique = names[*chosen];
}

void choose_setting(SideControls& side, const SettingRow& setting) {
  const std::vector<std::string> values(setting.values.begin(), setting.values.end());
  const auto chosen =
      combo(("##" + setting.key).c_str(), to_strings(side.settings).at(json_key(setting.key)), values);
  if (chosen) apply_setting(side.settings, setting.key + "=" + values[*chosen]);
}

// A column of names, and one for each side.
bool begin_table(const char* id) {
  if (!ImGui::BeginTable(id, 3)) return false;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 100);
  ImGui::TableSetupColumn("left");
  ImGui::TableSetupColumn("right");
  return true;
}

void row_name(const char* name, const std::string& meaning) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(name);
  tooltip(meaning);
}

// A table cell for each side, filled by `control`.
template <typename Control>
void cells(Controls& controls, const Control& control) {
  for (int i = 0; i < 2; ++i) {
    ImGui::TableNextColumn();
    ImGui::PushID(i);
    control(controls.sides[i]);
    ImGui::PopID();
  }
}

bool reads(const SideControls& side, const std::string& key) {
  return reads_setting(find_technique(side.technique), key);
}

}  // namespace

void show_techniques(Controls& controls, const Shown& shown) {
  if (begin_table("techniques")) {
    row_name("technique", "");
    cells(controls, choose_technique);
    row_name("show", "the picture, or a map of its lights or errors");
    cells(controls, [](SideControls& side) {
      const std::vector<std::string> names(map_names().begin(), map_names().end());
      if (const auto chosen = combo("##map", names[size_t(side.map)], names)) side.map = SideMap(*chosen);
    });
    ImGui::EndTable();
  }
  bool any_map = false;
  for (int i = 0; i < 2; ++i) {
    any_map |= controls.sides[i].map != SideMap::picture;
    if (controls.sides[i].map != SideMap::picture && shown.notes[i].empty()) {
      ImGui::TextWrapped("%s: %s", i ? "right" : "left", shown.maps[i]->legend().c_str());
    }
  }
  if (any_map) ImGui::Checkbox("picture under maps", &controls.picture_under);
}

void show_settings(Controls& controls, bool of_shadows) {
  if (!begin_table("settings")) return;
  for (const SettingRow& setting : setting_rows()) {
    if (setting.key.starts_with("shadow") != of_shadows) continue;
    if (!reads(controls.sides[0], setting.key) && !reads(controls.sides[1], setting.key)) continue;
    row_name(setting.key.c_str(), setting.meaning);
    cells(controls, [&](SideControls& side) {
      if (reads(side, setting.key)) choose_setting(side, setting);
    });
  }
  ImGui::EndTable();
}

}  // namespace lightgrid::app
