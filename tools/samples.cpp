// Techniques with one to eight samples a pixel: error at edges and inside, time and bytes, as CSV.
// docs/results/samples.md has the tables.
//   samples [SCENE...]        hall, street and gallery by default
#include <fmt/format.h>

#include "plan/settings/samples.h"
#include "run/scene_choice.h"
#include "support/fine_truth.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr float display_white = 1;  // light above it is shown as white, and an error in it is not seen

// Ways of techniques beside the defaults.
constexpr std::pair<const char*, const char*> ways[] = {{"deferred_tiled", "samples-shading=all"},
                                                        {"light_prepass", "prepass-lights=volumes"},
                                                        {"lidr", "lidr-volumes=front-faces"},
                                                        {"lidr", "lidr-volumes=no-prepass"}};

struct Row {
  std::string technique;
  int samples;
  Image image;
  std::unique_ptr<TechniqueRun> run;
};

View view_of(const std::string& scene, int width, int height) {
  SceneChoice choice;
  choice.scene = scene;
  choice.size = fmt::format("{}x{}", width, height);
  return load_chosen_scene(choice).view;
}

void tell(Renderer& renderer, const std::string& name) {
  SceneChoice choice;
  choice.scene = name;
  const Scene scene = load_chosen_scene(choice).scene;
  constexpr int width = 160, height = 90, times = 4;
  const FineTruth truth(renderer, scene, view_of(name, width * FineTruth::side, height * FineTruth::side),
                        display_white);
  std::vector<Row> rows;
  const auto add = [&](const Technique* technique, const char* way) {
    for (const int samples : {1, 2, 4, 8}) {
      Settings settings;
      settings.set(setting::samples, samples);
      if (way) apply_setting(settings, way);
      if (samples > max_samples(*technique, settings)) continue;
      const std::string called = way ? fmt::format("{} {}", technique->name, way) : technique->name;
      try {
        TechniqueRun small(renderer, scene, view_of(name, width, height), settings, *technique);
        small.run_frame();
        Row& row = rows.emplace_back(Row{called, samples, small.image(), {}});
        row.run = std::make_unique<TechniqueRun>(
            renderer, scene, view_of(name, width * times, height * times), settings, *technique);
        row.run->run_frame(true);
      } catch (const Error& error) {
        fmt::print(stderr, "{} samples={}: {}\n", called, samples, error.what());
      }
    }
  };
  for (const Technique* technique : techniques()) {
    add(technique, nullptr);
    for (const auto& [name, way] : ways)
      if (technique->name == std::string(name)) add(technique, way);
  }
  std::erase_if(rows, [](const Row& row) { return !row.run; });
  for (int frame = 0; frame < 5; ++frame) {
    for (const Row& row : rows) row.run->run_frame();
  }
  FrameFigures one;
  for (const Row& row : rows) {
    const FrameFigures result = row.run->result();
    if (row.samples == 1) one = result;
    const double pixels = double(width * times) * (height * times);
    fmt::print("{},{},{},{:.3f},{:.5f},{:.5f},{:.2f},{:.1f},{:.0f}\n", name, row.technique, row.samples,
               truth.edge_share(), truth.error(row.image, true), truth.error(row.image, false),
               result.frame_ms.median / one.frame_ms.median, result.frame_ms.median,
               (double(result.memory_total) - double(one.memory_total)) / pixels);
  }
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  Renderer renderer("", GlBackend::automatic);
  fmt::print(
      "scene,technique,samples,edge_share,edge_error,inside_error,time_of_one,frame_ms,more_bytes_a_pixel\n");
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) scenes = {"hall", "street", "gallery"};
  for (const std::string& scene : scenes) tell(renderer, scene);
  return 0;
}

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) { return lightgrid::run(argc, argv); }
