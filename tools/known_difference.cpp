// Tests whether `lightgrid frontier` finds known ratios: sweeps of two points, with all of the command's
// code. One is the baseline, forward_plus, as the controls. The other draws the same and first does nothing
// for 2 % of the time of a frame; where times are of the devices' clocks, a kernel does, of which one work
// item counts. Prints each sweep, and in how many of them the intervals contain 1 and 1.02, the estimates are
// within 1 % of these, and the 2 % are found.
//   known_difference [--device NAME] [--clock wall|device] [SCENE [SIZE [SWEEPS [SECONDS]]]]
// of a sweep; by default 20 of 22 s by the wall's clock.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "cl/launch.h"
#include "frontier/answer.h"
#include "frontier/measure.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr double planted = 0.02;
// Before each frame of the second point:
double wait_ms = 0;
cl_uint steps = 0;  // the kernel's; 0: none
cl::Kernel count_up;
cl::Buffer counted;

constexpr char kernel_text[] = R"(
kernel void count_up(global uint* out, uint steps) {
  uint x = steps;
  for (uint i = 0; i < steps; ++i) x = x * 1664525u + 1013904223u;
  *out = x;
})";

void make_kernel(ClDevice& device) {
  cl::Program program(device.context(), kernel_text);
  program.build();
  count_up = cl::Kernel(program, "count_up");
  counted = cl::Buffer(device.context(), CL_MEM_READ_WRITE, sizeof(cl_uint));
}

Frame render_late(RenderView& v) {
  const Timer timer;
  while (timer.elapsed_ms() < wait_ms) {
  }
  if (steps > 0) launch(*v.renderer.cl, "count_up", count_up, cl::NDRange(1), cl::NDRange(1), counted, steps);
  return find_technique("forward_plus").render(v);
}

// By the wall or, with a clock, by the devices'.
double frame_ms(Renderer& renderer, const ChosenScene& chosen, DeviceClock* clock,
                const Technique& technique) {
  TechniqueRun run(renderer, chosen.scene, chosen.view, Settings{}, technique);
  std::vector<double> of_devices;
  for (int frame = 0; frame < 35; ++frame) {
    if (clock) clock->start();
    run.run_frame(frame < 5);
    if (!clock) continue;
    const std::optional<DeviceTimes> times = clock->stop();
    if (!times) throw machine_error("known_difference: no clock of the devices here");
    if (frame >= 5) of_devices.push_back(times->device_ms);
  }
  return spread_of(clock ? of_devices : run.frame_ms()).median;
}

// So many steps that the kernel takes so long: of two measured numbers of them.
cl_uint steps_of(double ms, Renderer& renderer, const ChosenScene& chosen, const Technique& late) {
  constexpr cl_uint many = 200'000;
  DeviceClock clock(renderer);
  steps = 0;
  const double without = frame_ms(renderer, chosen, &clock, late);
  steps = many;
  const double with = frame_ms(renderer, chosen, &clock, late);
  return cl_uint(ms / (with - without) * many);
}

// The baseline's time by the devices' clocks, as in the rounds of a sweep: between frames of others.
double baseline_device_ms(const FrontierPart& part) {
  std::vector<double> all;
  for (const FrontierRecord& r : part.records)
    all.insert(all.end(), r.baseline_device_ms.begin(), r.baseline_device_ms.end());
  if (all.empty()) throw machine_error("known_difference: no clock of the devices here");
  return spread_of(all).median;
}

struct Count {
  double truth;
  int sweeps = 0, held = 0, within = 0, above_one = 0;

  void add(const RelativeTime& t) {
    ++sweeps;
    held += t.low <= truth && truth <= t.high;
    within += std::abs(t.estimate / truth - 1) <= 0.01;
    above_one += t.low > 1;
  }
};

std::string in_words(const RelativeTime& t) {
  return fmt::format("{:.4f} ({:.4f} to {:.4f})", t.estimate, t.low, t.high);
}

int run(std::vector<std::string> arguments) {
  std::string device, clock_name = "wall";
  while (arguments.size() > 1 && (arguments[0] == "--device" || arguments[0] == "--clock")) {
    (arguments[0] == "--device" ? device : clock_name) = arguments[1];
    arguments.erase(arguments.begin(), arguments.begin() + 2);
  }
  if (clock_name != "wall" && clock_name != "device")
    throw input_error("--clock {}: wall or device", clock_name);
  const bool by_device = clock_name == "device";
  const auto argument = [&](size_t i, const char* other) {
    return arguments.size() > i ? arguments[i] : other;
  };
  SceneChoice choice;
  choice.scene = argument(0, "hall");
  choice.size = argument(1, "320x180");
  const int sweeps = std::atoi(argument(2, "20").c_str());
  Renderer renderer(device, GlBackend::automatic);
  const ChosenScene chosen = load_chosen_scene(choice);

  Technique late = find_technique("forward_plus");
  late.name = "late";
  late.render = render_late;
  FrontierJob job;
  job.baseline = baseline_point({}, true);
  job.points.resize(1);
  job.points[0].contestant.technique = &late;
  job.points[0].label = late.name;
  job.views = 1;
  job.growth = false;
  job.shaded_pairs = 100'000;
  job.seconds = std::atof(argument(3, "22").c_str());
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("known_difference.{}", getpid());
  std::filesystem::create_directories(folder);

  if (by_device) make_kernel(*renderer.cl);
  Count itself{1}, two_per_cent{1 + planted};
  const auto sweep_of = [&](int seed) {
    job.seed = uint64_t(seed);
    FrontierPart part;
    part.seed = job.seed;
    part.baseline = job.baseline.label;
    part.machine = machine_of(renderer);
    std::filesystem::remove(part_path(folder, 0, 1));
    RecordFile file(part_path(folder, 0, 1), part, nullptr);
    measure_scene(renderer, choice, job, file);
    return answer_of({file.part()});
  };
  if (by_device)  // a first sweep, which does not count
    steps = steps_of(planted * baseline_device_ms(sweep_of(0).part), renderer, chosen, late);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Timer timer;
    if (!by_device) wait_ms = planted * frame_ms(renderer, chosen, nullptr, find_technique("forward_plus"));
    const FrontierAnswer answer = sweep_of(sweep + 1);
    const RelativeTime control = (by_device ? answer.device_controls : answer.controls).at(0).relative_time,
                       point = by_device ? answer.points.at(0).device.relative_time
                                         : answer.points.at(0).relative_time;
    itself.add(control);
    two_per_cent.add(point);
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
