#include "frontier/pictures.h"

#include <gtest/gtest.h>

#include "support/read_files.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

TEST(PictureFiles, AreExposedAndDifferencesAreNot) {
  const TempFolder folder;
  Image image(2, 1), truth(2, 1);
  image.pixels = {glm::vec4(8), glm::vec4(4)};
  truth.pixels = {glm::vec4(8), glm::vec4(5)};
  const auto bytes = [&](const Exposure& exposure, const char* suffix) {
    const std::string name = exposure.ev == 0 ? "a" : "b";
    PictureFiles files(folder.path / name);
    files.expose(exposure);
    return file_bytes(folder.path / name / (files.write("level", image, truth, nullptr).name + suffix));
  };
  const std::vector<uint8_t> shown = encode_png(2, 1, 3, srgb_bytes(image, {-4}));
  EXPECT_EQ(bytes({-4}, ".png"), std::string(shown.begin(), shown.end()));
  EXPECT_NE(bytes({0}, ".png"), bytes({-4}, ".png"));
  EXPECT_EQ(bytes({0}, ".difference.png"), bytes({-4}, ".difference.png"));
}

}  // namespace
}  // namespace lightgrid::lab
