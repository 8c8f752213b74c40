// A scene for other renderers, with the truths of its views.
#include <nlohmann/json.hpp>

#include "frontier/brute_force.h"
#include "frontier/measure.h"
#include "frontier/view_figures.h"

namespace lightgrid::lab {

void export_with_truths(Renderer& renderer, const SceneChoice& choice, const FrontierJob& job,
                        const std::filesystem::path& folder) {
  const ChosenScene chosen = load_chosen_scene(choice);
  const std::vector<View> views = frontier_views(chosen.scene, chosen.view, choice, job.views);
  GpuScene gpu(renderer, chosen.scene);
  BruteForce brute(renderer, gpu, job.common, job.truth, !renderer.gl);
  std::vector<nlohmann::ordered_json> pictures;
  for (size_t i = 0; i < views.size(); ++i) {
    if (job.progress) job.progress(double(i) / double(views.size()), "truths");
    brute.look(views[i]);
    nlohmann::ordered_json& names = pictures.emplace_back();
    const auto save = [&](const std::string& kind, const Image& image) {
      const std::string name = fmt::format("{}_{}.exr", kind, i);
      save_exr(folder / name, image);
      names[kind] = name;
    };
    save("truth", brute.truth());
    if (has_authored(job)) save("authored", brute.authored());
  }
  export_scene(folder, choice.scene, chosen.scene, views, pictures);
}

}  // namespace lightgrid::lab
