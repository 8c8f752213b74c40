// Flicker of sequences made by hand, of the authors' pictures for FLIP, and of random ones that a script
// computes again.
#include "measures/flicker.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/random.h"
#include "support/paths.h"
#include "support/png_pixels.h"
#include "support/run_command.h"
#include "support/shared_files.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

Image grey(int width, int height, float value) {
  Image image(width, height);
  for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(value, value, value, 1);
  return image;
}

Image random_image(int width, int height, Random& random, float low = 0, float high = 1) {
  Image image(width, height);
  for (glm::vec4& pixel : image.pixels) {
    pixel.a = 1;
    for (int c = 0; c < 3; ++c) pixel[c] = low + (high - low) * random.uniform();
  }
  return image;
}

Image plus(Image image, const glm::vec3& value) {
  for (glm::vec4& pixel : image.pixels) pixel += glm::vec4(value, 0);
  return image;
}

// A sequence of the truth and of pictures against it.
SequenceFigures figures_of(const std::vector<Image>& pictures, const std::vector<Image>& truths,
                           bool filtered, const std::vector<CarriedPixel>& carried = {},
                           size_t uncounted = 0) {
  FlickerMeter meter(filtered);
  for (size_t i = 0; i < pictures.size(); ++i) {
    TruthFrame frame{.shown = truths[i % truths.size()]};
    const SeenByFlip seen(frame.shown);
    frame.seen = &seen;
    if (i > 0) frame.carried = carried;
    if (i > 0 && truths.size() > 1) frame.step = step_map(frame.shown, seen, truths[i - 1], frame.carried);
    meter.add(pictures[i], frame, i >= uncounted);
  }
  return meter.figures();
}

TEST(Flicker, IsNothingWhereTheErrorStays) {
  Random random(1);
  const Image truth = random_image(17, 9, random, 0, 0.5f), biased = plus(truth, {0.25f, 0.125f, 0.5f});
  for (const bool filtered : {false, true}) {
    const SequenceFigures rests = figures_of({biased, biased, biased}, {truth}, filtered);
    EXPECT_EQ(rests.flicker.mean, 0);
    EXPECT_EQ(rests.flicker.visible, 0);
    EXPECT_EQ(rests.largest_flicker, 0);
    EXPECT_GT(rests.displayed.mean, 0.1);
  }
  std::vector<Image> truths;
  for (int i = 0; i < 4; ++i) truths.push_back(random_image(17, 9, random));
  const SequenceFigures of_truth = figures_of(truths, truths, false);
  EXPECT_EQ(of_truth.flicker.mean, 0);
  EXPECT_EQ(of_truth.displayed.mean, 0);
}

// Changes of the truth below its steps are no flicker; the same step looks larger in the dark.
TEST(Flicker, IsWhatStepsExceedTheTruthsBy) {
  const std::vector<float> levels = {0.5f, 0.52f, 0.54f, 0.56f};
  std::vector<Image> truths, lighter, darker, still;
  for (const float level : levels) {
    truths.push_back(grey(12, 12, level));
    lighter.push_back(grey(12, 12, level + 0.25f));
    darker.push_back(grey(12, 12, level - 0.25f));
    still.push_back(grey(12, 12, 0.5f));
  }
  EXPECT_EQ(figures_of(lighter, truths, false).flicker.mean, 0);
  EXPECT_EQ(figures_of(still, truths, false).flicker.mean, 0) << "what does not follow has an error";
  double expected = 0;
  for (size_t i = 1; i < levels.size(); ++i)
    expected +=
        (mean_of(flip_map(darker[i], darker[i - 1])) - mean_of(flip_map(truths[i], truths[i - 1]))) / 3;
  EXPECT_GT(expected, 0.001);
  EXPECT_NEAR(figures_of(darker, truths, false).flicker.mean, expected, 1e-6);
}

