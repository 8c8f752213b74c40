// Techniques compared on views that are chosen by text: what `lightgrid compare` does, for any front end.
// Error(input) names the field and its value.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compare/compare.h"
#include "run/scene_choice.h"

namespace lightgrid::lab {

// Fields as in docs/command_line.md.
struct CompareChoice {
  SceneChoice scene;  // for all views, except as follows
  // Every scene at every size with every number of lights; none: the scene's own.
  std::vector<std::string> scenes = {"hall"}, sizes = {"1280x720"}, lights;
  DeviceOptions devices;
  TimingOptions timing;
  std::vector<std::string> techniques;  // empty: default_techniques(), or those that run without OpenGL
  std::vector<std::string> compare;
  std::string reference = "auto";
  std::string keep = "range";  // over several numbers of lights (Kept)
  bool flip = false;
};
const std::vector<std::string>& default_techniques();

// The chosen comparison, with its scenes loaded.
struct Comparison {
  CompareChoice choice;
  std::vector<LoadedView> views;
  std::vector<Contestant> contestants;
};

// Reports every fault in the fields and files, before devices are opened.
Comparison load_comparison(const CompareChoice& choice);

// Opens the devices and runs the views in turn, with one progress (0 to 1) for all. Gives each report to
// `found` as soon as it is measured. If techniques are given, throws Error(machine) where one needs OpenGL
// and there is none; else those that need it are left out, with a warning in the log.
void run_comparison(const Comparison& comparison,
                    const std::function<void(double done, const std::string& step)>& progress,
                    const std::function<void(CompareReport report)>& found);

// One view of it, on devices that are open, of a scene that is loaded: what `choice` says about scenes,
// sizes, numbers of lights and devices is not read, and what `view_choice` says about the scene only where it
// moves. `which` begins the lines of the log.
CompareReport compare_view(Renderer& devices, Scene& scene, const View& view, const SceneChoice& view_choice,
                           const CompareChoice& choice, const std::vector<Contestant>& contestants,
                           const std::function<void(double done, const std::string& step)>& progress,
                           const std::string& which = "", bool all_may_refuse = false);

// The contestants of the fields; before devices are opened, and those of them that the devices can draw, as
// above.
std::vector<Contestant> contestants_of(const CompareChoice& choice);
std::vector<Contestant> runnable(const CompareChoice& choice, const std::vector<Contestant>& contestants,
                                 const Renderer& devices);

// Both: the reports of all views, with their images.
std::vector<CompareReport> compare_views(
    const CompareChoice& choice, const std::function<void(double done, const std::string& step)>& progress);

}  // namespace lightgrid::lab
