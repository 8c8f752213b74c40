#include "compare/compare.h"

#include <algorithm>
#include <numeric>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/version.h"
#include "compare/contestant_runs.h"
#include "compare/moving.h"
#include "compare/oracle_sample.h"
#include "compare/silhouettes.h"
#include "compare/surfaces_in_double.h"
#include "gl/bindings.h"
#include "reference/position.h"
#include "results/flip.h"
#include "results/metrics.h"

namespace lightgrid {
namespace {

// OpenGL keeps images that it still draws or has bound, and glibc what is freed, in pieces that the next
// stage's images do not fit.
void return_freed_memory(const Renderer& renderer) {
  if (renderer.gl) {
    reset_gl_state();
    glFinish();
  }
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// Runs hand the memory of their images on: each keeps none but the reference.
void time_interleaved(std::vector<ContestantRun>& entries, const CompareOptions& options,
                      const EveryLight& reference, const Renderer& renderer) {
  Image memory;
  const auto hands_on = [&](const ContestantRun& e) {
    return e.run && !reference.is(e.run->technique(), e.contestant->settings);
  };
  const int rounds = options.warmup + options.frames;
  const auto tell = [&](int round, size_t i) {
    const double done = round + double(i) / double(entries.size());
    if (options.progress) options.progress(0.8 * done / (rounds + 1), entries[i].contestant->technique->name);
  };
  for (int round = 0; round <= rounds; ++round) {
    for (size_t i = 0; i < entries.size(); ++i) {
      tell(round, i);
      ContestantRun& entry = entries[i];
      if (hands_on(entry)) entry.run->reuse(std::move(memory));
      attempt(entry, [&] {
        if (round < rounds) {
          entry.run->run_frame(round < options.warmup);
        } else {
          entry.run->run_profiled_frames();
        }
      });
      if (hands_on(entry)) memory = entry.run->take_image();
    }
  }
  for (ContestantRun& entry : entries) {
    if (hands_on(entry)) entry.run->release();
  }
  memory = Image();
  return_freed_memory(renderer);
}

// If nothing ran, throws the first reason.
void require_one(const std::vector<ContestantRun>& entries) {
  for (const ContestantRun& entry : entries) {
    if (entry.run) return;
  }
  if (!entries.empty()) throw *entries.front().refusal;
}

RunResult refused_row(const ContestantRun& entry, const RunResult& reference) {
  RunResult row;
  row.technique = entry.contestant->technique->name;
  row.refused = entry.refusal->what();
  row.settings = settings_of(*entry.contestant->technique, entry.contestant->settings);
  row.lights_total = reference.lights_total, row.lights_in_view = reference.lights_in_view;
  return row;
}

// The triangles that the reference shows, and where some row shows another one.
struct ReferenceTriangles {
  ShownTriangles shown;
  std::vector<bool> contested = std::vector<bool>(shown.opaque.size());
};

ReferenceTriangles triangles_of(ReferenceRun& reference) {
  RenderView& v = reference.run->view();
  if (!reference.run->frame().triangles) return {read_triangles(v)};
  return {{own_triangles(*reference.run), std::vector<bool>(v.grid().values())}};
}

// All or nothing: the lists may not fit in memory. The run's images may hold another run's frame, so it draws
// once more.
void set_row(CompareReport& report, size_t place, TechniqueRun& run, ReferenceRun& reference,
             const std::vector<float>& depth, const std::optional<FlipExposures>& exposures,
             ReferenceTriangles& triangles) {
  const bool is_reference = &run == reference.run;
  if (!is_reference) run.run_frame(true);
  RunResult row = run.result();
  if (reference.sampled()) {
    const std::vector<uint32_t> pixels = pixels_of(reference.blocks, {report.width, report.height});
    row.error = compare_images(at_pixels(run.image(), pixels), at_pixels(reference.image(), pixels));
  } else {
    row.error = compare_images(run.image(), reference.image());
    if (exposures) row.error->flip_mean = mean_of(hdr_flip_map(run.image(), reference.image(), *exposures));
  }
  if (run.frame().triangles) {
    const std::vector<SceneTriangle> own = own_triangles(run);
    for (size_t i = 0; i < own.size(); ++i) {
      if (own[i] != triangles.shown.opaque[i]) triangles.contested[i] = true;
    }
    if (!reference.run->frame().triangles && !reference.sampled())
      row.error->silhouettes = silhouette_error(run.image(), own, reference.image(), triangles.shown);
  }
  LitPairs pairs = count_listed_pairs(run, run.frame().depth ? read_depth(run) : depth);
  row.pairs = {pairs.listed, pairs.lit, pairs.lost, pairs.wrong};
  if (run.technique().limited_lists) row.overflow = pairs.lost;
  const bool is_copy =
      !is_reference && reference.in_report && !reference.sampled() && row.error->bit_identical;
  report.rows[place] = std::move(row);
  report.images[place] = run.take_image();
  if (is_copy) report.images[place] = Image();
  if (is_reference) reference.in_report = &report.images[place];
  report.listed[place] = std::move(pairs.listed_of_pixel);
  if (!run.frame().depth || report.lit.empty()) report.lit = std::move(pairs.lit_of_pixel);
}

// Each image and the reference's against surfaces in double, at those of `pixels` where all rows show one
// triangle.
void measure_surfaces(CompareReport& report, const ReferenceRun& reference,
                      const ReferenceTriangles& triangles, std::vector<uint32_t> pixels) {
  std::erase_if(pixels, [&](uint32_t pixel) { return triangles.contested[pixel]; });
  const SurfacesInDouble in_double =
      surfaces_in_double(reference.run->view(), triangles.shown.opaque, pixels);
  const double brightest = brightest_channel(reference.image());
  report.reference_surfaces = surfaces_error(reference.image(), in_double, brightest);
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].error)
      report.rows[i].error->surfaces = surfaces_error(image_of(report, i), in_double, brightest);
  }
}

