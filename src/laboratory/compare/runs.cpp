#include "compare/runs.h"

#include <algorithm>
#include <tuple>

#include "measures/words.h"
#include "plan/settings/grid.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"

namespace lightgrid::lab {
namespace {

// The settings of exact shadows that decide which share of a light is hidden.
auto shares_of(const Settings& s) {
  const bool spheres = s[setting::shadow_rays] > 1 && s[setting::shadow_source_m] > 0;
  return std::tuple(spheres ? s[setting::shadow_rays] : 1, spheres ? s[setting::shadow_source_m] : 0.0,
                    s[setting::shadow_pick]);
}

Settings with_reference_shadows(const Compared& c, Settings settings) {
  settings = with_exact_shadows(std::move(settings));
  if (c.every_light.point_shadows) {
    settings.set(setting::shadow_rays, 1);
    settings.set(setting::shadow_pick, 0);
  }
  return settings;
}

// A run for the reference alone, with the settings that all contestants share but their shadows.
std::unique_ptr<TechniqueRun> make_own_run(const Compared& c) {
  Settings common =
      c.contestants.empty() ? Settings{} : with_reference_shadows(c, c.contestants.front().settings);
  common = with_samples(std::move(common), 1);
  if (c.every_light.chosen_lights) common.set(setting::lights, ShadedLights::all);
  return std::make_unique<TechniqueRun>(c.renderer, c.gpu, c.view, common, *c.every_light.technique);
}

bool draws_reference(const ContestantRun& entry, const Compared& c) {
  return entry.run && c.every_light.is(*entry.run);
}

std::string time_in_words(double ms) {
  return ms < 120e3 ? fmt::format("{:.0f} s", ms / 1000) : fmt::format("{:.0f} min", ms / 60e3);
}

}  // namespace

EveryLight every_light_technique(const Renderer& renderer, const std::vector<Contestant>& contestants) {
  const bool differ = std::ranges::any_of(contestants, [&](const Contestant& c) {
    return shares_of(c.settings) != shares_of(contestants.front().settings);
  });
  if (renderer.gl) return {&find_technique("forward"), false, differ};
  return {&find_technique("visibility"), true, differ};
}

std::unique_ptr<TechniqueRun> make_run_of_every_light(const Compared& c, Settings settings,
                                                      bool own_surfaces) {
  settings.set(setting::lights, ShadedLights::all);
  return std::make_unique<TechniqueRun>(c.renderer, c.gpu, c.view, with_reference_shadows(c, settings),
                                        find_technique(own_surfaces ? "visibility" : "forward"));
}

std::vector<ContestantRun> make_entries(const Compared& c) {
  std::vector<ContestantRun> entries;
  const auto shared = std::make_shared<TargetPool>();
  for (const Contestant& contestant : c.contestants) {
    ContestantRun& entry = entries.emplace_back(ContestantRun{&contestant, {}, {}});
    const auto pool = c.every_light.is(*contestant.technique, contestant.settings) ? nullptr : shared;
    entry.attempt([&] {
      entry.run = std::make_unique<TechniqueRun>(c.renderer, c.gpu, c.view, contestant.settings,
                                                 *contestant.technique, pool);
    });
  }
  return entries;
}

TechniqueRun& Reference::run() const {
  return std::visit([](const auto& one) -> TechniqueRun& { return *one.run; }, kind);
}

std::vector<uint32_t> Reference::sampled_pixels() const {
  return pixels_of(std::get<SampledRun>(kind).blocks, {image.width, image.height});
}

Reference choose_reference(const Compared& c, std::vector<ContestantRun>& entries) {
  const CompareOptions& options = c.options;
  const bool automatic = options.reference == ReferencePixels::automatic;
  const size_t lights = c.gpu.scene().lights.size();
  if (!c.every_light.technique->needs.surfaces.opengl) {
    if (options.reference == ReferencePixels::sampled)
      throw machine_error("reference sampled: shades with OpenGL; {}", c.renderer.why_no_gl);
    return {};
  }
  if (options.reference == ReferencePixels::full ||
      (automatic && is_quick_for_forward(c.view, lights, options.max_reference_ms)))
    return {};
  const auto found = std::ranges::find_if(entries, [&](const auto& e) { return draws_reference(e, c); });
  const bool is_contestant = found != entries.end();
  std::unique_ptr<TechniqueRun> own = is_contestant ? nullptr : make_own_run(c);
  TechniqueRun& run = is_contestant ? *found->run : *own;

  c.tell(0, "estimating the reference's time");
  std::vector<PixelBlock> blocks = shuffled_blocks(c.view.grid(), options.seed);
  const double frame_ms = automatic ? estimate_forward_ms(run.view(), blocks) : 0;
  if (automatic &&
      frame_ms * (is_contestant ? options.warmup + options.frames + 1 : 1) <= options.max_reference_ms)
    return {OwnRun{std::move(own)}};

  const size_t most = sample_size(lights), a_block = PixelBlock::side * PixelBlock::side;
  blocks.resize(std::min(blocks.size(), (most + a_block - 1) / a_block));
  const size_t pixels = pixels_of(blocks, c.view.grid()).size(), all = c.view.grid().pixels();
  const std::string why = automatic ? fmt::format("every light at every pixel would take about {} a frame",
                                                  time_in_words(frame_ms))
                                    : std::string("asked for");
  const std::string what = fmt::format("{} at {} of {} pixels ({}; reference full shades all)",
                                       c.every_light.name(), with_commas(pixels), with_commas(all), why);
  if (options.notice) options.notice("the reference is " + what);
  for (ContestantRun& entry : entries) {
    if (!draws_reference(entry, c)) continue;
    if (!own) own = std::move(entry.run);
    entry.run.reset();
    entry.refusal = machine_error("it is the reference: {}", what);
  }
  return {SampledRun{std::move(own), std::move(blocks)}};
}

void draw_reference(Reference& reference, const Compared& c, const std::vector<ContestantRun>& entries) {
  const auto tell = [&] { c.tell(0.8, "reference: " + c.every_light.name()); };
  if (const auto* sample = std::get_if<SampledRun>(&reference.kind)) {
    tell();
    return render_forward_at(sample->run->view(), sample->blocks, reference.image);
  }
  const auto found = std::ranges::find_if(entries, [&](const auto& e) { return draws_reference(e, c); });
  if (found != entries.end()) {
    reference.kind = RunOfContestant{size_t(found - entries.begin()), found->run.get()};
    return;
  }
  tell();
  OwnRun& own = std::get<OwnRun>(reference.kind);
  if (!own.run) own.run = make_own_run(c);
  own.run->run_frame();
}

}  // namespace lightgrid::lab
