#include "study/compare.h"

#include "base/version.h"
#include "study/metrics.h"
#include "study/oracle.h"
#include "study/run_technique.h"

namespace lightgrid {
namespace {

void time_interleaved(std::vector<std::unique_ptr<TechniqueRun>>& runs, const CompareOptions& options) {
  const int rounds = options.warmup + options.frames;
  for (int round = 0; round < rounds; ++round) {
    for (auto& run : runs) {
      if (options.progress) options.progress(0.8 * round / rounds, run->technique().name);
      run->run_frame(round < options.warmup);
    }
  }
  for (auto& run : runs) run->run_profiled_frames();
}

}  // namespace

CompareReport compare_techniques(Devices& devices, const Scene& scene, const View& view,
                                 const std::vector<Contestant>& contestants, const CompareOptions& options) {
  CompareReport report;
  report.scene = scene.name;
  report.width = view.width, report.height = view.height;
  report.cl_device = devices.cl->info().name;
  report.gl_device = devices.gl->renderer;
  report.commit = commit_of_build();
  report.reference = "forward";

  std::vector<std::unique_ptr<TechniqueRun>> runs;
  for (const Contestant& c : contestants) {
    runs.push_back(std::make_unique<TechniqueRun>(devices, scene, view, c.settings, *c.technique));
  }
  time_interleaved(runs, options);

  std::unique_ptr<TechniqueRun> extra;
  TechniqueRun* reference = nullptr;
  for (auto& run : runs) {
    if (!reference && run->technique().name == report.reference) reference = run.get();
  }
  if (!reference) {
    extra = std::make_unique<TechniqueRun>(devices, scene, view, Settings{}, find_technique(report.reference));
    extra->run_frame();
    reference = extra.get();
  }

  if (options.progress) options.progress(0.8, "oracle: lit lights");
  const std::vector<float> depth = read_depth(reference->frame());
  for (auto& run : runs) {
    RunResult& row = report.rows.emplace_back(run->result());
    row.error = compare_images(run->image(), reference->image());
    LitPairs pairs = count_listed_pairs(*run, depth);
    row.pairs = {pairs.listed, pairs.lit, pairs.lost, pairs.wrong};
    report.images.push_back(run->image());
    report.listed.push_back(std::move(pairs.listed_of_pixel));
    report.lit = std::move(pairs.lit_of_pixel);
  }
  if (options.progress) options.progress(0.9, "oracle: shading");
  report.reference_errors = measure_reference_errors(reference->frame(), reference->image(), depth, options.shaded_samples);
  if (options.progress) options.progress(1, "");
  return report;
}

}  // namespace lightgrid
