#include "compare/contestant_runs.h"

#include <algorithm>

#include "results/words.h"

namespace lightgrid {

EveryLight every_light_technique(const Renderer& renderer) {
  if (renderer.gl) return {&find_technique("forward"), false};
  return {&find_technique("visibility"), true};
}

std::vector<ContestantRun> make_entries(Renderer& renderer, GpuScene& gpu, const View& view,
                                        const std::vector<Contestant>& contestants,
                                        const EveryLight& reference) {
  std::vector<ContestantRun> entries;
  const auto shared = std::make_shared<TargetPool>();
  for (const Contestant& c : contestants) {
    ContestantRun& entry = entries.emplace_back(ContestantRun{&c, {}, {}});
    const auto pool = reference.is(*c.technique, c.settings) ? nullptr : shared;
    attempt(entry, [&] {
      entry.run = std::make_unique<TechniqueRun>(renderer, gpu, view, c.settings, *c.technique, pool);
    });
  }
  return entries;
}

std::unique_ptr<TechniqueRun> make_reference_run(Renderer& renderer, GpuScene& gpu, const View& view,
                                                 const std::vector<Contestant>& contestants,
                                                 const EveryLight& reference) {
  Settings common =
      contestants.empty() ? Settings{} : contestants.front().settings;  // the same BRDF above all
  if (reference.chosen_lights) common.lights = ShadedLights::all;
  return std::make_unique<TechniqueRun>(renderer, gpu, view, common, *reference.technique);
}

static std::string time_in_words(double ms) {
  return ms < 120e3 ? fmt::format("{:.0f} s", ms / 1000) : fmt::format("{:.0f} min", ms / 60e3);
}

void choose_reference_pixels(ReferenceRun& reference, std::vector<ContestantRun>& entries, Renderer& renderer,
                             GpuScene& gpu, const View& view, const std::vector<Contestant>& contestants,
                             const CompareOptions& options, const EveryLight& technique) {
  const bool automatic = options.reference == ReferencePixels::automatic;
  if (!technique.technique->needs.opengl) {
    if (options.reference == ReferencePixels::sampled)
      throw machine_error("reference sampled: shades with OpenGL; {}", renderer.why_no_gl);
    return;
  }
  if (options.reference == ReferencePixels::full ||
      (automatic && is_quick_for_forward(view, gpu.scene().lights.size(), options.most_reference_ms)))
    return;
  const auto of_reference = [&](const ContestantRun& entry) {
    return entry.run && technique.is(entry.run->technique(), entry.contestant->settings);
  };
  const auto found = std::find_if(entries.begin(), entries.end(), of_reference);
  const bool is_contestant = found != entries.end();
  if (!is_contestant) reference.own = make_reference_run(renderer, gpu, view, contestants, technique);
  TechniqueRun& run = is_contestant ? *found->run : *reference.own;

  if (options.progress) options.progress(0, "estimating the reference's time");
  std::vector<PixelBlock> blocks = shuffled_blocks(view.grid(), options.seed);
  const double frame_ms = automatic ? estimate_forward_ms(run.view(), blocks) : 0;
  if (automatic &&
      frame_ms * (is_contestant ? options.warmup + options.frames + 1 : 1) <= options.most_reference_ms)
    return;

  const size_t most = sample_size(gpu.scene().lights.size()), a_block = PixelBlock::side * PixelBlock::side;
  blocks.resize(std::min(blocks.size(), (most + a_block - 1) / a_block));
  const size_t pixels = pixels_of(blocks, view.grid()).size(), all = view.grid().pixels();
  const std::string why = automatic ? fmt::format("every light at every pixel would take about {} a frame",
                                                  time_in_words(frame_ms))
                                    : std::string("asked for");
  const std::string what = fmt::format("{} at {} of {} pixels ({}; reference full shades all)",
                                       technique.name(), with_commas(pixels), with_commas(all), why);
  if (options.notice) options.notice("the reference is " + what);
  for (ContestantRun& entry : entries) {
    if (!of_reference(entry)) continue;
    reference.own ? entry.run.reset() : void(reference.own = std::move(entry.run));
    entry.refusal = machine_error("it is the reference: {}", what);
  }
  reference.run = reference.own.get();
  reference.blocks = std::move(blocks);
}

}  // namespace lightgrid
