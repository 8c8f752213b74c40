// The sizes that --tune found are kept in a file by device and driver.
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "cl/tuned_sizes.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

ClDeviceInfo device(const std::string& name, const std::string& driver = "1.0") {
  ClDeviceInfo info;
  info.name = name;
  info.driver = driver;
  info.platform = "p";
  info.version = "v";
  return info;
}

TEST(TunedSizes, AreReadBackForTheirDeviceAndDriverOnly) {
  const TempFolder folder;
  const auto file = folder.path / "new" / "tuned.json";
  const TunedSizes a = {{"kernel-shape", "lanes"}}, b = {{"kernel-shape", "group"}, {"group", "128"}};
  write_tuned_sizes(device("a"), a, file);
  write_tuned_sizes(device("b"), b, file);
  EXPECT_EQ(read_tuned_sizes(device("a"), file), a);
  EXPECT_EQ(read_tuned_sizes(device("b"), file), b);
  EXPECT_EQ(read_tuned_sizes(device("a", "1.1"), file), TunedSizes());
  write_tuned_sizes(device("a"), b, file);
  EXPECT_EQ(read_tuned_sizes(device("a"), file), b) << "the later takes the place of the earlier";
}

TEST(TunedSizes, AreNoneWhereTheFileIsAbsentOrBroken) {
  const TempFolder folder;
  const auto file = folder.path / "tuned.json";
  EXPECT_EQ(read_tuned_sizes(device("a"), file), TunedSizes());
  EXPECT_EQ(read_tuned_sizes(device("a"), folder.path), TunedSizes());
  for (const char* text :
       {"", "{", "[]", "{\"p | a | v | 1.0\": 3}", "{\"p | a | v | 1.0\": {\"x\": 3}}", "\xff\xfe"}) {
    std::ofstream(file) << text;
    EXPECT_EQ(read_tuned_sizes(device("a"), file), TunedSizes()) << text;
  }
  write_tuned_sizes(device("a"), {{"x", "1"}}, file);
  EXPECT_EQ(read_tuned_sizes(device("a"), file), (TunedSizes{{"x", "1"}})) << "a broken file is replaced";
}

TEST(TunedSizes, WithoutAFileAreNotWritten) { EXPECT_THROW(write_tuned_sizes(device("a"), {}, ""), Error); }

}  // namespace
}  // namespace lightgrid