// Compares each image and the reference's with the oracle: at a sample of pixels, which it returns, and where
// the images differ most, so that no large difference is missed.
std::vector<uint32_t> measure_against_oracle(CompareReport& report, const ReferenceRun& reference,
                                             const std::vector<float>& depth, size_t samples) {
  constexpr size_t worst_of_a_row = 100;
  const SurfaceOracle oracle(reference.run->view(), depth);
  std::vector<uint32_t> among = oracle.pixels();
  if (reference.sampled()) {
    const std::vector<uint32_t> sampled = pixels_of(reference.blocks, {report.width, report.height});
    std::erase_if(among,
                  [&](uint32_t pixel) { return !std::binary_search(sampled.begin(), sampled.end(), pixel); });
  }
  const std::vector<uint32_t> sample =
      sample_pixels(among, affordable_samples(samples, reference.run->view().scene.lights.size()));
  report.reference_errors = measure_reference_errors(oracle, reference.image(), sample);
  std::vector<uint32_t> pixels = sample;
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (!report.rows[i].error) continue;
    const std::vector<uint32_t> worst =
        most_different(image_of(report, i), reference.image(), among, worst_of_a_row);
    pixels.insert(pixels.end(), worst.begin(), worst.end());
  }
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  const std::vector<glm::dvec3> radiance = oracle.shade(pixels, true);
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].error)
      report.rows[i].error->oracle = oracle_error(image_of(report, i), reference.image(), pixels, radiance);
  }
  return sample;
}

void run_path(CompareReport& report, GpuScene& gpu, std::vector<ContestantRun>& entries,
              ReferenceRun& reference, const CompareOptions& options) {
  if (options.path.empty()) return;
  std::vector<TechniqueRun*> runs;
  for (const ContestantRun& entry : entries) runs.push_back(entry.refusal ? nullptr : entry.run.get());
  const auto tell = [&](double done) {
    if (options.progress) options.progress(0.9 + 0.1 * done, "camera path");
  };
  report.path_memory =
      run_along_path(runs, *reference.run, {gpu, options.path, options.advance}, report.rows, tell);
}

