// Whether `lightgrid frontier` finds what is there: sweeps of two points, with all of the command's code. One
// is the baseline, forward_plus, as the controls. The other draws the same and first does nothing for 2 % of
// the time of a frame. Prints each sweep, and in how many of them the intervals hold 1 and 1.02, the
// estimates are within 1 % of these, and the 2 % are found.
//   known_difference [--device NAME] [SCENE [SIZE [SWEEPS [SECONDS]]]]    of a sweep; by default 20 of 22 s
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "frontier/answer.h"
#include "frontier/measure.h"

namespace lightgrid {
namespace {

constexpr double planted = 0.02;
double wait_ms = 0;  // before each frame of the second point

Frame render_late(RenderView& v) {
  const Timer timer;
  while (timer.elapsed_ms() < wait_ms) {
  }
  return find_technique("forward_plus").render(v);
}

double frame_ms(Renderer& renderer, const ChosenScene& chosen) {
  TechniqueRun run(renderer, chosen.scene, chosen.view, Settings{}, find_technique("forward_plus"));
  for (int frame = 0; frame < 35; ++frame) run.run_frame(frame < 5);
  return spread_of(run.frame_ms()).median;
}

struct Count {
  double truth;
  int sweeps = 0, held = 0, within = 0, above_one = 0;

  void add(const RelativeTime& t) {
    ++sweeps, held += t.low <= truth && truth <= t.high;
    within += std::abs(t.estimate / truth - 1) <= 0.01, above_one += t.low > 1;
  }
};

std::string in_words(const RelativeTime& t) {
  return fmt::format("{:.4f} ({:.4f} to {:.4f})", t.estimate, t.low, t.high);
}

int run(std::vector<std::string> arguments) {
  std::string device;
  if (arguments.size() > 1 && arguments[0] == "--device") {
    device = arguments[1];
    arguments.erase(arguments.begin(), arguments.begin() + 2);
  }
  const auto argument = [&](size_t i, const char* other) {
    return arguments.size() > i ? arguments[i] : other;
  };
  SceneChoice choice;
  choice.scene = argument(0, "hall"), choice.size = argument(1, "320x180");
  const int sweeps = std::atoi(argument(2, "20").c_str());
  Renderer renderer(device, GlBackend::automatic);
  const ChosenScene chosen = load_chosen_scene(choice);

  Technique late = find_technique("forward_plus");
  late.name = "late", late.render = render_late;
  FrontierJob job;
  job.baseline = baseline_point({}, true);
  job.points.resize(1);
  job.points[0].contestant.technique = &late, job.points[0].label = late.name;
  job.views = 1, job.growth = false, job.shaded_pairs = 100'000;
  job.seconds = std::atof(argument(3, "22").c_str());
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("known_difference.{}", getpid());
  std::filesystem::create_directories(folder);

  Count itself{1}, two_per_cent{1 + planted};
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Timer timer;
    job.seed = uint64_t(sweep) + 1;
    wait_ms = planted * frame_ms(renderer, chosen);
    FrontierPart part;
    part.seed = job.seed, part.baseline = job.baseline.label, part.machine = machine_of(renderer);
    std::filesystem::remove(part_path(folder, 0, 1));
    RecordFile file(part_path(folder, 0, 1), part, nullptr);
    measure_scene(renderer, choice, job, file);
    const FrontierAnswer answer = answer_of({file.part()});
    const RelativeTime control = answer.controls.at(0).relative_time,
                       point = answer.points.at(0).relative_time;
    itself.add(control), two_per_cent.add(point);
    fmt::print("{:2}: itself {}, 2 % longer {}, {} rounds, {:.0f} s\n", sweep + 1, in_words(control),
               in_words(point), control.runs, timer.elapsed_ms() / 1000);
    std::fflush(stdout);
  }
  std::filesystem::remove_all(folder);
  fmt::print(
      "of {}: itself: {} hold 1, {} within 1 %; 2 % longer: {} hold 1.02, {} within 1 % of it, {} found "
      "(the interval is above 1)\n",
      itself.sweeps, itself.held, itself.within, two_per_cent.held, two_per_cent.within,
      two_per_cent.above_one);
  return 0;
}

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) {
  try {
    return lightgrid::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
