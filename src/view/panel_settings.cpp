// Techniques, maps and settings of both sides, as controls generated from the table of settings.
#include <algorithm>

#include <imgui.h>

#include "techniques/technique.h"
#include "view/panels.h"

namespace lightgrid {
namespace {

// Returns the choice made in this frame, or null.
template <typename Names>
const char* combo(const char* id, const std::string& current, const Names& names) {
  const char* chosen = nullptr;
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::BeginCombo(id, current.c_str())) return nullptr;
  for (const auto& name : names) {
    const std::string text = name;
    if (ImGui::Selectable(text.c_str(), text == current)) chosen = &name[0];
  }
  ImGui::EndCombo();
  return chosen;
}

void choose_technique(SideControls& side) {
  std::vector<std::string> names;
  for (const Technique* t : techniques()) names.emplace_back(t->name);
  if (const char* chosen = combo("##technique", side.technique, names)) side.technique = chosen;
}

void choose_setting(SideControls& side, const SettingHelp& setting) {
  const std::string id = "##" + setting.key;
  const char* chosen = combo(id.c_str(), to_strings(side.settings).at(json_key(setting.key)), setting.values);
  if (chosen) apply_setting(side.settings, setting.key + "=" + chosen);
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
  if (ImGui::IsItemHovered() && !meaning.empty()) ImGui::SetTooltip("%s", meaning.c_str());
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
      const char* chosen = combo("##map", map_names()[int(side.map)], map_names());
      if (chosen) side.map = parse_map(chosen);
    });
    ImGui::EndTable();
  }
  for (int i = 0; i < 2; ++i) {
    if (controls.sides[i].map != SideMap::picture && shown.map_notes[i].empty()) {
      ImGui::TextWrapped("%s: %s", i ? "right" : "left", shown.maps[i]->legend().c_str());
    }
  }
}

void show_settings(Controls& controls) {
  if (!begin_table("settings")) return;
  for (const SettingHelp& setting : setting_help()) {
    if (!reads(controls.sides[0], setting.key) && !reads(controls.sides[1], setting.key)) continue;
    row_name(setting.key.c_str(), setting.meaning);
    cells(controls, [&](SideControls& side) {
      if (reads(side, setting.key)) choose_setting(side, setting);
    });
  }
  ImGui::EndTable();
}

}  // namespace lightgrid
