// The plan of each side's frame: the effects that this view needs, with witnesses, and the effects left out.
#include <limits>

#include <fmt/format.h>
#include <imgui.h>

#include "view/panels.h"

namespace lightgrid {
namespace {

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

}  // namespace lightgrid
