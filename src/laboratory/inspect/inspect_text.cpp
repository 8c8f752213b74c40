// A pixel's inspection as a table and as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "inspect/inspect.h"
#include "measures/results.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

// The lights to show: all listed or lost ones, and the first dropped ones.
std::vector<const LightVerdict*> shown(const PixelInspection& pixel, int max_dropped) {
  std::vector<const LightVerdict*> rows;
  int dropped = 0;
  for (const LightVerdict& v : pixel.lights) {
    if (v.listed || v.lit || dropped < max_dropped) rows.push_back(&v);
    dropped += !v.listed && !v.lit;
  }
  return rows;
}

json number(double value) { return std::isfinite(value) ? json(value) : json(); }

// Metres, in eight columns.
std::string metres(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return std::abs(value) < 1e4 ? fmt::format("{:.3f}", value) : fmt::format("{:.1e}", value);
}

std::string far_text(double far_m) { return std::isinf(far_m) ? "infinity" : fmt::format("{:.3f} m", far_m); }

json margins_json(const LightVerdict& v) {
  if (v.test == "empty") return json();
  const TestMargins& m = v.margins;
  return {{"interval", number(m.interval)},
          {"planes", number(m.planes)},
          {"aabb", number(m.aabb)},
          {"sphere", number(m.sphere)},
          {"exact", number(m.exact)},
          {"cone", m.cone ? number(*m.cone) : json()},
          {"pieces", m.pieces ? number(*m.pieces) : json()}};
}

std::string row_text(const CapturedFrame& frame, const LightVerdict& v, size_t cells_pixels) {
  const Light& light = frame.lights[v.light];
  const TestMargins& m = v.margins;
  const bool empty = v.test == "empty";
  const auto margin = [&](double value) { return empty ? "-" : metres(value); };
  const char* verdict = v.listed ? "kept" : v.lit ? "LOST" : "dropped";
  return fmt::format(
      "{:>7}  {:<16.16} {:<5} {:>9} {:>9}  {:<7} {:<8} {:>9}  {:>9} {:>9} {:>9} {:>9} {:>9}  {:<4} {:>9}\n",
      v.light, light.name, name_of(light.type), metres(v.distance_m), metres(light.radius_m), verdict, v.test,
      margin(v.margin_m), margin(m.interval), margin(m.planes), margin(m.aabb), margin(m.exact),
      m.cone && !empty ? metres(*m.cone) : "-", v.lit ? "lit" : "-",
      fmt::format("{}/{}", v.lit_pixels, cells_pixels));
}

const char* name_of(Sight sight) {
  return sight == Sight::seen ? "seen" : sight == Sight::hidden ? "hidden" : "either";
}

std::string share_text(const glm::dvec3& share) {
  const bool grey = share.r == share.g && share.g == share.b;
  return grey ? fmt::format("{:.6f}", share.r)
              : fmt::format("({:.6f}, {:.6f}, {:.6f})", share.r, share.g, share.b);
}

std::string shadow_line(const CapturedFrame& frame, int number, const ShadowVerdict& shadow) {
  const Light& light = frame.lights[size_t(number)];
  return fmt::format("light {} \"{}\": {}\n", number, light.name, shadow_words(shadow, light));
}

json shadow_json(const ShadowVerdict& shadow) {
  const bool by_one = shadow.truth.sight == Sight::hidden && shadow.truth.by.instance >= 0;
  return {{"sight", name_of(shadow.truth.sight)},
          {"by", by_one ? json(shadow.by) : json()},
          {"instance", by_one ? json(shadow.truth.by.instance) : json()},
          {"triangle", by_one ? json(shadow.truth.by.triangle) : json()},
          {"away", by_one ? number(shadow.truth.distance_m) : json()},
          {"shaded_as_hidden", shadow.shaded_as_hidden}};
}

}  // namespace

std::string shadow_words(const ShadowVerdict& shadow, const Light& light) {
  const SightAnswer& truth = shadow.truth;
  std::string text = name_of(truth.sight);
  if (truth.sight == Sight::hidden && truth.by.instance < 0) text += " by blended surfaces together";
  if (truth.sight == Sight::hidden && truth.by.instance >= 0)
    text += fmt::format(" by node {} \"{}\" triangle {}, {:.3f} m from the {}", truth.by.instance, shadow.by,
                        truth.by.triangle, truth.distance_m, is_directional(light) ? "surface" : "light");
  if (truth.sight == Sight::either) text += ": its answer turns on rounding";
  if (shadow.leaked()) text += "; the frame shades it: LEAKED";
  if (shadow.acned()) text += "; the frame hides it: ACNED";
  return text;
}

