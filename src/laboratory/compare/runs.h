// The runs of a comparison: one a contestant, and the reference that their images are compared with.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cl/error.h"
#include "compare/compare.h"
#include "compare/reference_sample.h"
#include "plan/settings/grid.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"
#include "run/frames.h"

namespace lightgrid::lab {

// The technique that shades every light at every pixel, and its settings; of one sample a pixel, so that
// pixels have one surface each.
struct EveryLight {
  const Technique* technique;
  bool chosen_lights;          // only with lights=all
  bool point_shadows = false;  // only with one ray to each light

  bool is(const Technique& other, const Settings& settings) const {
    return other.name == std::string(technique->name) &&
           (!chosen_lights || settings[setting::lights] == ShadedLights::all) &&
           (!point_shadows || (!soft_shadows(settings) && !picks_shadows(settings))) &&
           settings[setting::shadows] == ShadowMethod::exact && settings[setting::shadow_threshold] == 0 &&
           settings[setting::samples] == 1;
  }
  bool is(const TechniqueRun& run) const { return is(run.technique(), run.view().plan.settings); }
  std::string name() const { return technique->name + std::string(chosen_lights ? ":lights=all" : ""); }
};

// Its shadows are those of points unless all contestants have the same rays, sources and picks: the errors
// would otherwise depend on the contestants' order.
EveryLight every_light_technique(const Renderer& renderer, const std::vector<Contestant>& contestants = {});

// The contestants of a comparison, on one view.
struct Compared {
  Renderer& renderer;
  GpuScene& gpu;
  const View& view;
  const std::vector<Contestant>& contestants;
  const CompareOptions& options;
  const EveryLight every_light = every_light_technique(renderer, contestants);

  void tell(double done, const std::string& step) const {
    if (options.progress) options.progress(done, step);
  }
};

// A contestant's run, until it fails.
struct ContestantRun {
  const Contestant* contestant;
  std::unique_ptr<TechniqueRun> run;
  std::optional<Error> refusal;

  // Runs `work`. A failure is recorded as the refusal and ends the run if ends_run.
  template <typename Work>
  void attempt(const Work& work, bool ends_run = true) {
    if (refusal) return;
    refusal = failure_of(work);
    if (refusal && ends_run) run.reset();
  }
};

// All runs draw into the same images in turn, except the reference: its depth and surfaces are read after
// other runs' frames.
std::vector<ContestantRun> make_entries(const Compared& compared);

// The brute-force image comes from a run of its own, which may not be made yet; from a contestant's; or from
// a run of its own at a sample of the pixels.
struct OwnRun {
  std::unique_ptr<TechniqueRun> run;
};
struct RunOfContestant {
  size_t row;
  TechniqueRun* run;
};
struct SampledRun {
  std::unique_ptr<TechniqueRun> run;
  std::vector<PixelBlock> blocks;
};

struct Reference {
  std::variant<OwnRun, RunOfContestant, SampledRun> kind;
  Image image{};  // once drawn; in a sampled one the other pixels are background

  TechniqueRun& run() const;
  bool sampled() const { return std::holds_alternative<SampledRun>(kind); }
  // The pixels of the sample, ascending.
  std::vector<uint32_t> sampled_pixels() const;
};

// Chooses between all pixels and a sample, before frames are timed. With a sample, contestants with the
// reference's technique are refused.
Reference choose_reference(const Compared& compared, std::vector<ContestantRun>& entries);

// A run of every light on the surfaces that are drawn in OpenCL, or on those of OpenGL, with the model,
// texels and samples of `settings`.
std::unique_ptr<TechniqueRun> make_run_of_every_light(const Compared& compared, Settings settings,
                                                      bool own_surfaces);

// Draws the reference, unless one of the contestants that still run has drawn it. The image of a whole one
// is still its run's.
void draw_reference(Reference& reference, const Compared& compared,
                    const std::vector<ContestantRun>& entries);

}  // namespace lightgrid::lab
