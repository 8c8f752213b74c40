// Two frames of a technique, as evidence of the settings that it read: pictures, light lists, passes,
// kernels, programs and memory.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "accuracy/oracle.h"
#include "base/error.h"

namespace lightgrid {
using namespace lab;

using Observed = std::map<std::string, std::string>;  // of each fact its value

template <typename T>
std::string hash_text(const std::vector<T>& values) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return fmt::format("{} {:x}", values.size(), std::hash<std::string_view>()(bytes));
}

// The kernels of each of its runs, and the bytes of the last.
inline std::string pass_text(const PassRecord& pass) {
  std::string text = fmt::format("{}, reads {}, writes {}", pass.on, pass.bytes_read, pass.bytes_written);
  for (const std::vector<KernelTime>& run : pass.kernels) {
    text += "; ";
    for (const KernelTime& kernel : run) text += kernel.name + " ";
  }
  return text;
}

// The programs of both frames stay in the renderer. `settings`: KEY=VALUE each.
inline Observed observe(Renderer& renderer, const Scene& scene, const View& view, const Technique& technique,
                        const std::set<std::string>& settings) {
  Settings chosen;
  for (const std::string& assignment : settings) apply_setting(chosen, assignment);
  Observed seen;
  std::set<std::string> programs;
  renderer.note_programs(&programs);
  try {
    TechniqueRun run(renderer, scene, view, chosen, technique);
    run.view().timer.enabled = true;
    for (const char* frame : {"first image", "second image"}) {
      run.run_frame();
      seen[frame] = hash_text(run.image().pixels);
    }
    renderer.note_programs(nullptr);
    for (const PassRecord& pass : run.view().timer.records()) seen["pass " + pass.name] = pass_text(pass);
    const FrameFigures result = run.result();
    seen["memory"] =
        fmt::format("{} {} {}", result.memory_total, result.memory_light_grid, result.memory_gbuffer);
    const ListedLights lists = listed_lights(run, read_depth(run));
    seen["lists"] =
        hash_text(lists.cell_of_pixel) + " " + hash_text(lists.count) + " " + hash_text(lists.indices);
  } catch (const Error& error) {
    renderer.note_programs(nullptr);
    seen["refused"] = error.what();
  }
  // A first run queries the device; later runs of the process do not.
  std::erase_if(programs, [](const std::string& name) { return name.find("_probe.") != std::string::npos; });
  seen["programs"] = fmt::format("{}", fmt::join(programs, "\n"));
  return seen;
}

}  // namespace lightgrid
