#include "frontier/plots.h"

#include <algorithm>

#include "frontier/answer_steps.h"
#include "frontier/plot_parts.h"
#include "report/report.h"

namespace lightgrid {
namespace {

// Those of report/page/elements.js.
constexpr const char* palette[] = {"#3b6fb6", "#d9822b", "#3f9b58", "#b5475d", "#7d5bb0",
                                   "#2a9aa0", "#a5762c", "#c25aa0", "#6b8e23", "#4e5fa8",
                                   "#8c564b", "#17a2d4", "#c7a008", "#e2664f"};

struct FamilyMarker {
  const char *family, *marker;
};
constexpr FamilyMarker family_markers[] = {
    {"deferred", "M-4.5,-4.5h9v9h-9z"},
    {"clustered", "M0,-5.5L5.2,4.2H-5.2z"},
    {"lidr", "M0,-6L6,0L0,6L-6,0z"},
    {"world", "M-6,-2.5h12v5h-12z"},
    {"voxel", "M-5,-3L0,-6L5,-3V3L0,6L-5,3z"},
    {"visibility", "M-2,-5.5h4v3.5h3.5v4h-3.5v3.5h-4v-3.5h-3.5v-4h3.5z"},
};

}  // namespace

std::vector<TechniqueStyle> technique_styles(const FrontierAnswer& answer) {
  std::vector<TechniqueStyle> styles;
  for (const FrontierRecord& r : answer.part.records) {
    const std::string& name = r.point.technique;
    if (std::any_of(styles.begin(), styles.end(),
                    [&](const TechniqueStyle& s) { return s.technique == name; }))
      continue;
    const std::string family = name.substr(0, name.find('_'));
    const auto marker = std::find_if(std::begin(family_markers), std::end(family_markers),
                                     [&](const FamilyMarker& m) { return m.family == family; });
    styles.push_back({name, palette[styles.size() % std::size(palette)],
                      marker == std::end(family_markers) ? circle_marker : marker->marker});
  }
  return styles;
}

std::vector<Plot> plots_of(const FrontierAnswer& answer) {
  const std::vector<TechniqueStyle> styles = technique_styles(answer);
  std::vector<Plot> plots;
  for (const std::string& scene : scenes_of(answer)) {
    add_front_plot(answer, scene, styles, plots);
    for (const TechniqueStyle& style : styles) add_break_even_plot(answer, scene, style.technique, plots);
    add_growth_plots(answer, scene, styles, plots);
  }
  std::vector<std::string> names;
  for (const Plot& plot : plots) names.push_back(plot.name);
  names = file_stems(names);
  for (size_t i = 0; i < plots.size(); ++i) plots[i].name = names[i];
  return plots;
}

std::string svg_file(const Plot& plot) {
  const std::string style = R"(<style>
svg { --ink: #1c1b19; --quiet: #66625b; --line: #dedad3; --accent: #b4540a; --good: #1f7a3d; background: #ffffff; font-family: system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { svg { --ink: #eeebe6; --quiet: #a39d93; --line: #3a3733; --accent: #f2a154; --good: #6fcf8d; background: #1f1d1b; } }
text { fill: var(--quiet); font-size: 12px; }
.rule { stroke: var(--line); }
.zero { stroke-dasharray: 3 3; }
.wins { fill: var(--good); opacity: 0.55; }
.interval { stroke: var(--ink); }
.machine { stroke: var(--accent); stroke-width: 1.5; }
.machine-name { fill: var(--accent); }
</style>
)";
  std::string text = plot.svg;
  text.insert(text.find("viewBox"), "xmlns=\"http://www.w3.org/2000/svg\" ");
  return text.insert(text.find('\n') + 1, style + "<title>" + svg_escaped(plot.title) + "</title>\n");
}

}  // namespace lightgrid
