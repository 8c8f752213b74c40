#include "accuracy/reference_picture.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "accuracy/scene_occlusion.h"
#include "plan/frame_plan.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"
#include "run/frames.h"

namespace lightgrid::lab {

Image ReferencePicture::image() const {
  Image image(width, height);
  for (size_t i = 0; i < pixels.size(); ++i) image.pixels[i] = glm::vec4(glm::vec3(pixels[i].radiance), 1);
  return image;
}

glm::dvec3 ReferencePicture::max_doubt() const {
  glm::dvec3 most(0);
  for (const PixelArea& pixel : pixels) most = glm::max(most, pixel.doubt);
  return most;
}

size_t ReferencePicture::doubtful() const {
  return size_t(
      std::ranges::count_if(pixels, [](const PixelArea& pixel) { return pixel.doubt != glm::dvec3(0); }));
}

ReferencePicture reference_picture(const Scene& scene, const View& view, const Settings& settings, int places,
                                   const std::function<void(double)>& progress) {
  const FramePlan plan =
      plan_frame(scene, view, settings, {.effects = find_technique("forward").needs.effects});
  const bool casts = std::ranges::any_of(scene.lights, &Light::casts_shadow) &&
                     settings[setting::shadows] != ShadowMethod::none;
  SceneOcclusion occlusion(scene);
  const AreaOracle oracle(scene, view, ranges_of(meant_by(settings)),
                          {.brdf = settings[setting::brdf],
                           .ambient = scene.ambient,
                           .base = base_terms(scene, view, plan),
                           .background = background_term(scene, view, plan)},
                          casts ? &occlusion.get(settings[setting::shadow_blended]) : nullptr);
  ReferencePicture picture{view.width, view.height, {}};
  std::vector<uint32_t> row(size_t(view.width));
  for (int y = 0; y < view.height; ++y) {
    std::iota(row.begin(), row.end(), uint32_t(y) * uint32_t(view.width));
    const std::vector<PixelArea> areas = oracle.at(row, places);
    picture.pixels.insert(picture.pixels.end(), areas.begin(), areas.end());
    progress(double(y + 1) / view.height);
  }
  return picture;
}

void save_reference(const std::filesystem::path& path, const ReferencePicture& picture) {
  struct Part {
    const char* prefix;
    glm::dvec3 PixelArea::*value;
  };
  std::vector<ExrChannel> channels;
  for (const Part& part : {Part{"", &PixelArea::radiance}, Part{"doubt.", &PixelArea::doubt},
                           Part{"spread.", &PixelArea::spread}}) {
    for (const int c : {2, 1, 0}) {  // in the order of their names
      ExrChannel& channel = channels.emplace_back();
      channel.name = part.prefix + std::string(1, "RGB"[c]);
      for (const PixelArea& pixel : picture.pixels)
        channel.words.push_back(std::bit_cast<uint32_t>(float((pixel.*part.value)[c])));
    }
  }
  save_exr(path, picture.width, picture.height, channels);
}

}  // namespace lightgrid::lab
