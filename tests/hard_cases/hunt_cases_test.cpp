// The hunt in random cases of samples and light indices finds no fault in the library; each class finds a
// fault that is planted for it, and its seed shows the fault again.
#include <gmock/gmock.h>

#include <functional>

#include "base/error.h"
#include "hard_cases/library_engine.h"
#include "plan/settings/samples.h"
#include "verify/hunt_cases.h"

namespace lightgrid::lab::verify {
namespace {

// The library with what it returns altered as a fault would.
struct AlteredLibrary : LibraryEngine {
  std::function<void(RasterImage&, int samples)> of_images = [](RasterImage&, int) {};
  std::function<void(uint32_t& index)> of_indices = [](uint32_t&) {};
  bool lists_of_centres = false;

  std::optional<RasterImage> rasterize(const RasterOptions& options, const RasterInput& input) override {
    std::optional<RasterImage> image = library->rasterize(options, input);
    of_images(*image, input.camera.grid.samples);
    return image;
  }
  std::vector<ListImage> lists(const Scene& scene, const std::string& technique, std::span<const View> views,
                               const Settings& settings) override {
    std::vector<ListImage> images = library->lists(scene, technique, views, settings);
    if (lists_of_centres && settings[setting::samples] > 1) {
      Settings one = settings;
      one.set(setting::samples, 1);
      const std::vector<ListImage> centres = library->lists(scene, technique, views, one);
      for (size_t i = 0; i < images.size(); ++i) images[i].lists = centres[i].lists;
    }
    for (ListImage& image : images) {
      for (uint32_t& index : image.lists.indices) of_indices(index);
    }
    return images;
  }
};

HuntOptions short_hunt(const std::string& filter, uint64_t seed, uint64_t contacts) {
  return {.contacts = contacts, .seed = seed, .filter = filter, .save = {}, .progress = {}};
}

void expect_found(const char* hunted, AlteredLibrary& engine) {
  const CaseHuntReport report = hunt_cases(engine, short_hunt(hunted, 3, 200'000));
  if (report.total().skipped > 0) GTEST_SKIP() << report.classes[0].why;
  ASSERT_TRUE(report.failed()) << hunted;
  const uint64_t seed = report.total().failed.front();
  EXPECT_THAT(report.classes[0].why, testing::StartsWith("seed " + std::to_string(seed) + ": "));
  const CaseHuntReport again = hunt_cases(engine, short_hunt(hunted, seed, 1));
  EXPECT_EQ(again.classes[0].why, report.classes[0].why) << "its seed shows it again";
}

TEST(HuntOfCases, FindsNothingInTheLibraryAndDependsOnTheSeedAlone) {
  const auto engine = device_engine("");
  const auto run = [&] { return hunt_cases(*engine, short_hunt("", 100, 100'000)); };
  const CaseHuntReport first = run(), second = run();
  EXPECT_FALSE(first.failed()) << to_json(first).dump(1);
  EXPECT_EQ(first.total().trials, second.total().trials);
  EXPECT_EQ(first.total().contacts, second.total().contacts);
  EXPECT_GE(first.total().contacts, 100'000u);
}

TEST(HuntOfFaults, FindsASampleThatShowsAnothersTriangle) {
  AlteredLibrary engine;
  engine.of_images = [](RasterImage& image, int samples) {
    for (size_t i = 1; i < image.triangles.size(); i += size_t(samples)) {
      image.triangles[i] = image.triangles[i - 1];
      image.depths[i] = image.depths[i - 1];
    }
  };
  expect_found("^coverage$", engine);
}

TEST(HuntOfFaults, FindsListsOfCentres) {
  AlteredLibrary engine;
  engine.lists_of_centres = true;
  expect_found("^edge_lists$", engine);
}

TEST(HuntOfFaults, FindsAnIndexThatLosesItsHighByte) {
  AlteredLibrary engine;
  engine.of_indices = [](uint32_t& index) { index &= 255; };
  expect_found("^packings$", engine);
}

TEST(HuntOfFaults, FindsAWrongOrder) {
  AlteredLibrary engine;
  engine.of_indices = [](uint32_t& index) { index = index == 0 ? 1 : index == 1 ? 0 : index; };
  expect_found("^priority$", engine);
}

TEST(HuntOfCases, RefusesAFilterThatNamesNone) {
  const auto engine = device_engine("");
  EXPECT_THROW(hunt_cases(*engine, short_hunt("slivers", 1, 1)), Error);
}

}  // namespace
}  // namespace lightgrid::lab::verify
