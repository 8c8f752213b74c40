#include "cl/program_file.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace lightgrid {
namespace {

const std::vector<unsigned char> binary = {0, 1, 255, 10, 13, 0};

TEST(ProgramFile, GivesBackWhatWasWrittenUnderItsKeyOnly) {
  const TempFolder folder;
  const auto file = program_file_path(folder.path / "below", "cull", "a key\nof two lines");
  EXPECT_TRUE(read_program_file(file, "a key\nof two lines").empty());
  write_program_file(file, "a key\nof two lines", binary);
  EXPECT_EQ(read_program_file(file, "a key\nof two lines"), binary);
  EXPECT_TRUE(read_program_file(file, "a key\nof two line").empty());
  EXPECT_TRUE(read_program_file(file, "a key\nof two lines\n").empty());
  EXPECT_TRUE(read_program_file(file, "").empty());
}

TEST(ProgramFile, IsReplacedByALaterOne) {
  const TempFolder folder;
  const auto file = program_file_path(folder.path, "cull", "key");
  write_program_file(file, "key", binary);
  write_program_file(file, "key", {1, 2});
  EXPECT_EQ(read_program_file(file, "key"), (std::vector<unsigned char>{1, 2}));
}

TEST(ProgramFile, HasAPathOfItsOwnForEachKeyAndEntry) {
  const auto path = program_file_path("/folder", "cull", "key");
  EXPECT_EQ(path.parent_path(), "/folder");
  EXPECT_TRUE(path.filename().string().starts_with("cull-"));
  EXPECT_EQ(path, program_file_path("/folder", "cull", "key"));
  EXPECT_NE(path, program_file_path("/folder", "cull", "key2"));
  EXPECT_NE(path, program_file_path("/folder", "fill", "key"));
}

TEST(ProgramFile, ThatCannotBeWrittenIsNoError) {
  EXPECT_NO_THROW(write_program_file("/dev/null/folder/cull.bin", "key", binary));
  EXPECT_TRUE(read_program_file("/dev/null/folder/cull.bin", "key").empty());
}

}  // namespace
}  // namespace lightgrid
