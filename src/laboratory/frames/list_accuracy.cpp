#include "frames/list_accuracy.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "measures/results.h"

namespace lightgrid::lab {
namespace {

nlohmann::json row_json(const AccuracyRow& row) {
  const ListAccuracy& a = row.accuracy;
  return {{"compared", row.compared},
          {"pairs", {{"listed", a.listed}, {"lit", a.lit}, {"lost", a.lost}, {"perfect", a.perfect}}},
          {"tiles", {{"lit", a.tiles_lit}, {"in_vain", a.tiles_unlit}, {"p99", a.p99}, {"worst", a.worst}}}};
}

double over_lit(uint64_t pairs, const ListAccuracy& a) { return a.lit ? double(pairs) / double(a.lit) : 0; }

}  // namespace

LitBlocks find_lit_blocks(const CapturedFrame& frame) {
  return find_lit_blocks(frame.view, covered_depth(frame), local_lights(frame));
}

std::string accuracy_line(const AccuracyRow& row) {
  const ListAccuracy& a = row.accuracy;
  return fmt::format(
      "{}: listed / lit {:.3f} (tiles: p99 {:.2f}, worst {:.2f}), perfect lists {:.3f}, {} lost\n",
      row.compared, over_lit(a.listed, a), a.p99, a.worst, over_lit(a.perfect, a), a.lost);
}

std::string accuracy_json(const CapturedFrame& frame, const Settings& settings,
                          const std::vector<AccuracyRow>& rows) {
  nlohmann::json out = {{"scene", frame.name},
                        {"size", {frame.view.width, frame.view.height}},
                        {"settings", settings_json(to_strings(settings))},
                        {"rows", nlohmann::json::array()}};
  for (const AccuracyRow& row : rows) out["rows"].push_back(row_json(row));
  return json_text(out);
}

}  // namespace lightgrid::lab
