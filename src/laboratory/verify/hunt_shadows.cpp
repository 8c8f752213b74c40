#include "verify/hunt_shadows.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/timer.h"
#include "plan/settings/kernels.h"
#include "verify/check.h"
#include "verify/hunt_sequences.h"

namespace lightgrid::lab::verify {
namespace {

class ShadowHunt {
 public:
  ShadowHunt(CullEngine& engine, const HuntOptions& options)
      : engine_(engine), options_(options), classes_(chosen_shadow_classes(options.filter)) {
    report_.device = engine.name();
    report_.seed = options.seed;
    for (const ShadowHuntClass& hunted : classes_) report_.classes.push_back({.name = hunted.name});
  }

  ShadowHuntReport run() {
    for (uint64_t i = 0; part_done() < 1; ++i) {
      const size_t at = i % classes_.size();
      if (options_.progress) options_.progress(std::min(part_done(), 0.999), classes_[at].name);
      look(classes_[at], report_.classes[at], options_.seed + i);
    }
    if (options_.progress) options_.progress(1, "done");
    report_.seconds = timer_.elapsed_ms() / 1000;
    return report_;
  }

 private:
  double part_done() const {
    if (options_.contacts) return double(decided_) / double(options_.contacts);
    return timer_.elapsed_ms() / 60'000 / options_.minutes;
  }

  void look(const ShadowHuntClass& hunted, ShadowHuntTally& tally, uint64_t seed) {
    const Timer timer;
    const HuntedScene made = hunted_scene(hunted, seed);
    try {
      const bool images = compare(tally, made, seed),
                 frames = !sequence_is_due() || follow(tally, made, seed);
      if (!images || !frames) tally.failed.push_back(seed);
    } catch (const Error& error) {
      if (tally.refused++ == 0) tally.refusal = fmt::format("seed {}: {}", seed, error.what());
      tally.failed.push_back(seed);
    }
    tally.seconds += timer.elapsed_ms() / 1000;
  }

  // Returns whether all is right.
  bool compare(ShadowHuntTally& tally, const HuntedScene& made, uint64_t seed) {
    Random random(seed);
    Settings settings;
    settings.set(setting::everything_on, random.next() % 4 == 0);
    settings.set(setting::portable, random.next() % 4 == 0);
    const std::vector<ShadowImage> images = engine_.shadows(made.scene, made.views, settings);
    if (images.empty()) throw input_error("the engine finds no shadows");
    std::vector<ShadowImage> by_others;
    if (random.next() % 16 == 0) {
      Settings lanes = settings, group = settings;
      lanes.set(setting::kernel_shape, KernelShape::lanes);
      group.set(setting::kernel_shape, KernelShape::group);
      by_others = engine_.shadows(made.scene, made.views, lanes);
      for (ShadowImage& image : engine_.shadows(made.scene, made.views, group))
        by_others.push_back(std::move(image));
    }
    bool right = true;
    const Occlusion occlusion(made.scene);
    for (size_t i = 0; i < images.size(); ++i) {
      ShadowPairs pairs = count_shadow_pairs(made.scene, occlusion, made.views[i], images[i]);
      if (!pairs.why.empty()) pairs.why = fmt::format("seed {}, view {}: {}", seed, i, pairs.why);
      right = right && pairs.wrong() == 0;
      decided_ += pairs.decided();
      tally.pairs += pairs;
      ++tally.views;
    }
    for (size_t i = 0; i < by_others.size(); ++i) {
      const std::string differ = difference(by_others[i], images[i % images.size()]);
      if (differ.empty()) continue;
      right = false;
      ++tally.shapes_differ;
      if (tally.refusal.empty())
        tally.refusal = fmt::format("seed {}, view {}: the kernel shapes' {} differ", seed, i, differ);
    }
    return right;
  }

  // Sequences need many kernels, which one thread compiles, and decide few pairs.
  bool sequence_is_due() const {
    constexpr double max_part = 0.25;  // of the time
    return options_.contacts || sequences_ms_ < max_part * timer_.elapsed_ms();
  }

  // A sequence of frames from the scene on. Whether all is right.
  bool follow(ShadowHuntTally& tally, const HuntedScene& made, uint64_t seed) {
    const Timer timer;
    Random random(Random::mix(~seed));
    const std::span<const SequenceKind> kinds = sequence_kinds();
    const SequenceKind& kind = kinds[random.next() % kinds.size()];
    Settings settings = settings_with(kind.settings);
    settings.set(setting::portable, random.next() % 8 == 0);
    settings.set(setting::everything_on, random.next() % 16 == 0);
    SequenceReport report = compare_sequence(engine_, made, kind, settings, options_.frames, random);
    tally.frames += report.frames;
    tally.stale += report.stale;
    if (report.stale > 0 && tally.refusal.empty())
      tally.refusal = fmt::format("seed {}, {}", seed, report.why);
    if (!report.pairs.why.empty())
      report.pairs.why = fmt::format("seed {}, the last frame: {}", seed, report.pairs.why);
    tally.pairs += report.pairs;
    decided_ += report.pairs.decided();
    sequences_ms_ += timer.elapsed_ms();
    return report.stale == 0 && report.pairs.wrong() == 0;
  }

  CullEngine& engine_;
  const HuntOptions& options_;
  const std::vector<ShadowHuntClass> classes_;
  const Timer timer_;
  ShadowHuntReport report_;
  uint64_t decided_ = 0;
  double sequences_ms_ = 0;
};

nlohmann::ordered_json json_of(const ShadowHuntTally& t) {
  return {{"name", t.name},           {"pairs", t.pairs.decided()}, {"hidden", t.pairs.hidden},
          {"either", t.pairs.either}, {"leaked", t.pairs.leaked},   {"acned", t.pairs.acned},
          {"views", t.views},         {"refused", t.refused},       {"shapes_differ", t.shapes_differ},
          {"frames", t.frames},       {"stale", t.stale},           {"seconds", t.seconds},
          {"failed_seeds", t.failed}, {"why", t.pairs.why},         {"refusal", t.refusal}};
}

}  // namespace

ShadowHuntTally ShadowHuntReport::total() const {
  ShadowHuntTally sum{.name = "all"};
  for (const ShadowHuntTally& t : classes) {
    sum.pairs += t.pairs;
    sum.views += t.views;
    sum.refused += t.refused;
    sum.shapes_differ += t.shapes_differ;
    sum.seconds += t.seconds;
    sum.frames += t.frames;
    sum.stale += t.stale;
    sum.failed.insert(sum.failed.end(), t.failed.begin(), t.failed.end());
    if (sum.refusal.empty()) sum.refusal = t.refusal;
  }
  return sum;
}

bool ShadowHuntReport::failed() const { return !total().failed.empty(); }

ShadowHuntReport hunt_shadows(CullEngine& engine, const HuntOptions& options) {
  return ShadowHunt(engine, options).run();
}

nlohmann::ordered_json to_json(const ShadowHuntReport& report) {
  nlohmann::ordered_json json = {
      {"device", report.device}, {"seed", report.seed}, {"seconds", report.seconds}};
  nlohmann::ordered_json all = json_of(report.total());
  all.erase("name");
  all.erase("seconds");
  json.update(all);
  json["classes"] = nlohmann::ordered_json::array();
  for (const ShadowHuntTally& tally : report.classes) json["classes"].push_back(json_of(tally));
  return json;
}

}  // namespace lightgrid::lab::verify
