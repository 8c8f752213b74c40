#include "compare/compare.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <fmt/format.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/version.h"
#include "compare/measured_rows.h"
#include "compare/moving.h"
#include "compare/runs.h"
#include "measures/metrics.h"
#include "oracle/position.h"

namespace lightgrid::lab {
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
  const auto hands_on = [&](const ContestantRun& e) { return e.run && !compared.every_light.is(*e.run); };
  const int rounds = options.warmup + options.frames;
  std::vector<size_t> order(entries.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::mt19937_64 random(options.seed);
  const auto tell = [&](int round, size_t i) {
    const double done = round + double(i) / double(entries.size());
    compared.tell(0.8 * done / (rounds + 1), entries[order[i]].contestant->technique->name);
  };
  for (int round = 0; round <= rounds; ++round) {
    // Timed passes are in random order and back, in turn: drifts cancel in ratios of frames.
    if (round >= options.warmup && round < rounds) {
      if ((round - options.warmup) % 2 == 0) {
        std::ranges::shuffle(order, random);
      } else {
        std::ranges::reverse(order);
      }
    }
    for (size_t i = 0; i < entries.size(); ++i) {
      tell(round, i);
      ContestantRun& entry = entries[order[i]];
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

RunResult refused_row(const ContestantRun& entry, const FrameFigures& reference) {
  RunResult row;
  row.technique = entry.contestant->technique->name;
  row.refused = entry.refusal->what();
  row.settings = settings_of(*entry.contestant->technique, entry.contestant->settings);
  row.lights_total = reference.lights_total;
  row.lights_in_view = reference.lights_in_view;
  return row;
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
  report.rows.resize(entries.size());
  report.images.resize(entries.size());
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

CompareReport measure(const Compared& compared) {
  const Scene& scene = compared.gpu.scene();
  const View& view = compared.view;
  CompareReport report;
  report.scene = scene.name;
  report.ambient = scene.ambient;
  report.width = view.width;
  report.height = view.height;
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

}  // namespace lightgrid::lab
