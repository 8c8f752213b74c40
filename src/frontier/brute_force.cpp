#include "frontier/brute_force.h"

#include "results/metrics.h"

namespace lightgrid {
namespace {

Settings meaning_of(const Settings& settings, const Settings& common) {
  Settings meaning = common;
  meaning.brdf = settings.brdf;
  meaning.ranges = settings.ranges;
  meaning.lights = ShadedLights::all;
  return meaning;
}

// The settings that a picture of every light depends on.
std::string name_of(const Settings& meaning) {
  const auto all = to_strings(meaning);
  std::string name;
  for (const char* key : {"brdf", "range", "cutoff", "window", "alpha", "light_seed"})
    name += all.at(key) + " ";
  return name;
}

}  // namespace

BruteForce::BruteForce(Renderer& renderer, GpuScene& gpu, const Settings& common, bool own_surfaces)
    : renderer_(renderer),
      gpu_(gpu),
      common_(common),
      technique_(find_technique(own_surfaces ? "visibility" : "forward")),
      pool_(std::make_shared<TargetPool>()) {}

void BruteForce::look(const View& view) {
  view_ = view;
  pictures_.clear();
}

const Image& BruteForce::picture(const Settings& settings) {
  const Settings meaning = meaning_of(settings, common_);
  Image& image = pictures_[name_of(meaning)];
  if (image.pixels.empty()) image = draw(settings);
  return image;
}

Image BruteForce::draw(const Settings& settings) {
  TechniqueRun run(renderer_, gpu_, view_, meaning_of(settings, common_), technique_, pool_);
  run.run_frame(true);
  return run.take_image();
}

const Image& BruteForce::truth() {
  Settings settings = common_;
  settings.ranges = {.range = LightRange::infinite};
  return picture(settings);
}

double BruteForce::brightest() { return brightest_channel(truth()); }

}  // namespace lightgrid
