#include "report/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "measures/relative_frames.h"
#include "measures/words.h"
#include "report/charts.h"
#include "report/speedup_words.h"

namespace lightgrid::lab {
namespace {

struct Place {
  std::string view;
  std::string note;  // "1.31 times"
};

struct Tally {
  std::string name;
  std::vector<Place> places;
};

Tally& tally_of(std::vector<Tally>& tallies, const std::string& name) {
  for (Tally& tally : tallies) {
    if (tally.name == name) return tally;
  }
  return tallies.emplace_back(Tally{name, {}});
}

// Names of the views: only what distinguishes them.
std::vector<std::string> short_views(const std::vector<ReportView>& views) {
  const CompareReport& first = views.front().report;
  const auto lights = [](const CompareReport& r) { return r.rows.empty() ? 0 : r.rows.front().lights_total; };
  std::vector<std::string> scenes;
  for (const ReportView& view : views) scenes.push_back(short_scene(view.report));
  // Scenes with lights of their own differ in number too, which adds no information.
  bool many_scenes = false, many_sizes = false, many_lights = false;
  for (size_t i = 0; i < views.size(); ++i) {
    const CompareReport& r = views[i].report;
    many_scenes |= scenes[i] != scenes[0];
    many_sizes |= r.width != first.width || r.height != first.height;
    for (size_t j = 0; j < i; ++j)
      many_lights |= scenes[j] == scenes[i] && lights(views[j].report) != lights(r);
  }
  std::vector<std::string> names;
  for (size_t i = 0; i < views.size(); ++i) {
    const CompareReport& r = views[i].report;
    std::string name = many_scenes || (!many_sizes && !many_lights) ? scenes[i] : "";
    if (many_sizes) name += fmt::format("{}{} × {}", name.empty() ? "" : " at ", r.width, r.height);
    if (many_lights) name += fmt::format("{}{} lights", name.empty() ? "" : " with ", with_commas(lights(r)));
    names.push_back(name);
  }
  return names;
}

// The first few; the page's table has all.
std::string places_in_words(const Tally& tally) {
  constexpr size_t most = 6;
  std::vector<std::string> words;
  for (const Place& place : tally.places) {
    words.push_back(place.note.empty() ? place.view : fmt::format("{} ({})", place.view, place.note));
  }
  const size_t more = words.size() > most ? words.size() - most + 1 : 0;
  if (more) words.resize(most - 1);
  return fmt::format("{}{}", fmt::join(words, ", "), more ? fmt::format(" and {} views more", more) : "");
}

std::string count_in_words(size_t count, size_t of) {
  return count == of ? (of == 2 ? "both views" : fmt::format("all {} views", of))
                     : fmt::format("{} of {} views", count, of);
}

void sort_by_count(std::vector<Tally>& tallies) {
  std::stable_sort(tallies.begin(), tallies.end(),
                   [](const Tally& a, const Tally& b) { return a.places.size() > b.places.size(); });
}

std::string winners_sentence(const std::vector<ReportView>& views, const std::vector<std::string>& names) {
  std::vector<Tally> tallies;
  for (size_t i = 0; i < views.size(); ++i) {
    const RunResult* row = fastest_exact(views[i].report);
    if (row) tally_of(tallies, row_name(views[i].report, *row)).places.push_back({names[i], ""});
  }
  if (tallies.empty()) return "No technique is exact in any view.";
  sort_by_count(tallies);
  std::vector<std::string> parts;
  for (const Tally& t : tallies) {
    const bool everywhere = t.places.size() == views.size();
    parts.push_back(fmt::format("{} in {}{}", t.name, count_in_words(t.places.size(), views.size()),
                                everywhere ? "" : " (" + places_in_words(t) + ")"));
  }
  return fmt::format("The fastest exact technique is {}.", fmt::join(parts, ", "));
}

// "faster" rows that are not exact, among those that `counts` accepts; with their speed relative to the
// fastest exact one.
template <typename Counts>
std::string faster_sentence(const std::vector<ReportView>& views, const std::vector<std::string>& names,
                            const char* but, const Counts& counts) {
  std::vector<Tally> tallies;
  for (size_t i = 0; i < views.size(); ++i) {
    const RunResult* best = fastest_exact(views[i].report);
    for (const RunResult& row : views[i].report.rows) {
      if (!best || row.frame_ms.runs == 0 || !counts(row) || row.frame_ms.median >= best->frame_ms.median)
        continue;
      tally_of(tallies, row_name(views[i].report, row))
          .places.push_back(
              {names[i], fmt::format("{} times{}", short_number(best->frame_ms.median / row.frame_ms.median),
                                     row.overflow ? ", by design" : "")});
    }
  }
  if (tallies.empty()) return "";
  sort_by_count(tallies);
  std::vector<std::string> parts;
  for (const Tally& t : tallies) parts.push_back(fmt::format("{} in {}", t.name, places_in_words(t)));
  constexpr size_t most = 4;  // the page's table has all
  const size_t more = parts.size() > most ? parts.size() - most : 0;
  if (more) parts.resize(most);
  return fmt::format("Faster than it, but {}: {}{}.", but, fmt::join(parts, "; "),
                     more ? fmt::format("; and {} more", more) : "");
}

// The fastest exact row of a technique; null if there is none.
const RunResult* best_of(const CompareReport& report, const std::string& technique) {
  return fastest(report, [&](const RunResult& row) { return row.technique == technique && is_exact(row); });
}

}  // namespace

std::string faster_where(const std::vector<ReportView>& views, const std::string& a, const std::string& b) {
  if (views.empty()) return "";
  const auto names = short_views(views);
  Tally of_a{a, {}}, of_b{b, {}}, of_none{"", {}};
  size_t both = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    const RunResult *x = best_of(views[i].report, a), *y = best_of(views[i].report, b);
    if (!x || !y) continue;
    ++both;
    const RunResult &fast = x->frame_ms.median <= y->frame_ms.median ? *x : *y, &slow = &fast == x ? *y : *x;
    if (!relative_frames(times_of(fast), times_of(slow)).is_faster()) {
      of_none.places.push_back({names[i], ""});
    } else {
      const double ratio = slow.frame_ms.median / fast.frame_ms.median;
      (&fast == x ? of_a : of_b).places.push_back({names[i], short_number(ratio) + " times"});
    }
  }
  if (!both) return "";
  std::vector<std::string> parts;
  if (of_a.places.size())
    parts.push_back(fmt::format("{} is faster than {} in {}", a, b, places_in_words(of_a)));
  if (of_b.places.size())
    parts.push_back(fmt::format("{} is faster than {} in {}", b, a, places_in_words(of_b)));
  if (of_none.places.size())
    parts.push_back(fmt::format("{} and {} do not differ clearly in {}", a, b, places_in_words(of_none)));
  return fmt::format("{}.", fmt::join(parts, "; "));
}

std::vector<std::string> overview_sentences(const std::vector<ReportView>& views) {
  if (views.empty()) return {};
  const auto names = short_views(views);
  std::vector<std::string> sentences = {winners_sentence(views, names)};
  for (const std::string& sentence :
       {faster_sentence(
            views, names, "lossy",
            [](const RunResult& row) { return passes_gates(row) && light_error(row) && !is_exact(row); }),
        faster_sentence(views, names, "with a gate failed",
                        [](const RunResult& row) { return !passes_gates(row); }),
        faster_where(views, "forward_plus", "clustered")}) {
    if (!sentence.empty()) sentences.push_back(sentence);
  }
  const CompareReport& first = views.front().report;
  if (const std::string kept = kept_in_words(first); !kept.empty())
    sentences.push_back(fmt::format(
        "Numbers of lights: {} (--keep {} for {}).", kept, first.lights_kept == "range" ? "overlap" : "range",
        first.lights_kept == "range" ? "as many lights per point" : "equal ranges"));
  if (const std::string software = software_opengl_in_words(first); !software.empty())
    sentences.push_back(software + ".");
  return sentences;
}

}  // namespace lightgrid::lab
