#include "session/compare.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/version.h"
#include "gl/bindings.h"
#include "reference/position.h"
#include "results/flip.h"
#include "results/metrics.h"
#include "session/moving.h"
#include "session/oracle_sample.h"
#include "session/runs.h"
#include "session/shadow_truth.h"
#include "session/surfaces_in_double.h"

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
void time_interleaved(std::vector<ContestantRun>& entries, const Compared& compared) {
  const CompareOptions& options = compared.options;
  Image memory;
  const auto hands_on = [&](const ContestantRun& e) {
    return e.run && !compared.every_light.is(e.run->technique(), e.contestant->settings);
  };
  const int rounds = options.warmup + options.frames;
  const auto tell = [&](int round, size_t i) {
    const double done = round + double(i) / double(entries.size());
    compared.tell(0.8 * done / (rounds + 1), entries[i].contestant->technique->name);
  };
  for (int round = 0; round <= rounds; ++round) {
    for (size_t i = 0; i < entries.size(); ++i) {
      tell(round, i);
      ContestantRun& entry = entries[i];
      if (hands_on(entry)) entry.run->reuse(std::move(memory));
      entry.attempt([&] {
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
  return_freed_memory(compared.renderer);
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

ReferenceTriangles triangles_of(TechniqueRun& reference) {
  if (!reference.frame().triangles) return {read_triangles(reference.view())};
  return {{own_triangles(reference), std::vector<bool>(reference.view().grid().values())}};
}

// What the rows are compared with.
struct Measured {
  Reference& reference;
  std::vector<float> depth = read_depth(reference.run());
  ReferenceTriangles triangles = triangles_of(reference.run());
  ShadowTruth shadows;
  RunResult result = reference.run().result();
  std::optional<FlipExposures> exposures{};
  bool shown = false;             // the report will have the reference's image
  Image every_light_on_own = {};  // surfaces, where rows have such and the reference has OpenGL's; or empty
};

// They take about 45 seconds of processor time.
constexpr uint64_t most_shadow_pairs = 10'000'000;

Measured measured(Reference& reference, bool flip) {
  Measured m{.reference = reference, .shadows = {reference.run().view().scene, most_shadow_pairs}};
  if (reference.sampled()) return m;
  reference.image = reference.run().take_image();
  if (flip) m.exposures = flip_exposures(reference.image);
  m.shown = std::holds_alternative<OwnRun>(reference.kind);
  return m;
}

ImageError error_of(const Image& image, const Measured& m) {
  const Reference& reference = m.reference;
  if (reference.sampled()) {
    const std::vector<uint32_t> pixels = reference.sampled_pixels();
    return compare_images(at_pixels(image, pixels), at_pixels(reference.image, pixels));
  }
  ImageError error = compare_images(image, reference.image);
  if (m.exposures) error.flip_mean = mean_of(hdr_flip_map(image, reference.image, *m.exposures));
  return error;
}

// Where an own reference is not wanted, the report has no OwnSurfaces; where it cannot be had, it says why
// not.
void draw_every_light_on_own_surfaces(CompareReport& report, const Compared& compared,
                                      const std::vector<ContestantRun>& entries, Measured& m) {
  if (m.reference.run().frame().triangles) return;
  const auto own = std::ranges::find_if(entries, [](const ContestantRun& e) {
    return e.run && own_surfaces(*e.contestant->technique, e.contestant->settings);
  });
  if (own == entries.end()) return;
  report.own_surfaces.emplace();
  if (m.reference.sampled()) {
    report.own_surfaces->why_not = "the reference is a sample";
    return;
  }
  compared.tell(0.8, fmt::format("reference: {}", every_light_on(true)));
  const auto failure = failure_of([&] {
    const std::unique_ptr<TechniqueRun> run = make_run_of_every_light(compared, own->contestant->settings);
    run->run_frame(true);
    m.every_light_on_own = run->take_image();
    ImageError error = error_of(m.every_light_on_own, m);
    error.displayed = displayed_flip(m.every_light_on_own, m.reference.image, report.exposure);
    error.silhouettes =
        silhouette_error(m.every_light_on_own, own_triangles(*run), m.reference.image, m.triangles.shown);
    report.own_surfaces->error = std::move(error);
  });
  if (failure) report.own_surfaces->why_not = failure->what(), m.every_light_on_own = {};
}

// The row's error against the reference, and that of its light alone.
void set_errors(RunResult& row, const Image& image, const CompareReport& report, const Measured& m) {
  const Image& every_light = row.own_surfaces ? m.every_light_on_own : m.reference.image;
  const bool other_surfaces = row.own_surfaces && !m.reference.run().frame().triangles;
  if (other_surfaces && !every_light.pixels.empty()) {
    row.same_surfaces = compare_images(image, every_light, report.brightest);
    row.same_surfaces->displayed = displayed_flip(image, every_light, report.exposure);
    if (row.same_surfaces->bit_identical) row.error = report.own_surfaces->error;
  }
  if (!row.error) row.error = error_of(image, m);
  if (other_surfaces || m.reference.sampled()) return;
  row.error->displayed = displayed_flip(image, m.reference.image, report.exposure);
  if (row.own_surfaces) row.same_surfaces = row.error;
}

// The share of `every_light`'s radiance, over all channels and pixels, that the image lacks. Negative: it has
// more.
double missing_light(const Image& image, const Image& every_light) {
  const auto sum_of = [](const glm::vec4& c) { return double(c.r) + c.g + c.b; };
  double has = 0, all = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    has += sum_of(image.pixels[i]);
    all += sum_of(every_light.pixels[i]);
  }
  return all > 0 && std::isfinite(has) && std::isfinite(all) ? 1 - has / all : 0;
}

// All or nothing: the lists may not fit in memory. The run's images may hold another run's frame, so it draws
// once more.
void set_row(CompareReport& report, size_t place, TechniqueRun& run, Measured& m) {
  const Reference& reference = m.reference;
  const bool is_reference = &run == &reference.run();
  if (!is_reference) run.run_frame(true);
  const Image& image = is_reference ? reference.image : run.image();
  RunResult row = is_reference ? m.result : run.result();
  row.own_surfaces = run.frame().triangles.has_value();
  set_errors(row, image, report, m);
  std::vector<SceneTriangle> own;
  if (row.own_surfaces) {
    own = own_triangles(run);
    for (size_t i = 0; i < own.size(); ++i) {
      if (own[i] != m.triangles.shown.opaque[i]) m.triangles.contested[i] = true;
    }
    if (!reference.run().frame().triangles && !reference.sampled())
      row.error->silhouettes = silhouette_error(image, own, reference.image, m.triangles.shown);
  }
  const std::vector<float> own_depth = run.frame().depth ? read_depth(run) : std::vector<float>();
  const std::vector<float>& depth = run.frame().depth ? own_depth : m.depth;
  const SeenPairs* seen =
      m.shadows.pairs(run.view(), depth, row.own_surfaces ? own : m.triangles.shown.opaque);
  LitPairs pairs = count_listed_pairs(run, depth, seen);
  row.pairs = pair_counts(run, pairs, seen);
  if (const std::optional<LitPairs> blended = count_blended_pairs(run, m.shadows))
    row.pairs->blended = {blended->lit, blended->leaked, blended->acned, blended->either, !run.approximate()};
  if (run.technique().limited_lists) row.overflow = pairs.lost;
  const Image& every_light =
      row.own_surfaces && !reference.run().frame().triangles ? m.every_light_on_own : reference.image;
  if (pairs.lost == 0 && !run.approximate() && !reference.sampled() && !every_light.pixels.empty())
    row.unshaded = missing_light(image, every_light);
  Image taken = run.take_image();
  if (!is_reference && !(m.shown && row.error->bit_identical)) report.images[place] = std::move(taken);
  m.shown |= is_reference;
  report.rows[place] = std::move(row);
  report.listed[place] = std::move(pairs.listed_of_pixel);
  if (!run.frame().depth || report.lit.empty()) report.lit = std::move(pairs.lit_of_pixel);
}

// The image of a row that has one, while the reference's is not in the report yet.
const Image& image_of(const CompareReport& report, size_t row, const Reference& reference) {
  return report.images[row].pixels.empty() ? reference.image : report.images[row];
}

void hand_over_image(CompareReport& report, Measured& m) {
  if (!m.shown) return;
  const auto* contestant = std::get_if<RunOfContestant>(&m.reference.kind);
  (contestant ? report.images[contestant->row] : report.reference_image) = std::move(m.reference.image);
}

// Each image and the reference's against surfaces in double, at those of `pixels` where all rows show one
// triangle.
void measure_surfaces(CompareReport& report, Measured& m, std::vector<uint32_t> pixels) {
  const Reference& reference = m.reference;
  std::erase_if(pixels, [&](uint32_t pixel) { return m.triangles.contested[pixel]; });
  const SurfacesInDouble in_double =
      surfaces_in_double(reference.run().view(), m.triangles.shown.opaque, pixels, &m.shadows);
  const double brightest = brightest_channel(reference.image);
  report.reference_surfaces = surfaces_error(reference.image, in_double, brightest);
  if (!m.every_light_on_own.pixels.empty())
    report.own_surfaces->error->surfaces = surfaces_error(m.every_light_on_own, in_double, brightest);
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].error)
      report.rows[i].error->surfaces = surfaces_error(image_of(report, i, reference), in_double, brightest);
  }
}

// Compares each image and the reference's with the oracle: at a sample of pixels, which it returns, and where
// the images differ most, so that no large difference is missed.
std::vector<uint32_t> measure_against_oracle(CompareReport& report, Measured& m, size_t samples) {
  constexpr size_t worst_of_a_row = 100;
  const Reference& reference = m.reference;
  const SurfaceOracle oracle(reference.run().view(), m.depth, &m.shadows);
  std::vector<uint32_t> among = oracle.pixels();
  if (reference.sampled()) {
    const std::vector<uint32_t> sampled = reference.sampled_pixels();
    std::erase_if(among,
                  [&](uint32_t pixel) { return !std::binary_search(sampled.begin(), sampled.end(), pixel); });
  }
  const std::vector<uint32_t> sample =
      oracle.decided(sample_pixels(among, affordable_samples(samples, reference.run().view().scene)));
  report.reference_errors = measure_reference_errors(oracle, reference.image, sample);
  std::vector<uint32_t> pixels = sample;
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (!report.rows[i].error) continue;
    const std::vector<uint32_t> worst =
        most_different(image_of(report, i, reference), reference.image, among, worst_of_a_row);
    pixels.insert(pixels.end(), worst.begin(), worst.end());
  }
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  pixels = oracle.decided(std::move(pixels));
  const std::vector<glm::dvec3> radiance = oracle.shade(pixels, true);
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].error)
      report.rows[i].error->oracle =
          oracle_error(image_of(report, i, reference), reference.image, pixels, radiance);
  }
  return sample;
}