// At rest a step is two pictures that alternate, which is what FLIP is of. The values are the authors'.
TEST(Flicker, OfTwoPicturesThatAlternateIsTheirFlip) {
  LIGHTGRID_NEEDS_SHARED("flip/values.csv");
  const auto picture = [](const char* name) {
    const PngPixels png = read_png(shared_folder() / "flip" / name);
    Image image(png.width, png.height);
    for (int y = 0; y < png.height; ++y) {
      for (int x = 0; x < png.width; ++x) {
        for (int c = 0; c < 3; ++c)
          image.at(x, png.height - 1 - y)[c] = linear_from_srgb(float(png.at(x, y, c)) / 255);
        image.at(x, png.height - 1 - y).a = 1;
      }
    }
    return image;
  };
  std::ifstream file(shared_folder() / "flip/values.csv");
  std::map<std::string, double> means;  // means of the reference and a picture, at 67 pixels per degree
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> fields;
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    if (fields[0] == "ldr" && std::stod(fields[2]) == 67) means[fields[1]] = std::stod(fields[6]);
  }
  ASSERT_FALSE(means.empty());
  const Image reference = picture("reference.png");
  for (const auto& [name, mean] : means) {
    const Image other = picture((name + ".png").c_str());
    const SequenceFigures f = figures_of({reference, other, reference, other}, {reference}, false);
    EXPECT_NEAR(f.flicker.mean, mean, 1e-4) << name;
    EXPECT_NEAR(f.largest_flicker, mean, 1e-4) << name;
    EXPECT_NEAR(f.displayed.mean, mean / 2, 1e-4) << name << ": every second frame is the truth";
  }
}

// An error that changes its sign each frame leaves FLIP against the truth as it is, and yet flickers.
TEST(Flicker, SeesAnErrorThatChangesItsSign) {
  const Image truth = grey(20, 20, 0.5f), above = grey(20, 20, 0.6f), below = grey(20, 20, 0.4f);
  const SequenceFigures f = figures_of({above, below, above, below}, {truth}, false);
  EXPECT_NEAR(f.flicker.mean, mean_of(flip_map(above, below)), 1e-6);
  EXPECT_GT(f.flicker.mean, f.displayed.mean);
}

// One pop among frames at rest: the mean is a part of it, the largest is it.
TEST(Flicker, TellsAPopFromTheMean) {
  const Image truth = grey(24, 24, 0.5f);
  Image square = truth;
  for (int y = 6; y < 18; ++y) {
    for (int x = 6; x < 18; ++x) square.at(x, y) = glm::vec4(0.8f, 0.8f, 0.8f, 1);
  }
  const DisplayedFlip pop = displayed_flip_of(flip_map(square, truth));
  const SequenceFigures f = figures_of({truth, truth, square, square, square}, {truth}, false);
  EXPECT_NEAR(f.flicker.mean, pop.mean / 4, 1e-9);
  EXPECT_NEAR(f.flicker.visible, pop.visible / 4, 1e-9);
  EXPECT_NEAR(f.largest_flicker, pop.mean, 1e-9);
  EXPECT_NEAR(f.displayed.mean, pop.mean * 3 / 5, 1e-9);
}

// The mean over frames takes noise down and leaves a bias: its variance is newest / (2 - newest) = 1/19 of a
// frame's. FLIP against the truth falls, and the flicker more.
TEST(Flicker, OfNoiseFallsWithTheMeanOverFrames) {
  Random random(7);
  const Image truth = grey(40, 30, 0.4f);
  std::vector<Image> noise;
  for (int i = 0; i < 40; ++i) noise.push_back(random_image(40, 30, random, 0.2f, 0.6f));
  const SequenceFigures plain = figures_of(noise, {truth}, false, {}, 20),
                        filtered = figures_of(noise, {truth}, true, {}, 20);
  EXPECT_GT(plain.flicker.mean, 0.05);
  EXPECT_LT(filtered.flicker.mean, plain.flicker.mean / 4);
  EXPECT_LT(filtered.displayed.mean, plain.displayed.mean / 2);
}

// An edge that comes: the mean over frames lags behind it, which is an error that a frame does not have.
TEST(Flicker, TheMeanOverFramesLagsBehindTheTruth) {
  const std::vector<Image> truths = {grey(16, 16, 0.2f), grey(16, 16, 0.2f), grey(16, 16, 0.7f),
                                     grey(16, 16, 0.7f)};
  EXPECT_EQ(figures_of(truths, truths, false).displayed.mean, 0);
  const SequenceFigures lags = figures_of(truths, truths, true);
  EXPECT_GT(lags.displayed.mean, 0.05);
  EXPECT_GT(lags.flicker.mean, 0.05);
}

