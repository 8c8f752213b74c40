#include "inspect/inspect.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/write_file.h"
#include "frames/frame_lists.h"
#include "measures/metrics.h"
#include "oracle/seen_pairs.h"

namespace lightgrid::lab {

InspectionMaps inspection_maps(const CapturedFrame& frame, const FrameGrid& grid,
                               const PairShadows* shadows) {
  const std::vector<float> depth = covered_depth(frame);
  LitPairs pairs = count_pairs(frame.view, depth, local_lights(frame), listed_lights(frame, grid), shadows);
  InspectionMaps maps;
  maps.pairs = {pairs.listed, pairs.lit, pairs.lost, pairs.wrong};
  if (shadows) {
    maps.pairs.shadows = {pairs.leaked, pairs.acned, pairs.either, shadows->truth.pixels()};
    maps.leaked = std::move(pairs.leaked_of_pixel);
    maps.acned = std::move(pairs.acned_of_pixel);
  }
  maps.covered = uint64_t(std::count_if(depth.begin(), depth.end(), [](float d) { return d > 0; }));
  maps.listed = std::move(pairs.listed_of_pixel);
  maps.lost = std::move(pairs.lost_of_pixel);
  maps.top = top_of_scale(maps.listed);
  for (size_t i = 0; i < depth.size(); ++i) {
    maps.false_positives.push_back(maps.listed[i] -
                                   std::min(maps.listed[i], pairs.lit_of_pixel[i] - maps.lost[i]));
  }
  return maps;
}

std::string inspection_json(const CapturedFrame& frame, const InspectionMaps& maps, const FrameGrid& grid) {
  const PairCounts& p = maps.pairs;
  const nlohmann::json out = {{"scene", frame.name},
                              {"size", {frame.view.width, frame.view.height}},
                              {"settings", settings_json(grid.settings)},
                              {"pairs", pairs_json(p)},
                              {"covered_pixels", maps.covered},
                              {"scale_top", maps.top}};
  return json_text(out);
}

void write_inspection_maps(const std::filesystem::path& folder, const CapturedFrame& frame,
                           const InspectionMaps& maps) {
  make_folder(folder);
  struct File {
    const char* name;
    const std::vector<uint32_t>* counts;
    uint32_t top;
  };
  std::vector<File> files = {{"listed.png", &maps.listed, maps.top},
                             {"false_positives.png", &maps.false_positives, maps.top},
                             {"lost.png", &maps.lost, 1}};
  if (maps.pairs.shadows)
    files.insert(files.end(), {{"leaked.png", &maps.leaked, 1}, {"acned.png", &maps.acned, 1}});
  const int width = frame.view.width, height = frame.view.height;
  parallel_for(int(files.size()), [&](int i) {
    const File& file = files[size_t(i)];
    save_png_as_is(folder / file.name, heat_map(width, height, *file.counts, file.top));
  });
}

}  // namespace lightgrid::lab