void run_path(CompareReport& report, const Compared& compared, std::vector<ContestantRun>& entries,
              Reference& reference) {
  const CompareOptions& options = compared.options;
  if (options.path.empty()) return;
  std::vector<TechniqueRun*> runs;
  for (const ContestantRun& entry : entries) runs.push_back(entry.refusal ? nullptr : entry.run.get());
  report.path_memory =
      run_along_path(runs, reference.run(), {compared.gpu, options.path, options.advance}, report.rows,
                     [&](double done) { compared.tell(0.9 + 0.1 * done, "camera path"); });
}

// The reference first: images that equal it are then not kept. Then what takes most memory, while few images
// are there: techniques with a copy of the scene in OpenCL, then those with a list for each pixel, then those
// with one for each object.
std::vector<size_t> order_of_rows(const std::vector<ContestantRun>& entries, const TechniqueRun& reference) {
  std::vector<size_t> order(entries.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::ranges::stable_sort(order, {}, [&](size_t i) {
    const Contestant& c = *entries[i].contestant;
    if (entries[i].run && entries[i].run.get() == &reference) return -1;
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

// Turns each run into its row, and frees its memory for the next.
void measure_rows(CompareReport& report, const Compared& compared, std::vector<ContestantRun>& entries,
                  Measured& m) {
  const TechniqueRun& reference = m.reference.run();
  const bool at_rest = compared.options.path.empty();
  report.rows.resize(entries.size()), report.images.resize(entries.size()),
      report.listed.resize(entries.size());
  const std::vector<size_t> order = order_of_rows(entries, reference);
  for (size_t i = 0; i < order.size(); ++i) {
    ContestantRun& entry = entries[order[i]];
    compared.tell(0.8 + 0.1 * double(i) / double(entries.size()), "oracle: lit lights");
    // A refusal here keeps the run: it may be the reference.
    if (entry.run) entry.attempt([&] { set_row(report, order[i], *entry.run, m); }, false);
    if (entry.refusal) report.rows[order[i]] = refused_row(entry, m.result);
    if (entry.run && entry.run.get() != &reference) at_rest ? entry.run.reset() : entry.run->release();
    if (at_rest && !any_has_own_surfaces(entries)) compared.gpu.free_in_cl();
    return_freed_memory(compared.renderer);
  }
}

void measure_errors(CompareReport& report, const Compared& compared, Measured& m) {
  const size_t samples = compared.options.shaded_samples;
  compared.tell(0.9, "oracle: shading");
  // The oracle shades surfaces that OpenGL draws. Without it, what blended surfaces cover is not known.
  if (compared.renderer.gl) {
    measure_surfaces(report, m, measure_against_oracle(report, m, samples));
  } else if (m.reference.run().view().plan.blended.empty()) {
    const size_t most = affordable_samples(samples, compared.gpu.scene());
    measure_surfaces(report, m, sample_pixels(covered_pixels(m.depth), most));
  }
}

CompareReport measure(const Compared& compared) {
  const Scene& scene = compared.gpu.scene();
  const View& view = compared.view;
  CompareReport report;
  report.scene = scene.name;
  report.ambient = scene.ambient;
  report.width = view.width, report.height = view.height;
  report.cl_device = compared.renderer.cl->info().name;
  report.gl_device = compared.renderer.gl ? compared.renderer.gl->renderer : "none";
  report.commit = commit_of_build();
  report.reference = compared.every_light.name();

  std::vector<ContestantRun> entries = make_entries(compared);
  Reference reference = choose_reference(compared, entries);
  time_interleaved(entries, compared);
  if (!compared.options.all_may_refuse) require_one(entries);
  draw_reference(reference, compared, entries);
  report.reference_pixels = reference.sampled() ? reference.sampled_pixels().size() : view.grid().pixels();
  Measured m = measured(reference, compared.options.flip);
  report.brightest = brightest_channel(reference.image);
  if (compared.options.exposure && !reference.sampled())
    report.exposure = compared.options.exposure(reference.image);
  report.covered_pixels = covered_pixels(m.depth).size();
  draw_every_light_on_own_surfaces(report, compared, entries, m);
  measure_rows(report, compared, entries, m);
  measure_errors(report, compared, m);
  hand_over_image(report, m);
  run_path(report, compared, entries, reference);
  compared.tell(1, "");
  return report;
}

}  // namespace

CompareReport compare_techniques(Renderer& renderer, const Scene& scene, const View& view,
                                 const std::vector<Contestant>& contestants, const CompareOptions& options) {
  CompareReport report;
  {
    GpuScene gpu(renderer, scene);
    report = measure({renderer, gpu, view, contestants, options});
  }
  return_freed_memory(renderer);  // also of the scene on the devices
  return report;
}

}  // namespace lightgrid
