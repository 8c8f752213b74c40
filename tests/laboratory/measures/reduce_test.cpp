#include "measures/metrics.h"

#include <gmock/gmock.h>

#include <cmath>

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;

TEST(Reduce, TakesTheMeanOfABlockAndOfWhatIsThereAtTheEdge) {
  Image image(3, 3);
  for (int i = 0; i < 9; ++i) image.pixels[i] = glm::vec4(float(i));
  const Image small = mean_of_blocks(image, 2);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 2);
  EXPECT_EQ(small.at(0, 0).x, 2);    // 0 1 3 4
  EXPECT_EQ(small.at(1, 0).x, 3.5);  // 2 5
  EXPECT_EQ(small.at(0, 1).x, 6.5);  // 6 7
  EXPECT_EQ(small.at(1, 1).x, 8);
}

TEST(Reduce, HidesNoNan) {
  Image image(4, 1);
  image.at(2, 0).g = NAN;
  EXPECT_TRUE(std::isnan(mean_of_blocks(image, 4).at(0, 0).g));
}

TEST(Reduce, KeepsTheLargestCount) {
  EXPECT_THAT(largest_of_blocks({1, 7, 2, 3, 0, 9}, 3, 2, 2), ElementsAre(7, 9));
}

TEST(Reduce, KeepsThePixelThatIsFarthestOff) {
  Image reference(4, 1), image(4, 1), picture(4, 1);
  image.at(1, 0).b = 1e-6f;
  image.at(3, 0).r = NAN;
  image.at(2, 0).r = 5;
  for (int x = 0; x < 4; ++x) picture.at(x, 0) = glm::vec4(float(x));
  const Image small = worst_of_blocks(picture, image, reference, 2);
  EXPECT_EQ(small.at(0, 0).x, 1);
  EXPECT_EQ(small.at(1, 0).x, 3);
}

}  // namespace
}  // namespace lightgrid::lab
