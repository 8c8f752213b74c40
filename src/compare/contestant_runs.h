// The runs of a comparison: one a contestant, and the reference that their images are compared with.
#pragma once

#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cl/error.h"
#include "compare/compare.h"
#include "compare/reference_sample.h"
#include "compare/run_technique.h"

namespace lightgrid {

// A contestant's run, until it fails.
struct ContestantRun {
  const Contestant* contestant;
  std::unique_ptr<TechniqueRun> run;
  std::optional<Error> refusal;
};

// Runs `work`. An Error is recorded as the refusal and ends the run if ends_run.
template <typename Work>
void attempt(ContestantRun& entry, const Work& work, bool ends_run = true) {
  if (entry.refusal) return;
  try {
    work();
  } catch (const Error& error) {
    entry.refusal = error;
  } catch (const cl::Error& error) {
    entry.refusal = cl_machine_error(error);
  } catch (const std::bad_alloc&) {
    entry.refusal = machine_error("out of memory");
  }
  if (entry.refusal && ends_run) entry.run.reset();
}

// The technique that shades every light at every pixel, and its settings.
struct EveryLight {
  const Technique* technique;
  bool chosen_lights;  // only with lights=all

  bool is(const Technique& other, const Settings& settings) const {
    return other.name == std::string(technique->name) &&
           (!chosen_lights || settings.lights == ShadedLights::all);
  }
  std::string name() const { return technique->name + std::string(chosen_lights ? ":lights=all" : ""); }
};

EveryLight every_light_technique(const Renderer& renderer);

// All runs draw into the same images in turn, except the reference: its depth and surfaces are read after
// other runs' frames.
std::vector<ContestantRun> make_entries(Renderer& renderer, GpuScene& gpu, const View& view,
                                        const std::vector<Contestant>& contestants,
                                        const EveryLight& reference);

// The brute-force image: of a contestant or of its own run, at all pixels or at a sample of them.
struct ReferenceRun {
  std::unique_ptr<TechniqueRun> own;
  TechniqueRun* run = nullptr;
  std::vector<PixelBlock> blocks;  // empty: all pixels
  Image sampled_image;
  const Image* in_report = nullptr;  // once the report has it: the run's image

  bool sampled() const { return !blocks.empty(); }
  const Image& image() const { return sampled() ? sampled_image : in_report ? *in_report : run->image(); }
};

// A run for the reference alone, with the settings that all contestants share.
std::unique_ptr<TechniqueRun> make_reference_run(Renderer& renderer, GpuScene& gpu, const View& view,
                                                 const std::vector<Contestant>& contestants,
                                                 const EveryLight& reference);

// Chooses between all pixels and a sample. With a sample, contestants with the reference's technique are
// refused.
void choose_reference_pixels(ReferenceRun& reference, std::vector<ContestantRun>& entries, Renderer& renderer,
                             GpuScene& gpu, const View& view, const std::vector<Contestant>& contestants,
                             const CompareOptions& options, const EveryLight& technique);

}  // namespace lightgrid