// The reference first: images that equal it are then not kept. Then what takes most memory, while few images
// are there: techniques with a copy of the scene in OpenCL, then those with a list for each pixel, then those
// with one for each object.
std::vector<size_t> order_of_rows(const std::vector<ContestantRun>& entries, const TechniqueRun* reference) {
  std::vector<size_t> order(entries.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::ranges::stable_sort(order, {}, [&](size_t i) {
    const Contestant& c = *entries[i].contestant;
    if (entries[i].run && entries[i].run.get() == reference) return -1;
    if (own_surfaces(*c.technique, c.settings)) return 0;
    switch (c.technique->listed_by) {
      case ListedBy::pixel:
        return 1;
      case ListedBy::object:
        return 2;
      case ListedBy::cell:
        return 3;
    }
    return 3;
  });
  return order;
}

bool any_has_own_surfaces(const std::vector<ContestantRun>& entries) {
  return std::ranges::any_of(entries, [](const ContestantRun& e) {
    return e.run && own_surfaces(*e.contestant->technique, e.contestant->settings);
  });
}

CompareReport measure(Renderer& renderer, const Scene& scene, const View& view,
                      const std::vector<Contestant>& contestants, const CompareOptions& options) {
  CompareReport report;
  report.scene = scene.name;
  report.ambient = scene.ambient;
  report.width = view.width, report.height = view.height;
  report.cl_device = renderer.cl->info().name;
  report.gl_device = renderer.gl ? renderer.gl->renderer : "none";
  report.commit = commit_of_build();
  const EveryLight every_light = every_light_technique(renderer);
  report.reference = every_light.name();
  report.reference_pixels = view.grid().pixels();

  GpuScene gpu(renderer, scene);
  std::vector<ContestantRun> entries = make_entries(renderer, gpu, view, contestants, every_light);
  ReferenceRun reference;
  choose_reference_pixels(reference, entries, renderer, gpu, view, contestants, options, every_light);
  time_interleaved(entries, options, every_light, renderer);
  if (!options.all_may_refuse) require_one(entries);

  for (ContestantRun& entry : entries) {
    if (reference.run || !entry.run || !every_light.is(entry.run->technique(), entry.contestant->settings))
      continue;
    reference.run = entry.run.get();
  }
  if (options.progress && (reference.sampled() || !reference.run))
    options.progress(0.8, "reference: " + report.reference);
  if (reference.sampled()) {
    render_forward_at(reference.run->view(), reference.blocks, reference.sampled_image);
    report.reference_pixels = pixels_of(reference.blocks, view.grid()).size();
  } else if (!reference.run) {
    if (!reference.own) reference.own = make_reference_run(renderer, gpu, view, contestants, every_light);
    reference.run = reference.own.get();
    reference.run->run_frame();
    report.reference_image = reference.run->take_image();
    reference.in_report = &report.reference_image;
  }

  const std::vector<float> depth = read_depth(*reference.run);
  std::optional<FlipExposures> exposures;
  if (options.flip && !reference.sampled()) exposures = flip_exposures(reference.image());
  ReferenceTriangles triangles = triangles_of(reference);
  report.rows.resize(entries.size()), report.images.resize(entries.size()),
      report.listed.resize(entries.size());
  const std::vector<size_t> order = order_of_rows(entries, reference.run);
  for (size_t i = 0; i < order.size(); ++i) {
    ContestantRun& entry = entries[order[i]];
    if (options.progress)
      options.progress(0.8 + 0.1 * double(i) / double(entries.size()), "oracle: lit lights");
    // A refusal here keeps the run: it may be the reference.
    if (entry.run)
      attempt(
          entry, [&] { set_row(report, order[i], *entry.run, reference, depth, exposures, triangles); },
          false);
    if (entry.refusal) report.rows[order[i]] = refused_row(entry, reference.run->result());
    if (entry.run && entry.run.get() != reference.run)
      options.path.empty() ? entry.run.reset() : entry.run->release();
    if (options.path.empty() && !any_has_own_surfaces(entries)) gpu.free_in_cl();
    return_freed_memory(renderer);
  }
  if (options.progress) options.progress(0.9, "oracle: shading");
  // The oracle shades surfaces that OpenGL draws. Without it, what blended surfaces cover is not known.
  if (renderer.gl) {
    measure_surfaces(report, reference, triangles,
                     measure_against_oracle(report, reference, depth, options.shaded_samples));
  } else if (reference.run->view().plan.blended.empty()) {
    measure_surfaces(report, reference, triangles,
                     sample_pixels(covered_pixels(depth),
                                   affordable_samples(options.shaded_samples, scene.lights.size())));
  }
  run_path(report, gpu, entries, reference, options);
  if (options.progress) options.progress(1, "");
  return report;
}

}  // namespace

CompareReport compare_techniques(Renderer& renderer, const Scene& scene, const View& view,
                                 const std::vector<Contestant>& contestants, const CompareOptions& options) {
  CompareReport report = measure(renderer, scene, view, contestants, options);
  return_freed_memory(renderer);  // also of the scene on the devices
  return report;
}

}  // namespace lightgrid
