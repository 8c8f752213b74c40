#include "compare/measured_rows.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "accuracy/area_error.h"
#include "accuracy/oracle_sample.h"
#include "measures/metrics.h"
#include "measures/speedup.h"
#include "oracle/position.h"
#include "plan/settings/grid.h"
#include "plan/settings/samples.h"

namespace lightgrid::lab {
namespace {

ReferenceTriangles triangles_of(TechniqueRun& reference) {
  if (!reference.frame().triangles) return {read_triangles(reference.view())};
  return {{own_triangles(reference), std::vector<bool>(reference.view().grid().values())}};
}

// They take about 45 seconds of processor time.
constexpr uint64_t max_shadow_pairs = 10'000'000;

}  // namespace

Measured measured(Reference& reference, bool flip) {
  Measured m{.reference = reference,
             .depth = read_depth(reference.run()),
             .triangles = triangles_of(reference.run()),
             .shadows = {reference.run().view().scene, max_shadow_pairs},
             .result = reference.run().result()};
  if (reference.sampled()) return m;
  reference.image = reference.run().take_image();
  if (flip) m.exposures = flip_exposures(reference.image);
  m.shown = std::holds_alternative<OwnRun>(reference.kind);
  return m;
}

namespace {

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

}  // namespace

SampledBy sampled_by(bool own_surfaces, const Settings& settings) {
  const bool several = settings[setting::samples] > 1;
  return {own_surfaces, settings[setting::samples],
          several ? settings[setting::samples_masks] : SampleMasks::centre,
          several ? settings[setting::samples_resolve] : SamplesResolve::linear};
}

// Every light on the surfaces of this run; empty: it was not drawn.
const Image& every_light_of(const TechniqueRun& run, const Measured& m) {
  const bool own = run.frame().triangles.has_value();
  const auto other = m.every_light_with.find(sampled_by(own, run.view().plan.settings));
  if (other != m.every_light_with.end()) return other->second;
  return own && !m.reference.run().frame().triangles ? m.every_light_on_own : m.reference.image;
}

// The contestant's, with as many samples as its run draws.
Settings planned_settings(const ContestantRun& e) {
  return with_samples(e.contestant->settings, e.run->view().plan.settings[setting::samples]);
}

// With the samples of each row on these surfaces that has others than `drawn`.
void draw_every_light_with_samples(const Compared& compared, const std::vector<ContestantRun>& entries,
                                   bool own, const SampledBy& drawn, Measured& m) {
  for (const ContestantRun& e : entries) {
    if (!e.run || own_surfaces(*e.contestant->technique, e.contestant->settings) != own) continue;
    const Settings settings = planned_settings(e);
    const SampledBy by = sampled_by(own, settings);
    if (by == drawn || m.every_light_with.contains(by)) continue;
    const std::unique_ptr<TechniqueRun> run = make_run_of_every_light(compared, settings, own);
    run->run_frame(true);
    m.every_light_with[by] = run->take_image();
  }
}

// Times every light on surfaces drawn in OpenCL, if the reference is timed. The frames are taken after those
// of the contestants, and at most for a few seconds.
static void time_every_light(TechniqueRun& run, const Compared& compared, const Measured& m,
                             OwnSurfaces& own) {
  constexpr double max_ms = 5000;
  if (!std::holds_alternative<RunOfContestant>(m.reference.kind)) return;
  double ms = 0;
  for (int frame = 0; frame < compared.options.frames && ms < max_ms; ++frame) ms += run.run_frame();
  run.run_profiled_frames(0);
  own.every_light = RunResult{run.result()};
}

void draw_every_light_on_own_surfaces(CompareReport& report, const Compared& compared,
                                      const std::vector<ContestantRun>& entries, Measured& m) {
  const bool reference_is_own = m.reference.run().frame().triangles.has_value();
  if (!m.reference.sampled())
    draw_every_light_with_samples(compared, entries, reference_is_own,
                                  sampled_by(reference_is_own, m.reference.run().view().plan.settings), m);
  if (reference_is_own) return;
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
    // With the reference's samples: surfaces are held against the same number of them.
    const Settings settings =
        with_samples(own->contestant->settings, m.reference.run().view().plan.settings[setting::samples]);
    const std::unique_ptr<TechniqueRun> run = make_run_of_every_light(compared, settings, true);
    run->run_frame(true);
    time_every_light(*run, compared, m, *report.own_surfaces);
    m.every_light_on_own = run->take_image();
    ImageError error = error_of(m.every_light_on_own, m);
    error.displayed = displayed_flip(m.every_light_on_own, m.reference.image, report.exposure);
    error.silhouettes =
        silhouette_error(m.every_light_on_own, own_triangles(*run), m.reference.image, m.triangles.shown);
    report.own_surfaces->error = std::move(error);
    draw_every_light_with_samples(compared, entries, true, sampled_by(true, settings), m);
  });
  if (failure) {
    report.own_surfaces->why_not = failure->what();
    m.every_light_on_own = {};
  }
}