std::string inspection_table(const CapturedFrame& frame, const PixelInspection& p, int max_dropped) {
  const auto rows = shown(p, max_dropped);
  const int height = frame.view.height;
  std::string text = fmt::format("pixel {},{}: depth {}, ", p.x, flipped_row(p.y, height), p.depth);
  text += p.covered ? fmt::format("{:.4f} m away along the view axis\n", p.distance_m) : "background\n";
  text += fmt::format("cell {},{} slice {}: pixels {},{} to {},{}, {} of them with a surface, ", p.cell_x,
                      p.cell_y, p.slice, p.x0, height - p.y1, p.x1 - 1, flipped_row(p.y0, height),
                      p.covered_pixels);
  text += p.near_m <= p.far_m ? fmt::format("{:.3f} m to {}\n", p.near_m, far_text(p.far_m))
                              : "no interval: it lists nothing\n";
  text += fmt::format("{} lights listed, {} lit at the pixel, {} lost; {} of {} dropped ones shown",
                      p.listed(), p.lit(), p.lost(), rows.size() - p.listed(), p.lights.size() - p.listed());
  if (p.directional)
    text += fmt::format("; {} directional lights reach every pixel and are in no list", p.directional);
  text += fmt::format(
      "\n\n{:>7}  {:<16} {:<5} {:>9} {:>9}  {:<7} {:<8} {:>9}  {:>9} {:>9} {:>9} {:>9} {:>9}  {:<4} {:>9}\n",
      "light", "name", "type", "away m", "radius m", "verdict", "by", "margin m", "interval", "planes",
      "aabb", "exact", "cone", "here", "lit px");
  for (const LightVerdict* v : rows) text += row_text(frame, *v, p.covered_pixels);
  std::string notes;
  for (const LightVerdict* v : rows) {
    if (v->share)
      notes += fmt::format("light {} \"{}\": {} of its intensity in this direction\n", v->light,
                           frame.lights[size_t(v->light)].name, share_text(*v->share));
    if (v->shadow) notes += shadow_line(frame, v->light, *v->shadow);
  }
  for (const DirectionalShadow& d : p.directional_shadows) notes += shadow_line(frame, d.light, d.shadow);
  return notes.empty() ? text : text + "\n" + notes;
}

std::string inspection_json(const CapturedFrame& frame, const PixelInspection& p, const FrameGrid& grid,
                            int max_dropped) {
  const auto rows = shown(p, max_dropped);
  json lights = json::array();
  for (const LightVerdict* v : rows) {
    const Light& light = frame.lights[v->light];
    lights.push_back({{"light", v->light},
                      {"index", v->index},
                      {"name", light.name},
                      {"type", name_of(light.type)},
                      {"distance", number(v->distance_m)},
                      {"radius", number(light.radius_m)},
                      {"listed", v->listed},
                      {"test", v->test},
                      {"margin", number(v->margin_m)},
                      {"margins", margins_json(*v)},
                      {"touches_cell", v->touches},
                      {"lit", v->lit},
                      {"lit_pixels", v->lit_pixels}});
    if (v->share) lights.back()["share"] = {v->share->r, v->share->g, v->share->b};
    if (v->shadow) lights.back()["shadow"] = shadow_json(*v->shadow);
  }
  json directional_shadows = json::array();
  for (const DirectionalShadow& d : p.directional_shadows) {
    directional_shadows.push_back(shadow_json(d.shadow));
    directional_shadows.back()["light"] = d.light;
  }
  const bool empty = !(p.near_m <= p.far_m);
  const json out = {{"scene", frame.name},
                    {"size", {frame.view.width, frame.view.height}},
                    {"settings", settings_json(grid.settings)},
                    {"pixel_from_top", {p.x, flipped_row(p.y, frame.view.height)}},
                    {"depth", number(p.depth)},
                    {"distance", number(p.distance_m)},
                    {"cell",
                     {{"x", p.cell_x},
                      {"y", p.cell_y},
                      {"slice", p.slice},
                      {"pixels_from_top", {p.x0, frame.view.height - p.y1, p.x1, frame.view.height - p.y0}},
                      {"covered_pixels", p.covered_pixels},
                      {"near", empty ? json() : number(p.near_m)},
                      {"far", empty ? json() : number(p.far_m)},
                      {"empty", empty}}},
                    {"listed", p.listed()},
                    {"lit", p.lit()},
                    {"lost", p.lost()},
                    {"directional", p.directional},
                    {"dropped_not_shown", p.lights.size() - rows.size()},
                    {"lights", lights},
                    {"directional_shadows", directional_shadows}};
  return json_text(out);
}

}  // namespace lightgrid::lab
