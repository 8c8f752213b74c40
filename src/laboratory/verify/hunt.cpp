#include "verify/hunt.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "base/write_file.h"
#include "culling/view_depth.h"
#include "frames/frame_file.h"
#include "plan/settings.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "verify/check.h"
#include "verify/chosen_by_name.h"

namespace lightgrid::lab::verify {
namespace {

constexpr int views_a_setting = 8;       // for each class, because a new setting may require kernel builds
constexpr int max_saved = 3;             // for each class
constexpr size_t lights_in_both = 4096;  // limit per view if both shapes run: the other one may be slow

struct HuntLoss {
  HuntContact contact;
  LostFrom from = LostFrom::list;
};

constexpr size_t contacts_at_once = 4096;

// Contacts whose light is missing from the list (or the mask, or the z-bin) that shading finds for the pixel.
std::vector<HuntLoss> lost_contacts(const HuntView& view, std::span<const HuntContact> contacts, int tile,
                                    const HostGrid& grid) {
  const ListFinder finder(view.view, tile, grid);
  std::vector<std::vector<HuntLoss>> parts((contacts.size() + contacts_at_once - 1) / contacts_at_once);
  parallel_for(int(parts.size()), [&](int i) {
    for (size_t k = size_t(i) * contacts_at_once;
         k < std::min(contacts.size(), size_t(i + 1) * contacts_at_once); ++k) {
      const HuntContact& c = contacts[k];
      if (const auto from = finder.lost_from(c.x, c.y, c.depth, c.light)) parts[i].push_back({c, *from});
    }
  });
  std::vector<HuntLoss> lost;
  for (const auto& part : parts) lost.insert(lost.end(), part.begin(), part.end());
  return lost;
}

// The remaining lights, with the lost one among them: usually it alone, else with the others that the loss
// requires.
struct ShrunkLoss {
  std::vector<Light> lights;
  HuntLoss lost;
  HostGrid grid;  // grid of these lights
};
constexpr int max_runs = 200;  // runs of the culler to shrink one loss

// With the grid of these lights; empty if the contact is found.
std::optional<ShrunkLoss> still_lost(CullEngine& engine, const CullerOptions& options, const HuntView& view,
                                     ShrunkLoss less) {
  less.grid = engine.cull_depth(options, view.view, cull_lights(less.lights), view.depth, view.blended);
  const auto lost = lost_contacts(view, {&less.lost.contact, 1}, options.tile, less.grid);
  if (lost.empty()) return {};
  less.lost = lost[0];
  return less;
}

// The lost light, and the others outside [begin, end).
ShrunkLoss without(const ShrunkLoss& loss, size_t begin, size_t end) {
  ShrunkLoss less{{}, loss.lost, {}};
  for (size_t i = 0; i < loss.lights.size(); ++i) {
    const bool own = i == loss.lost.contact.light;
    if (own) less.lost.contact.light = uint32_t(less.lights.size());
    if (own || i < begin || i >= end) less.lights.push_back(loss.lights[i]);
  }
  return less;
}

CapturedFrame frame_of(const HuntSetting& setting, const HuntView& h, const ShrunkLoss& loss) {
  CapturedFrame frame;
  frame.view = oracle_view(h.view);
  const bool oblique = is_oblique(h.view);
  frame.view.near_m = oblique ? h.near : near_distance(h.view);
  frame.view.far_m = oblique ? no_end : distance_at(h.view, has_standard_depth(h.view) ? 1 : 0);
  frame.tile = setting.options.tile;
  frame.surfaces_far_m = h.far;
  frame.lights = loss.lights;
  for (size_t i = loss.lost.contact.sample; i < h.depth.values.size(); i += size_t(h.depth.samples)) {
    frame.depth.push_back(h.depth.values[i]);
  }
  return frame;
}

FrameGrid grid_of(const HuntSetting& setting, const HuntView& h, const ShrunkLoss& loss) {
  const CullerOptions& o = setting.options;
  Settings s;
  s.set(setting::cull_test, o.cull_test);
  s.set(setting::depth_bounds, o.depth_bounds);
  s.set(setting::tile, o.tile);
  s.set(setting::grid_lists, o.lists);
  s.set(setting::slices, setting.slices);
  s.set(setting::slice_spacing, setting.spacing);
  s.set(setting::z_bins, setting.z_bins);
  s.set(setting::kernel_shape, o.shape);
  s.set(setting::portable, o.portable);
  return {loss.grid, o.tile, h.view.slice_edges, h.view.z_bin_edges, to_strings(s)};
}

// Names the parts of the view that a replay of the frame does not see.
std::string words_of_absent(const HuntView& h) {
  std::string words;
  if (h.blended) words += "the frame lacks the blended surface that the depth is of\n";
  if (is_oblique(h.view)) words += "the frame has an oblique near plane and is refused when read\n";
  return words;
}

// Reduces the loss to the fewest lights that still lose one.
ShrunkLoss shrink_loss(CullEngine& engine, const CullerOptions& options, const HuntView& view,
                       const std::vector<Light>& lights, const HuntLoss& lost) {
  ShrunkLoss loss{lights, lost, {}};
  // First alone, then without ever smaller parts (Zeller, Hildebrandt, "Simplifying and Isolating
  // Failure-Inducing Input", 2002).
  int runs = 0;
  for (size_t part = loss.lights.size(); part > 0 && runs < max_runs; part = part == 1 ? 0 : (part + 1) / 2) {
    for (size_t begin = 0; begin < loss.lights.size() && runs < max_runs;) {
      ShrunkLoss less = without(loss, begin, begin + part);
      const bool smaller = less.lights.size() < loss.lights.size();
      runs += smaller;
      const auto shrunk = smaller ? still_lost(engine, options, view, std::move(less)) : std::nullopt;
      if (shrunk)
        loss = *shrunk;
      else
        begin += part;
    }
  }
  if (const auto again = still_lost(engine, options, view, loss)) return *again;
  return loss;
}

// A captured frame (docs/frames.md) with its grid (slices and z-bins included), and hunt.txt: the setting,
// the class, the seed and the lost contact as text. Returns the folder. A frame cannot store samples other
// than the contact's, cells of whole pixels, blended surfaces and the width of indices.
std::filesystem::path save_loss(const std::filesystem::path& folder, const HuntSetting& setting,
                                const HuntView& h, const ShrunkLoss& loss, uint64_t seed) {
  const std::filesystem::path path = folder / fmt::format("{}_{:016x}", name_of(h.hunted), seed);
  write_frame(path, frame_of(setting, h, loss));
  write_frame_grid(path, grid_of(setting, h, loss));
  const HuntContact& c = loss.lost.contact;
  write_file(path / "hunt.txt",
             fmt::format("class {}, seed {}\nsetting {}\nlost from its {}: light {} at pixel {},{} ({},{} in "
                         "it), sample {}, depth {:.9g}\n{}",
                         name_of(h.hunted), seed, to_string(setting), name_of(loss.lost.from), c.light, c.x,
                         c.y, c.in_x, c.in_y, c.sample, c.depth, words_of_absent(h)));
  return path;
}

std::vector<HuntClass> chosen_classes(const std::string& filter) {
  std::vector<HuntClass> all;
  for (int i = 0; i < hunt_class_count; ++i) all.push_back(HuntClass(i));
  return chosen_by_name(
      all, filter, [](HuntClass c) { return name_of(c); }, "class of the hunt", "wide or off_centre");
}

class Hunt {
 public:
  Hunt(CullEngine& engine, const HuntOptions& options) : engine_(engine), options_(options) {
    report_.device = engine.name();
    report_.seed = options.seed;
    for (const HuntClass hunted : chosen_classes(options.filter)) {
      classes_.push_back(hunted);
      report_.classes.push_back({.name = name_of(hunted)});
    }
    saved_.resize(classes_.size());
    cpu_ns_.resize(classes_.size());
  }