namespace {

// The row's error against the reference, and that of its light alone.
void set_errors(RunResult& row, const Image& image, const Image& every_light, const CompareReport& report,
                const Measured& m) {
  const bool other_surfaces = &every_light != &m.reference.image;
  if (other_surfaces && !every_light.pixels.empty()) {
    row.same_surfaces = compare_images(image, every_light, report.brightest);
    row.same_surfaces->displayed = displayed_flip(image, every_light, report.exposure);
    if (row.same_surfaces->bit_identical && &every_light == &m.every_light_on_own)
      row.error = report.own_surfaces->error;
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

}  // namespace

void set_row(CompareReport& report, size_t place, TechniqueRun& run, Measured& m) {
  const Reference& reference = m.reference;
  const bool is_reference = &run == &reference.run();
  if (!is_reference) run.run_frame(true);
  m.has_samples |= run.view().plan.settings[setting::samples] > 1;
  const Image& image = is_reference ? reference.image : run.image();
  RunResult row{is_reference ? m.result : run.result()};
  row.own_surfaces = run.frame().triangles.has_value();
  const Image& every_light = every_light_of(run, m);
  set_errors(row, image, every_light, report, m);
  std::vector<SceneTriangle> own;
  if (row.own_surfaces) {
    own = own_triangles(run);
    for (size_t i = 0; i < own.size(); ++i) {
      if (own[i] != m.triangles.shown.opaque[i]) m.triangles.contested[i] = true;
    }
    if (!reference.run().frame().triangles && !reference.sampled())
      row.error->silhouettes = silhouette_error(image, own, reference.image, m.triangles.shown);
  }
  const bool other_depth = run.frame().depth || run.view().plan.settings[setting::samples] !=
                                                    reference.run().view().plan.settings[setting::samples];
  const std::vector<float> own_depth = other_depth ? read_depth(run) : std::vector<float>();
  const std::vector<float>& depth = other_depth ? own_depth : m.depth;
  if (!row.own_surfaces && other_depth) {
    for (size_t i = 0; i < depth.size(); ++i)
      if (depth[i] == 0 && m.depth[i] != 0) m.triangles.contested[i] = true;
  }
  const SeenPairs* seen =
      m.shadows.pairs(run.view(), depth, row.own_surfaces ? own : m.triangles.shown.opaque);
  LitPairs pairs = count_listed_pairs(run, depth, seen);
  row.pairs = pair_counts(run, pairs, seen);
  if (const std::optional<LitPairs> blended = count_blended_pairs(run, m.shadows))
    row.pairs->blended = {blended->lit, blended->leaked, blended->acned, blended->either, !run.approximate()};
  if (run.limits_lists()) {
    row.overflow = pairs.lost;
    if (!reference.sampled() && !every_light.pixels.empty())
      row.limited = {
          missing_light(image, every_light),
          error_steps(image, every_light, run.view().plan.settings[setting::tile], report.brightest)};
  }
  // Lists of blended surfaces, whose pairs are not counted, may have lost theirs all the same.
  const bool capped =
      run.view().plan.settings[setting::list_cap] > 0 || run.view().plan.settings[setting::view_cap] > 0;
  if (pairs.lost == 0 && !capped && !run.approximate() && !reference.sampled() && !every_light.pixels.empty())
    row.unshaded = missing_light(image, every_light);
  Image taken = run.take_image();
  if (!is_reference && !(m.shown && row.error->bit_identical)) report.images[place] = std::move(taken);
  m.shown |= is_reference;
  report.rows[place] = std::move(row);
  report.listed[place] = std::move(pairs.listed_of_pixel);
  if (!other_depth || report.lit.empty()) report.lit = std::move(pairs.lit_of_pixel);
}

namespace {

// The image of a row that has one, while the reference's is not in the report yet.
const Image& image_of(const CompareReport& report, size_t row, const Reference& reference) {
  return report.images[row].pixels.empty() ? reference.image : report.images[row];
}

}  // namespace

void hand_over_image(CompareReport& report, Measured& m) {
  if (!m.shown) return;
  const auto* contestant = std::get_if<RunOfContestant>(&m.reference.kind);
  (contestant ? report.images[contestant->row] : report.reference_image) = std::move(m.reference.image);
}

namespace {

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

// Each image against the mean over pixels' areas, where some row has several samples.
void measure_areas(CompareReport& report, const Compared& compared, Measured& m) {
  if (!m.has_samples) return;
  compared.tell(0.9, "oracle: 256 places a pixel");
  const AreaTruth truth = area_truth(m.reference.run().view(), m.shadows.occlusion());
  const double brightest = brightest_channel(m.reference.image), white = 1 / double(report.exposure.scale());
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].error)
      report.rows[i].error->area = area_error(image_of(report, i, m.reference), truth, brightest, white);
  }
}

}  // namespace

void measure_errors(CompareReport& report, const Compared& compared, Measured& m) {
  const size_t samples = compared.options.shaded_samples;
  compared.tell(0.9, "oracle: shading");
  // The oracle shades surfaces that OpenGL draws. Without it, what blended surfaces cover is not known.
  if (compared.renderer.gl) {
    measure_surfaces(report, m, measure_against_oracle(report, m, samples));
  } else if (m.reference.run().view().plan.surfaces.blended.empty()) {
    const size_t most = affordable_samples(samples, compared.gpu.scene());
    measure_surfaces(report, m, sample_pixels(covered_pixels(m.depth), most));
  }
  measure_areas(report, compared, m);
}

}  // namespace lightgrid::lab
