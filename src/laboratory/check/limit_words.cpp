#include "check/limit_words.h"

#include <fmt/format.h>

namespace lightgrid::lab {
namespace {

std::string counted_in(const LimitResult& result) {
  const EngineLimit& limit = *result.limit;
  if (limit.scope == LimitScope::distance)
    return fmt::format("{} lights beyond {} m", result.worst.counted, limit.most);
  const char* kind = *result.worst.kind ? result.worst.kind : "lights";
  return fmt::format("{} {}, room for {}", result.worst.counted,
                     limit.scope == LimitScope::pool ? "entries" : kind, result.most);
}

std::string places_of(size_t count, LimitScope scope) {
  const char* names[] = {"view", "views", "mesh", "meshes", "cell", "cells"};
  const int kind = scope == LimitScope::mesh ? 2 : scope == LimitScope::cell ? 4 : 0;
  return fmt::format("{} {}", count, names[kind + (count != 1)]);
}

// Many files name neither nodes nor lights.
std::string numbered(const char* kind, int number, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} {} \"{}\"", kind, number, name);
}

}  // namespace

std::string words_of(const LimitPlace& place, const Scene& scene) {
  std::string words = fmt::format("frame {}", place.frame);
  if (place.instance >= 0)
    words += ", " + numbered("mesh", place.instance, scene.instances[size_t(place.instance)].name);
  if (place.cell.x >= 0) words += fmt::format(", cell {},{},{}", place.cell.x, place.cell.y, place.cell.z);
  return words;
}

std::string name_of_light(int light, const Scene& scene) {
  return numbered("light", light, scene.lights[size_t(light)].name);
}

std::string words_of(const DroppedLight& dropped, const EngineLimit& limit, const Scene& scene) {
  return fmt::format("{} ({}; {})", name_of_light(dropped.light, scene), words_of(dropped.first, scene),
                     places_of(dropped.places, limit.scope));
}

std::vector<std::string> sentences_of(const LimitResult& result, const Scene& scene, size_t max_lights) {
  const EngineLimit& limit = *result.limit;
  std::vector<std::string> lines;
  if (result.holds()) {
    lines.push_back(fmt::format("at most {}{}", counted_in(result),
                                result.worst.counted ? ", in " + words_of(result.worst, scene) : ""));
    return lines;
  }
  lines.push_back(fmt::format("over in {} of {} frames, in {}; most in {}: {}", result.frames_over,
                              result.frames, places_of(result.places_over, limit.scope),
                              words_of(result.worst, scene), counted_in(result)));
  std::vector<std::string> named;
  for (const DroppedLight& dropped : result.dropped) {
    if (named.size() == max_lights) break;
    named.push_back(words_of(dropped, limit, scene));
  }
  const size_t more = result.dropped.size() - named.size();
  lines.push_back(fmt::format("{} of {} lights {}: {}{}", result.dropped.size(), scene.lights.size(),
                              limit.scope == LimitScope::pool ? "may be dropped" : "dropped",
                              fmt::join(named, ", "), more ? fmt::format(" and {} more", more) : ""));
  if (limit.order == LimitOrder::unknown && limit.scope != LimitScope::pool)
    lines.push_back("the engine's choice is not public: listed are the lights that come last in the scene");
  if (result.holds_at > 0)
    lines.push_back(fmt::format("holds with all ranges at {:.0f} %", 100 * result.holds_at));
  lines.push_back(std::string("change: ") + limit.change);
  return lines;
}

}  // namespace lightgrid::lab