  HuntReport run() {
    for (uint64_t round = 0; !done(); ++round) {
      Random random(Random::mix(options_.seed) + round);
      HuntSetting setting = random_setting(random, options_.few_settings);
      for (size_t i = 0; i < views_a_setting * classes_.size() && !done(); ++i) {
        vary(setting, random);
        tell(setting);
        look(i % classes_.size(), setting, random.next());
      }
    }
    if (options_.progress) options_.progress(1, "done");
    report_.seconds = timer_.elapsed_ms() / 1000;
    for (size_t i = 0; i < classes_.size(); ++i)
      report_.classes[i].cpu_ns_each = spread_of(cpu_ns_[i]).median;
    return report_;
  }

 private:
  double part_done() const {
    if (options_.contacts) return double(contacts_) / double(options_.contacts);
    return timer_.elapsed_ms() / 60'000 / options_.minutes;
  }
  bool done() const { return part_done() >= 1; }

  void tell(const HuntSetting& setting) const {
    if (options_.progress) options_.progress(std::min(part_done(), 0.999), to_string(setting));
  }

  void look(size_t at, HuntSetting setting, uint64_t seed) {
    HuntTally& tally = report_.classes[at];
    const Timer timer;
    const std::clock_t cpu = std::clock();
    const HuntView view = random_view(classes_[at], setting, seed);
    setting.options.depth_format = view.format;
    setting.options.blend = view.blended;
    const size_t count =
        setting.both_shapes ? std::min(lights_in_both, options_.lights_a_view) : options_.lights_a_view;
    const HuntLights lights = random_contacts(view, setting, count, Random::mix(seed));
    ++tally.views;
    try {
      ask(tally, saved_[at], view, setting, lights, seed);
    } catch (const Error& error) {
      if (tally.refused++ == 0) tally.refusal = error.what();
    }
    tally.seconds += timer.elapsed_ms() / 1000;
    const double cpu_ns = double(std::clock() - cpu) * 1e9 / CLOCKS_PER_SEC;
    if (!lights.contacts.empty()) cpu_ns_[at].push_back(cpu_ns / double(lights.contacts.size()));
  }

