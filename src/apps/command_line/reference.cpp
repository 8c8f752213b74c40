// lightgrid reference SCENE -o FILE.exr: the picture in double precision that other renderers can be tested
// with; --against IMAGE.exr compares one.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "accuracy/reference_picture.h"
#include "base/error.h"
#include "base/exr_picture.h"
#include "base/text.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "measures/metrics.h"
#include "plan/settings/model.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct ReferenceOptions {
  SceneChoice scene;
  std::string output = "out/reference.exr", against, json;
  int places = 16;
};

void check_places(int places) {
  for (const int possible : {1, 4, 16, 64, 256})
    if (places == possible) return;
  throw input_error("places {}: choose 1, 4, 16, 64 or 256", places);
}

// The picture that is meant, and which surfaces cast.
void check_settings(const Settings& settings) {
  std::vector<std::string> read = model_settings();
  read.insert(read.end(), {"shadows", "shadow-blended"});
  for (const std::string& key : given_keys(settings))
    if (std::ranges::count(read, key) == 0)
      throw input_error("set {}: reference does not read it, and it would change nothing; it reads {}", key,
                        fmt::join(read, ", "))
          .about(key);
}

nlohmann::ordered_json comparison(const ReferencePicture& picture, const Image& image,
                                  const std::string& file) {
  const ImageError error = compare_images(image, picture.image());
  // Differences that neither doubtful shadows nor the spread of a pixel's places explain.
  constexpr double spreads = 4;
  size_t beyond = 0;
  double largest = 0;
  const double brightest = brightest_channel(picture.image());
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    const PixelArea& pixel = picture.pixels[i];
    const glm::dvec3 apart = glm::abs(glm::dvec3(image.pixels[i]) - pixel.radiance) - pixel.doubt -
                             spreads * pixel.spread - 1e-5 * brightest;
    const double most = std::max({apart.x, apart.y, apart.z});
    beyond += !(most <= 0);
    largest = std::max(largest, most);
  }
  const auto relative = [&](double value) { return brightest > 0 ? value / brightest : 0; };
  return {{"file", file},
          {"rmse_rel", relative(error.rmse)},
          {"p99_rel", relative(error.p99)},
          {"max_rel", relative(error.max_abs)},
          {"unexplained_pixels", beyond},
          {"unexplained_max_rel", relative(std::max(largest, 0.0))}};
}

int reference(ReferenceOptions o) {
  check_places(o.places);
  check_settings(chosen_settings(o.scene));
  check_image_path(o.output);
  check_output_files({{"-o", o.output}, {"--json", o.json}});
  const ChosenScene chosen = load_chosen_scene(o.scene);
  std::optional<Image> other;
  if (!o.against.empty()) other = load_exr_picture(o.against, chosen.view.width, chosen.view.height);
  const auto progress = progress_bar();
  const ReferencePicture picture = reference_picture(chosen.scene, chosen.view, chosen_settings(o.scene),
                                                     o.places, [&](double done) { progress(done, "rays"); });
  const Image image = picture.image();
  if (std::filesystem::path(o.output).extension() == ".exr") {
    save_reference(o.output, picture);
  } else {
    save_image(o.output, image, chosen_exposure(o.scene, image));
  }
  const glm::dvec3 doubt = picture.max_doubt();
  nlohmann::ordered_json json = {{"scene", chosen.scene.name},
                                 {"size", {picture.width, picture.height}},
                                 {"places", o.places},
                                 {"doubtful_pixels", picture.doubtful()},
                                 {"max_doubt", std::max({doubt.x, doubt.y, doubt.z})},
                                 {"brightest", brightest_channel(image)}};
  if (o.json != "-")
    fmt::print("{}: {} places per pixel; at {} of {} pixels a shadow turns on rounding\n", o.output, o.places,
               picture.doubtful(), picture.pixels.size());
  if (other) {
    json["against"] = comparison(picture, *other, o.against);
    const auto& a = json["against"];
    if (o.json != "-")
      fmt::print(
          "{}: RMSE {:.2g}, 99 % of pixels within {:.2g}, largest difference {:.2g} (of the brightest "
          "channel);\n"
          "{} pixels differ by more than doubtful shadows and four times the spread of a pixel's places "
          "explain\n",
          o.against, a["rmse_rel"].get<double>(), a["p99_rel"].get<double>(), a["max_rel"].get<double>(),
          a["unexplained_pixels"].get<size_t>());
  }
  if (!o.json.empty()) write_json(o.json, json_text(json));
  return 0;
}

}  // namespace

void add_reference(CommandLine& line) {
  auto o = std::make_shared<ReferenceOptions>();
  Subcommand command = line.add("reference", "a picture in double precision, to test other renderers with",
                                [o] { return reference(*o); });
  add_scene_options(command, o->scene);
  add_exposure_option(command, o->scene);
  command.option("-o,--output", o->output, "image file; .exr also has the error bounds of each pixel");
  command.option("--places", o->places, "places of each pixel that are averaged: 1, 4, 16, 64 or 256", 1,
                 256);
  command.option("--against", o->against, "an EXR picture of the same view, to compare");
  command.option("--json", o->json, "results as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
