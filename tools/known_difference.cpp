// Tests whether `lightgrid frontier` finds known ratios: sweeps with all of the command's code, of the baseline
// against itself (a control) and against points that draw the same and take 2 % longer.
//
// Where wall-clock and processor time are tested there are two such points. After each of its frames, in the
// random order of the rounds, one waits for 2 % of that frame's wall-clock time, the other for 2 % of its
// processor time. Where times are of the devices' clocks, a kernel of one work item does, before the frame.
// Prints each sweep, and in how many of them the intervals contain 1 and 1.02, the estimates are within 1 % of
// these, and the 2 % are found.
//   known_difference [--device NAME] [--clock host|device] [--technique NAME] [SCENE [SIZE [SWEEPS [SECONDS]]]]
// by default 20 sweeps of 22 s of forward_plus by the host's clocks.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "base/cpu_clock.h"
#include "base/error.h"
#include "cl/launch.h"
#include "frontier/answer.h"
#include "frontier/measure.h"
#include "gl/bindings.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr double planted = 0.02;
const Technique* tested = nullptr;
// Before each frame of the second point:
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

Frame render_with_kernel(RenderView& v) {
  if (steps > 0) launch(*v.renderer.cl, "count_up", count_up, cl::NDRange(1), cl::NDRange(1), counted, steps);
  return tested->render(v);
}

double wall_ms() {
  static const Timer timer;
  return timer.elapsed_ms();
}

// Takes longer by this clock. Waits for the devices first, so that their work is part of the frame's time; so
// does the baseline, which is not longer.
template <double (*now_ms)(), bool longer = true>
Frame render_late(RenderView& v) {
  const double begun_ms = now_ms();
  Frame frame = tested->render(v);
  v.renderer.cl->queue().finish();
  if (v.renderer.gl) glFinish();
  const double drawn_ms = now_ms();
  while (longer && now_ms() - drawn_ms < planted * (drawn_ms - begun_ms)) {
  }
  return frame;
}

Technique late_technique(const char* name, Frame (*render)(RenderView&)) {
  Technique late = *tested;
  late.name = name;
  late.render = render;
  return late;
}

// The frame's time by the devices' clocks.
double frame_ms(Renderer& renderer, const ChosenScene& chosen, DeviceClock& clock,
                const Technique& technique) {
  TechniqueRun run(renderer, chosen.scene, chosen.view, Settings{}, technique);
  std::vector<double> of_devices;
  for (int frame = 0; frame < 35; ++frame) {
    clock.start();
    run.run_frame(frame < 5);
    const std::optional<DeviceTimes> times = clock.stop();
    if (!times) throw machine_error("known_difference: no clock of the devices here");
    if (frame >= 5) of_devices.push_back(times->device_ms);
  }
  return spread_of(of_devices).median;
}