  void ask(HuntTally& tally, int& saved, const HuntView& view, const HuntSetting& setting,
           const HuntLights& lights, uint64_t seed) {
    const std::vector<CullLight> culled = cull_lights(lights.lights);
    const HostGrid grid = engine_.cull_depth(setting.options, view.view, culled, view.depth, view.blended);
    const std::vector<HuntLoss> lost = lost_contacts(view, lights.contacts, setting.options.tile, grid);
    tally.contacts += lights.contacts.size();
    contacts_ += lights.contacts.size();
    if (setting.both_shapes && engine_.has_both_shapes()) compare_shapes(tally, view, setting, culled, grid);
    if (lost.empty()) return;
    if (tally.lost == 0) tally.why = words(setting, view, lights, lost[0], seed);
    tally.lost += lost.size();
    if (options_.save.empty() || saved >= max_saved) return;
    const ShrunkLoss loss = shrink_loss(engine_, setting.options, view, lights.lights, lost[0]);
    report_.saved.push_back(save_loss(options_.save, setting, view, loss, seed).string());
    ++saved;
  }

  void compare_shapes(HuntTally& tally, const HuntView& view, const HuntSetting& setting,
                      std::span<const CullLight> lights, const HostGrid& grid) {
    CullerOptions lanes = setting.options, group = setting.options;
    lanes.shape = KernelShape::lanes;
    group.shape = KernelShape::group;
    for (const CullerOptions& shaped : {lanes, group}) {
      if (engine_.cull_depth(shaped, view.view, lights, view.depth, view.blended) == grid) continue;
      ++tally.shapes_differ;
      if (tally.why.empty()) tally.why = "lanes and group differ: " + to_string(setting);
    }
  }

  static std::string words(const HuntSetting& setting, const HuntView& view, const HuntLights& lights,
                           const HuntLoss& loss, uint64_t seed) {
    const HuntContact& c = loss.contact;
    const Light& light = lights.lights[c.light];
    const glm::dvec3 p = *position_of(view, c), l = to_view(view.view, light.position);
    return fmt::format(
        "seed {}, {}: pixel {},{} at {:.9g} {:.9g} {:.9g} lost from its {} the {} at {:.9g} {:.9g} {:.9g} "
        "radius {:.9g}",
        seed, to_string(setting), c.x, c.y, p.x, p.y, p.z, name_of(loss.from), name_of(light.type), l.x, l.y,
        l.z, light.radius_m);
  }

  CullEngine& engine_;
  const HuntOptions& options_;
  const Timer timer_;
  HuntReport report_;
  uint64_t contacts_ = 0;
  std::vector<HuntClass> classes_;
  std::vector<int> saved_;                   // number for each class
  std::vector<std::vector<double>> cpu_ns_;  // by class and contact: a value per view
};

}  // namespace

HuntTally HuntReport::total() const {
  HuntTally sum{.name = "all"};
  for (const HuntTally& t : classes) {
    sum.contacts += t.contacts;
    sum.lost += t.lost;
    sum.views += t.views;
    sum.refused += t.refused;
    sum.shapes_differ += t.shapes_differ;
    sum.seconds += t.seconds;
  }
  return sum;
}

bool HuntReport::failed() const {
  const HuntTally sum = total();
  return sum.lost || sum.refused || sum.shapes_differ;
}

HuntReport hunt(CullEngine& engine, const HuntOptions& options) { return Hunt(engine, options).run(); }

nlohmann::ordered_json to_json(const HuntReport& report) {
  const HuntTally sum = report.total();
  nlohmann::ordered_json json = {{"device", report.device},   {"seed", report.seed},
                                 {"contacts", sum.contacts},  {"lost", sum.lost},
                                 {"refused", sum.refused},    {"shapes_differ", sum.shapes_differ},
                                 {"seconds", report.seconds}, {"classes", nlohmann::ordered_json::array()},
                                 {"saved", report.saved}};
  for (const HuntTally& t : report.classes) {
    json["classes"].push_back({{"name", t.name},
                               {"contacts", t.contacts},
                               {"lost", t.lost},
                               {"views", t.views},
                               {"refused", t.refused},
                               {"shapes_differ", t.shapes_differ},
                               {"seconds", t.seconds},
                               {"cpu_ns_each", t.cpu_ns_each},
                               {"why", t.why},
                               {"refusal", t.refusal}});
  }
  return json;
}

}  // namespace lightgrid::lab::verify