// Everything moves by a pixel to the right a frame, the error too. The leftmost column was not seen before.
TEST(Flicker, FollowsSurfaces) {
  Random random(3);
  const int width = 24, height = 16, frames = 5;
  const Image wide = random_image(width + frames, height, random, 0, 0.5f),
              error = random_image(width + frames, height, random, 0, 0.5f);
  std::vector<Image> truths, pictures;
  for (int i = 0; i < frames; ++i) {
    Image truth(width, height), picture(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        truth.at(x, y) = wide.at(x + frames - i, y);
        picture.at(x, y) = glm::vec4(glm::vec3(truth.at(x, y)) + glm::vec3(error.at(x + frames - i, y)), 1);
      }
    }
    truths.push_back(truth);
    pictures.push_back(picture);
  }
  std::vector<CarriedPixel> carried(size_t(width * height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      carried[size_t(y * width + x)] = {x - 1, y, {x > 0 ? 1.0f : 0.0f, 0, 0, 0}};
  }
  EXPECT_LT(figures_of(pictures, truths, false, carried).flicker.mean, 1e-3);
  EXPECT_GT(figures_of(pictures, truths, false).flicker.mean, 0.02) << "without following them";
  const SequenceFigures mean = figures_of(truths, truths, true, carried);
  EXPECT_LT(mean.displayed.mean, 1e-3) << "the mean over frames follows them too";
}

TEST(Flicker, CountsNaN) {
  const Image truth = grey(9, 9, 0.5f);
  Image broken = truth;
  broken.at(4, 4).r = std::nanf("");
  for (const bool filtered : {false, true}) {
    const SequenceFigures f = figures_of({truth, broken, broken}, {truth}, filtered);
    EXPECT_GE(f.largest_flicker, 1.0 / 81) << "it comes";
    EXPECT_NEAR(f.flicker.mean, (f.largest_flicker + 1.0 / 81) / 2, 1e-9) << "it stays: FLIP of NaN is 1";
    EXPECT_NEAR(f.displayed.mean, f.largest_flicker * 2 / 3, 1e-9) << "against the truth it is there in both";
  }
  const SequenceFigures healed = figures_of({broken, truth, truth, truth}, {truth}, true, {}, 2);
  EXPECT_EQ(healed.displayed.mean, 0) << "a mean does not keep it";
}

nlohmann::json values_of(const Image& image) {
  nlohmann::json values = nlohmann::json::array();
  for (const glm::vec4& p : image.pixels) values.push_back({p.r, p.g, p.b});
  return values;
}

// Random pictures of a moving truth, followed with random weights of which some are 0.
TEST(Flicker, IsThatOfTheScript) {
  if (run_command("python3 --version 2>&1").status != 0) GTEST_SKIP() << "Python 3 is not installed";
  Random random(11);
  const int width = 11, height = 8, frames = 5;
  std::vector<Image> truths, pictures;
  for (int i = 0; i < frames; ++i) {
    truths.push_back(random_image(width, height, random, 0.4f, 0.6f));
    pictures.push_back(random_image(width, height, random));
  }
  std::vector<CarriedPixel> carried(size_t(width * height));
  nlohmann::json sequence = {{"width", width}, {"height", height}, {"newest", newest_frame_counts}};
  for (CarriedPixel& pixel : carried) {
    pixel.x = int(random.next() % (width - 1));
    pixel.y = int(random.next() % (height - 1));
    float sum = 0;
    for (float& weight : pixel.weights) sum += weight = random.uniform() < 0.6f ? random.uniform() : 0.0f;
    for (float& weight : pixel.weights) weight = sum > 0 ? weight / sum : 0;
    sequence["carried"].push_back({pixel.x, pixel.y, pixel.weights});
  }
  for (int i = 0; i < frames; ++i) {
    sequence["truths"].push_back(values_of(truths[size_t(i)]));
    sequence["pictures"].push_back(values_of(pictures[size_t(i)]));
  }
  const TempFolder folder;
  std::ofstream(folder.path / "sequence.json") << sequence.dump();
  const CommandOutcome run =
      run_command("python3 " + std::string(source_folder) + "/tests/laboratory/measures/flicker.py " +
                  (folder.path / "sequence.json").string() + " 2>&1");
  ASSERT_EQ(run.status, 0) << run.output;
  const auto expected = nlohmann::json::parse(run.output);
  for (const bool filtered : {false, true}) {
    const SequenceFigures f = figures_of(pictures, truths, filtered, carried);
    const auto& of_script = expected[filtered ? "filtered" : "plain"];
    EXPECT_GT(f.flicker.mean, 0.01);
    EXPECT_NEAR(f.flicker.mean, of_script["flicker"].get<double>(), 1e-5) << filtered;
    EXPECT_NEAR(f.largest_flicker, of_script["largest_flicker"].get<double>(), 1e-5) << filtered;
    EXPECT_NEAR(f.displayed.mean, of_script["displayed_flip"].get<double>(), 1e-5) << filtered;
  }
}

}  // namespace
}  // namespace lightgrid::lab