// So many steps that the kernel takes so long: of two measured numbers of them.
cl_uint steps_of(double ms, Renderer& renderer, const ChosenScene& chosen, const Technique& late) {
  constexpr cl_uint many = 200'000;
  DeviceClock clock(renderer);
  steps = 0;
  const double without = frame_ms(renderer, chosen, clock, late);
  steps = many;
  const double with = frame_ms(renderer, chosen, clock, late);
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

// The sweeps by one clock.
struct ByClock {
  const char* name;
  Count itself{1}, two_per_cent{1 + planted};
  int reached = 0;  // controls that reached the half-width

  std::string add(const RelativeTime& control, const RelativeTime& point) {
    itself.add(control);
    two_per_cent.add(point);
    reached += control.half_width() <= default_half_width;
    return fmt::format("{}: itself {}, 2 % longer {}", name, in_words(control), in_words(point));
  }

  void print() const {
    fmt::print(
        "{}: of {} sweeps {} reached a half-width of 1 %; itself: {} intervals contain 1, {} estimates are "
        "within 1 %; 2 % longer: {} contain 1.02, {} are within 1 % of it, {} find it (the interval is above "
        "1)\n",
        name, itself.sweeps, reached, itself.held, itself.within, two_per_cent.held, two_per_cent.within,
        two_per_cent.above_one);
  }
};

struct Arguments {
  std::string device, clock = "host", technique = "forward_plus";
  SceneChoice choice;
  int sweeps = 20;
  double seconds = 22;
};

Arguments parse(std::vector<std::string> words) {
  Arguments all;
  while (words.size() > 1 && words[0].starts_with("--")) {
    std::string* value = words[0] == "--device"      ? &all.device
                         : words[0] == "--clock"     ? &all.clock
                         : words[0] == "--technique" ? &all.technique
                                                     : nullptr;
    if (!value) throw input_error("{}: --device, --clock or --technique", words[0]);
    *value = words[1];
    words.erase(words.begin(), words.begin() + 2);
  }
  if (all.clock != "host" && all.clock != "device")
    throw input_error("--clock {}: host or device", all.clock);
  words.resize(4);
  all.choice.scene = words[0].empty() ? "hall" : words[0];
  all.choice.size = words[1].empty() ? "320x180" : words[1];
  if (!words[2].empty()) all.sweeps = std::atoi(words[2].c_str());
  if (!words[3].empty()) all.seconds = std::atof(words[3].c_str());
  return all;
}

int run(const Arguments& a) {
  const bool by_device = a.clock == "device";
  Renderer renderer(a.device, GlBackend::automatic);
  const ChosenScene chosen = load_chosen_scene(a.choice);
  tested = &find_technique(a.technique);
  const Technique late_techniques[] = {late_technique("late_in_wall_time", render_late<wall_ms>),
                                       late_technique("late_in_cpu_time", render_late<process_cpu_ms>),
                                       late_technique("late_on_device", render_with_kernel)},
                  baseline = late_technique("baseline", render_late<wall_ms, false>);
  FrontierJob job;
  job.baseline = baseline_point({}, true, a.technique);
  if (!by_device) job.baseline.contestant.technique = &baseline;
  for (const Technique& late :
       by_device ? std::span(late_techniques).last(1) : std::span(late_techniques).first(2)) {
    ChosenPoint& point = job.points.emplace_back();
    point.contestant.technique = &late;
    point.label = late.name;
  }
  job.controls = 1;
  job.views = 1;
  job.growth = false;
  job.shaded_pairs = 100'000;
  job.max_rounds_per_point = 1000;
  job.seconds = a.seconds;
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("known_difference.{}", getpid());
  std::filesystem::create_directories(folder);
  const auto sweep_of = [&](int seed) {
    job.seed = uint64_t(seed);
    FrontierPart part;
    part.seed = job.seed;
    part.baseline = job.baseline.label;
    part.machine = machine_of(renderer);
    std::filesystem::remove(part_path(folder, 0, 1));
    RecordFile file(part_path(folder, 0, 1), part, nullptr);
    measure_scene(renderer, a.choice, job, file);
    return answer_of({file.part()});
  };
  if (by_device) {  // a first sweep, which does not count
    make_kernel(*renderer.cl);
    steps = steps_of(planted * baseline_device_ms(sweep_of(0).part), renderer, chosen, late_techniques[2]);
  }
  ByClock wall{"wall-clock time"}, cpu{"processor time"}, device{"device time"};
  for (int sweep = 1; sweep <= a.sweeps; ++sweep) {
    const Timer timer;
    const FrontierAnswer answer = sweep_of(sweep);
    if (answer.points.size() < job.points.size()) {  // on a loaded machine
      fmt::print("{:2}: does not count: {} of {} points were measured in the time\n", sweep,
                 answer.points.size(), job.points.size());
      continue;
    }
    std::vector<std::string> words;
    if (by_device) {
      words.push_back(
          device.add(answer.device_controls.at(0).relative_time, answer.points.at(0).device.relative_time));
    } else {
      words.push_back(wall.add(answer.controls.at(0).relative_time, answer.points.at(0).relative_time));
      words.push_back(
          cpu.add(answer.cpu_controls.at(0).relative_time, answer.points.at(1).cpu.relative_time));
    }
    fmt::print("{:2}: {}; {} rounds, {:.0f} s, load {:.1f}\n", sweep, fmt::join(words, "; "),
               answer.points.at(0).relative_time.runs, timer.elapsed_ms() / 1000, load_average());
    std::fflush(stdout);
  }
  std::filesystem::remove_all(folder);
  by_device ? device.print() : (wall.print(), cpu.print());
  return 0;
}

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) {
  try {
    return lightgrid::run(lightgrid::parse({argv + 1, argv + argc}));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
