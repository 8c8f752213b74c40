#include <fmt/format.h>

#include <algorithm>

#include "which/which.h"

namespace lightgrid::lab {
namespace {

constexpr size_t max_points = 8;

// The points with an error that may be within the bound, the fastest first.
std::vector<ChosenPoint> fastest_points(const WhichJob& job, const WhichAnswer& answer) {
  std::vector<const WhichPoint*> timed;
  for (const WhichPoint& p : answer.points) {
    if (p.ms) timed.push_back(&p);
  }
  std::ranges::stable_sort(timed, {}, [](const WhichPoint* p) { return p->ms->value; });
  std::vector<ChosenPoint> points;
  for (const WhichPoint* p : timed) {
    const auto found = std::ranges::find(job.points, p->point.label, &ChosenPoint::label);
    if (found != job.points.end() && points.size() < max_points) points.push_back(*found);
  }
  return points;
}

struct Variant {
  std::string what;
  SceneChoice choice;
};

std::vector<Variant> variants(const SceneChoice& choice, const WhichAnswer& answer) {
  std::vector<Variant> all;
  for (const int factor : {2, 4}) {
    if (answer.lights == 0 || !choice.lights_file.empty() || answer.lights > max_lights / factor) continue;
    SceneChoice varied = choice;
    varied.lights = factor * answer.lights;
    varied.ranges_of = answer.lights;
    all.push_back({fmt::format("{} scattered lights", varied.lights), varied});
  }
  SceneChoice larger = choice;
  larger.size = fmt::format("{}x{}", 2 * answer.size.width, 2 * answer.size.height);
  all.push_back({larger.size, larger});
  return all;
}

}  // namespace

std::vector<WhichChange> changes_of(Renderer& renderer, const SceneChoice& choice, const WhichJob& job,
                                    const WhichAnswer& answer) {
  WhichJob among_fastest = job;
  among_fastest.before_s = 0;
  among_fastest.points = fastest_points(job, answer);
  std::vector<WhichChange> changes;
  if (among_fastest.points.empty()) return changes;
  for (const Variant& v : variants(choice, answer)) {
    among_fastest.progress = [&](double done, const std::string& step) {
      if (job.progress) job.progress(done, v.what + ": " + step);
    };
    changes.push_back({v.what, which(renderer, v.choice, among_fastest)});
  }
  return changes;
}

}  // namespace lightgrid::lab
