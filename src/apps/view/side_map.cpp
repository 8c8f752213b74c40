#include "view/side_map.h"

#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "compare/runs.h"
#include "frames/frame_culler.h"
#include "oracle/position.h"
#include "passes/read_back.h"
#include "plan/settings/samples.h"

namespace lightgrid::app {
using namespace lab;

PixelInspection lights_at(const ListedFrame& listed, PicturePixel pixel) {
  const CapturedFrame& frame = listed.frame;
  const ListedLights& lists = listed.lists;
  const int row = flipped_row(pixel.y, frame.view.height);
  PixelInspection result{.x = pixel.x, .y = row};
  const size_t place = size_t(row) * frame.view.width + pixel.x;
  result.covered = frame.depth[place] > 0;
  if (!result.covered) return result;
  const glm::dvec3 position = position_from_depth(frame.view, pixel.x, row, frame.depth[place]);
  result.distance_m = -position.z;
  const uint32_t cell = lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[place];
  const auto first = lists.indices.begin() + ptrdiff_t(lists.first[cell]);
  const std::set<uint32_t> found(first, first + lists.count[cell]);
  for (uint32_t i = 0, local = 0; i < frame.lights.size(); ++i) {
    if (frame.lights[i].type == LightType::directional) continue;
    const ViewLight& light = listed.lights[local];
    LightVerdict verdict{.index = local, .light = int(i), .radius_m = light.radius_m};
    verdict.listed = found.contains(local++);
    verdict.lit = is_lit(light, position);
    verdict.distance_m = glm::length(light.position - position);
    if (verdict.listed || verdict.lit) result.lights.push_back(verdict);
  }
  const auto rank = [](const LightVerdict& l) { return std::tuple(!l.lit, l.listed, l.distance_m); };
  std::ranges::stable_sort(result.lights, {}, rank);
  return result;
}

std::optional<PixelInspection> inspect_pixel(TechniqueRun& run, const CapturedFrame& frame,
                                             PicturePixel pixel) {
  RenderView& v = run.view();
  if (!v.plan.lists.light_grid) return {};
  const Settings& settings = v.plan.settings;
  FrameCuller culler(*v.renderer.cl, *v.renderer.kernels, frame, settings, run.technique().needs);
  culler.run();
  return inspect_pixel(frame, culler.grid(), culler.intervals(), settings, pixel);
}

void add_margins(PixelInspection& lights, const PixelInspection& inspection, int max_dropped) {
  for (const LightVerdict& verdict : inspection.lights) {
    const auto known = std::ranges::find(lights.lights, verdict.light, &LightVerdict::light);
    if (known != lights.lights.end()) {
      known->test = verdict.test;
      known->margin_m = verdict.margin_m;
    } else if (max_dropped-- > 0) {
      lights.lights.push_back(verdict);
      lights.lights.back().listed = lights.lights.back().lit = false;
    }
  }
}

static std::string name_of(int light, const Scene& scene) {
  const std::string& name = scene.lights[size_t(light)].name;
  return name.empty() ? fmt::format("light {}", light) : name;
}

std::array<std::string, 3> lines_of(const LightVerdict& verdict, const Scene& scene) {
  const char* lost = verdict.lit && !verdict.listed ? " LOST" : "";
  std::string decided;
  if (verdict.test == "empty") {
    decided = "dropped: no surface in its cell";
  } else if (!verdict.test.empty()) {
    decided = fmt::format("{} by {} {:+.3f} m", verdict.listed ? "kept" : "dropped", verdict.test,
                          verdict.margin_m);
  }
  return {fmt::format("{} {:.2f} of {:.2f} m{}", name_of(verdict.light, scene), verdict.distance_m,
                      verdict.radius_m, lost),
          decided, verdict.shadow ? shadow_words(*verdict.shadow, scene.lights[size_t(verdict.light)]) : ""};
}

std::array<std::string, 2> lines_of(const DirectionalShadow& verdict, const Scene& scene) {
  return {name_of(verdict.light, scene), shadow_words(verdict.shadow, scene.lights[size_t(verdict.light)])};
}

void put_hidden_first(PixelInspection& pixel) {
  std::ranges::stable_sort(pixel.lights, {}, [](const LightVerdict& l) {
    if (l.lit && !l.listed) return 0;
    if (!l.shadow) return 3;
    return l.shadow->leaked() || l.shadow->acned() ? 1 : l.shadow->truth.sight == Sight::hidden ? 2 : 3;
  });
}

std::string shadows_at_pixel(const PixelInspection& pixel) {
  size_t cast = pixel.directional_shadows.size();
  auto hidden = std::ranges::count_if(pixel.directional_shadows, [](const DirectionalShadow& d) {
    return d.shadow.truth.sight == Sight::hidden;
  });
  for (const LightVerdict& light : pixel.lights) {
    if (!light.shadow) continue;
    ++cast;
    hidden += light.shadow->truth.sight == Sight::hidden;
  }
  return cast ? fmt::format("{} of {} that cast are hidden", hidden, cast) : "";
}

static bool casts(const Scene& scene, const std::optional<int>& light) {
  if (light) return scene.lights[size_t(*light)].casts_shadow;
  return std::ranges::any_of(scene.lights, &Light::casts_shadow);
}

// The counts of a map; `shadows` were counted.
static std::vector<uint32_t> counts_of(SideMap map, const LitPairs& pairs) {
  const std::vector<uint32_t>* counts = map == SideMap::listed   ? &pairs.listed_of_pixel
                                        : map == SideMap::lit    ? &pairs.lit_of_pixel
                                        : map == SideMap::lost   ? &pairs.lost_of_pixel
                                        : map == SideMap::hidden ? &pairs.hidden_of_pixel
                                        : map == SideMap::leaked ? &pairs.leaked_of_pixel
                                                                 : &pairs.acned_of_pixel;
  // Without a light that casts nothing is hidden.
  return counts->empty() ? std::vector<uint32_t>(pairs.listed_of_pixel.size()) : *counts;
}

static std::string legend_of(SideMap map, const LitPairs& pairs, bool shadows) {
  const std::string seen = shadows ? " and seen" : "";
  switch (map) {
    case SideMap::listed:
      return fmt::format("{} pairs listed", pairs.listed);
    case SideMap::lit:
    case SideMap::lost:
      return fmt::format("{} pairs lit{}, {} of them lost", pairs.lit, seen, pairs.lost);
    default:
      if (!shadows) return "no light casts a shadow";
      return fmt::format("{} pairs hidden, {} undecided; {} leaked, {} acned", pairs.hidden, pairs.either,
                         pairs.leaked, pairs.acned);
  }
}

void MapOfSide::show_counts(const MapChoice& wanted, Side& side, bool wait) {
  const bool shadows = wanted.map != SideMap::listed && casts(occlusion_.scene(), wanted.light);
  const CountChoice choice{side.pictures(), wanted.light, shadows};
  const LitPairs* pairs = count_.result(choice, wait);
  if (!pairs && !count_.running()) {
    count_.start(side.run(), choice);
    pairs = count_.result(choice, wait);
  }
  if (!pairs) return;
  const std::vector<uint32_t> counts = counts_of(wanted.map, *pairs);
  const bool fault =
      wanted.map == SideMap::lost || wanted.map == SideMap::leaked || wanted.map == SideMap::acned;
  const uint32_t top = fault ? 1 : top_of_scale(counts);
  const std::string of =
      wanted.light ? name_of(*wanted.light, occlusion_.scene()) + " alone" : "lights a pixel";
  legend_ =
      fmt::format("{}, {}: {}", map_names()[size_t(wanted.map)], of, legend_of(wanted.map, *pairs, shadows));
  scale_ = {&viridis_ramp(), top > 1 ? "1" : "", top > 3 ? fmt::format("{}", top / 2) : "",
            fmt::format("{} or more", top)};
  put(heat_map(side.width(), side.height(), counts, top), wanted, side);
}

void MapOfSide::show_edges(const MapChoice& wanted, Side& side) {
  SampleFigures figures;
  if (const auto& read = side.run().frame().sample_figures) {
    figures = read();
    legend_ = fmt::format("edges, surfaces a pixel: {} pixels with several; {} of {} samples shaded",
                          figures.edge_pixels, figures.shadings, figures.covered);
  } else {
    figures.surfaces.resize(size_t(side.width()) * size_t(side.height()));
    legend_ = side.run().view().plan.settings[setting::samples] > 1
                  ? "edges: OpenGL does not tell which pixels have several surfaces"
                  : "edges: one sample a pixel sees one surface";
  }
  const uint32_t top = std::max(top_of_scale(figures.surfaces), 2u);
  scale_ = {&viridis_ramp(), "1", "", fmt::format("{} or more", top)};
  put(heat_map(side.width(), side.height(), figures.surfaces, top), wanted, side);
}

void MapOfSide::show_difference(const MapChoice& wanted, Side& side, const Image& reference) {
  Image image;
  RenderView& v = side.run().view();
  read_back(v, side.run().frame().image, image);
  const ImageError error = compare_images(image, reference);
  legend_ =
      fmt::format("difference from forward over its brightest: black equal, greatest {:.2g}", error.max_rel);
  scale_ = {&difference_ramp(), "1e-7", "3e-4", "1"};
  put(difference_image(image, reference), wanted, side);
}

void MapOfSide::put(const Image& image, const MapChoice& map, const Side& side) {
  if (image.width != width_ || image.height != height_) {
    width_ = image.width;
    height_ = image.height;
    texture_ = make_texture_2d(GL_RGBA32F, width_, height_);
  }
  glTextureSubImage2D(texture_.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, image.pixels.data());
  shown_ = map;
  shown_picture_ = side.pictures();
}

const Image& ReferencePicture::draw(const View& view, const Settings& settings) {
  if (run_ && same_model(model_, settings)) {
    run_->look(view);
  } else {
    model_ = with_samples(with_model({}, settings), 1);
    const EveryLight forward = every_light_technique(renderer_);
    run_ = std::make_unique<TechniqueRun>(renderer_, gpu_, view, model_, *forward.technique);
  }
  run_->run_frame(true);
  return run_->image();
}

}  // namespace lightgrid::app
