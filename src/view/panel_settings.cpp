// Techniques, maps and settings of both sides, as controls generated from the table of settings.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "techniques/technique.h"
#include "view/panels.h"

namespace lightgrid {
namespace {

// Returns the choice made in this frame, or null. `about`: a tooltip of each name.
template <typename Names, typename About>
const char* combo(const char* id, const std::string& current, const Names& names, const About& about) {
  const char* chosen = nullptr;
  ImGui::SetNextItemWidth(-1);
  const bool open = ImGui::BeginCombo(id, current.c_str(), ImGuiComboFlags_HeightLarge);
  if (!open) tooltip(about(current));
  if (!open) return nullptr;
  for (const auto& name : names) {
    const std::string text = name;
    if (ImGui::Selectable(text.c_str(), text == current)) chosen = &name[0];
    tooltip(about(text));
  }
  ImGui::EndCombo();
  return chosen;
}

std::string nothing(const std::string&) { return ""; }

std::string about_technique(const std::string& name) {
  const Technique& technique = find_technique(name);
  return fmt::format("{}: {}. {}", name, technique.summary, technique.source);
}

void choose_technique(SideControls& side) {
  static const std::vector<const char*> names = [] {
    std::vector<const char*> all;
    for (const Technique* t : techniques()) all.push_back(t->name);
    return all;
  }();
  if (const char* chosen = combo("##technique", side.technique, names, about_technique)) side.technique = chosen;
}

void choose_setting(SideControls& side, const SettingHelp& setting) {
  const std::string id = "##" + setting.key;
  const char* chosen = combo(id.c_str(), to_strings(side.settings).at(json_key(setting.key)), setting.values,
                             nothing);
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
      const char* chosen = combo("##map", map_names()[int(side.map)], map_names(), nothing);
      if (chosen) side.map = parse_map(chosen);
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
