#include "study/compare.h"

#include <new>

#include "base/version.h"
#include "cl/error.h"
#include "study/metrics.h"
#include "study/oracle.h"
#include "study/run_technique.h"

namespace lightgrid {
namespace {

// A contestant's run, until the technique or the machine refuses.
struct Entry {
  const Contestant* contestant;
  std::unique_ptr<TechniqueRun> run;
  std::optional<Error> refusal;
};

// Does `work`; a refusal ends the entry's run, unless it is kept, and its reason is recorded.
template <typename Work>
void attempt(Entry& entry, const Work& work, bool ends_run = true) {
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

std::vector<Entry> make_entries(Devices& devices, const Scene& scene, const View& view,
                                const std::vector<Contestant>& contestants) {
  std::vector<Entry> entries;
  for (const Contestant& c : contestants) {
    Entry& entry = entries.emplace_back(&c);
    attempt(entry, [&] { entry.run = std::make_unique<TechniqueRun>(devices, scene, view, c.settings, *c.technique); });
  }
  return entries;
}

void time_interleaved(std::vector<Entry>& entries, const CompareOptions& options) {
  const int rounds = options.warmup + options.frames;
  const auto tell = [&](int round, size_t i) {
    const double done = round + double(i) / double(entries.size());
    if (options.progress) options.progress(0.8 * done / (rounds + 1), entries[i].contestant->technique->name);
  };
  for (int round = 0; round <= rounds; ++round) {
    for (size_t i = 0; i < entries.size(); ++i) {
      tell(round, i);
      TechniqueRun* run = entries[i].run.get();
      attempt(entries[i], [&] { round < rounds ? run->run_frame(round < options.warmup) : run->run_profiled_frames(); });
    }
  }
}

// Where nothing ran there is nothing to report but the first reason.
void require_one(const std::vector<Entry>& entries) {
  for (const Entry& entry : entries) {
    if (entry.run) return;
  }
  if (!entries.empty()) throw *entries.front().refusal;
}

RunResult refused_row(const Entry& entry, const RunResult& reference) {
  RunResult row;
  row.technique = entry.contestant->technique->name;
  row.refused = entry.refusal->what();
  row.settings = settings_of(*entry.contestant->technique, entry.contestant->settings);
  row.lights_total = reference.lights_total, row.lights_in_view = reference.lights_in_view;
  return row;
}

// All or nothing: the lists of lights may be more than memory holds.
void add_row(CompareReport& report, TechniqueRun& run, const Image& reference, const std::vector<float>& depth) {
  RunResult row = run.result();
  row.error = compare_images(run.image(), reference);
  LitPairs pairs = count_listed_pairs(run, depth);
  row.pairs = {pairs.listed, pairs.lit, pairs.lost, pairs.wrong};
  if (run.technique().limited_lists) row.overflow = pairs.lost;
  Image image = run.image();
  report.rows.push_back(std::move(row));
  report.images.push_back(std::move(image));
  report.listed.push_back(std::move(pairs.listed_of_pixel));
  report.lit = std::move(pairs.lit_of_pixel);
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

  std::vector<Entry> entries = make_entries(devices, scene, view, contestants);
  time_interleaved(entries, options);
  if (!options.all_may_refuse) require_one(entries);

  std::unique_ptr<TechniqueRun> extra;
  TechniqueRun* reference = nullptr;
  for (Entry& entry : entries) {
    if (!reference && entry.run && entry.run->technique().name == report.reference) reference = entry.run.get();
  }
  if (!reference) {
    const Settings common = contestants.empty() ? Settings{} : contestants.front().settings;  // the same BRDF above all
    extra = std::make_unique<TechniqueRun>(devices, scene, view, common, find_technique(report.reference));
    extra->run_frame();
    reference = extra.get();
    report.reference_image = extra->image();
  }

  const std::vector<float> depth = read_depth(reference->frame());
  for (size_t i = 0; i < entries.size(); ++i) {
    Entry& entry = entries[i];
    if (options.progress) options.progress(0.8 + 0.1 * double(i) / double(entries.size()), "oracle: lit lights");
    // What refuses here keeps its run: it may be the reference.
    if (entry.run) attempt(entry, [&] { add_row(report, *entry.run, reference->image(), depth); }, false);
    if (entry.refusal) {
      report.rows.push_back(refused_row(entry, reference->result()));
      report.images.emplace_back(), report.listed.emplace_back();
    }
  }
  if (options.progress) options.progress(0.9, "oracle: shading");
  report.reference_errors = measure_reference_errors(reference->frame(), reference->image(), depth, options.shaded_samples);
  if (options.progress) options.progress(1, "");
  return report;
}

}  // namespace lightgrid
