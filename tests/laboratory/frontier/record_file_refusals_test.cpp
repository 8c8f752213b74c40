// Parts that are refused, or cannot be written.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "frontier/part_file.h"

namespace lightgrid::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(RecordFile, RefusesAFileOfAnotherRun) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  const auto fault_with = [&](auto change) {
    FrontierPart other = some_part();
    change(other);
    return part.fault(other);
  };
  const std::string path = part.path.string();
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.request = "fff"; }),
              AllOf(HasSubstr(path), HasSubstr("request"), HasSubstr("0123456789abcdef is not fff")));
  EXPECT_EQ(fault_with([](FrontierPart& p) { p.commit = "abc"; }),
            path + ": commit 9d11b69 is not abc, that of this run");
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.seed = 2; }),
              HasSubstr("seed 18446744073709551615 is not 2"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.baseline = "forward"; }),
              HasSubstr("baseline forward_plus is not forward"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.shard = 2; }), HasSubstr("is shard 1 of 4, not 2"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.shards = 5; }), HasSubstr("number of shards 4 is not 5"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.machine.cpu = "Epyc"; }),
              HasSubstr("begun with CPU \"Xeon\", here it is \"Epyc\""));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.machine.cl_driver = "PoCL 5"; }),
              HasSubstr("OpenCL driver"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.machine.threads = 64; }), HasSubstr("threads"));
  EXPECT_EQ(part.text(), whole);

  FrontierPart later = some_part();  // another load, clock and governor are the same machine
  later.machine.load_at_start = 3;
  later.machine.clock_mhz = 900;
  later.machine.governor = "powersave";
  EXPECT_EQ(part.open(later).part().machine.load_at_start, 0.25);
}

// Nothing of somebody's own file is cut off.
TEST(RecordFile, RefusesAFileThatIsNoPart) {
  PartFile part;
  for (const char* text : {"glTF without newline", "{\"lightgrid\":", "a,b\n1,2\n", "{\"asset\": {}}\n", "\n",
                           "{\"lightgrid_frontier\":2,\"request\":\"x\"}\n"}) {
    write_text(part.path, text);
    EXPECT_THAT(part.fault(),
                AllOf(HasSubstr(part.path.string() + ": line 1: "), HasSubstr("not a part of a frontier")));
    EXPECT_EQ(part.text(), text);
  }
  write_text(part.path, "");
  EXPECT_THAT(fault_of([&] { read_part(part.path, nullptr); }), HasSubstr("not a part of a frontier"));
  EXPECT_THAT(fault_of([&] { read_part(part.folder.path, nullptr); }), HasSubstr("no such file"));
}

TEST(RecordFile, IsOfOneProcessAtATime) {
  PartFile part;
  const RecordFile file = part.open();
  EXPECT_THAT(part.fault(), HasSubstr("another process is writing it"));
}

TEST(RecordFile, RefusesWhatCannotBeWritten) {
  const TempFolder folder;
  write_text(folder.path / "file", "");
  const auto fault_at = [&](const std::filesystem::path& path) {
    return fault_of([&] { RecordFile(path, some_part(), nullptr); });
  };
  EXPECT_THAT(fault_at(folder.path), HasSubstr(folder.path.string() + ": cannot be written: "));
  EXPECT_THAT(fault_at(folder.path / "file" / "x"), HasSubstr("cannot be written: Not a directory"));
  EXPECT_THAT(fault_at(folder.path / "none" / "x"), HasSubstr("cannot be written: No such file"));

  using std::filesystem::perms;
  std::filesystem::permissions(
      folder.path, perms::owner_read | perms::owner_exec | perms::others_read | perms::others_exec);
  const uid_t user = geteuid();  // root may write anywhere
  ASSERT_EQ(user == 0 ? seteuid(65534) : 0, 0);
  const std::string fault = fault_at(folder.path / "x");
  ASSERT_EQ(user == 0 ? seteuid(0) : 0, 0);
  EXPECT_EQ(fault, (folder.path / "x").string() + ": cannot be written: Permission denied");
}

TEST(RecordFile, TellsThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(fault_of([] { RecordFile("/dev/full", some_part(), nullptr); }, ErrorKind::machine),
            "/dev/full: cannot be written: No space left on device");
}

// A limit on file sizes fills the disk in the middle of a line.
TEST(RecordFile, HoldsNoHalfLineWhenTheDiskIsFull) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  RecordFile file = part.open();
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit tight = before;
  tight.rlim_cur = whole.size() + 100;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const std::string fault = fault_of([&] { file.append(some_record(8, 3)); }, ErrorKind::machine);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(fault, part.path.string() + ": cannot be written: File too large");
  EXPECT_EQ(part.text(), whole);
  EXPECT_EQ(file.part().records.size(), 3u);
  file.append(some_record(8, 3));
  EXPECT_EQ(read_part(part.path, nullptr).records.size(), 4u);
}

}  // namespace
}  // namespace lightgrid::lab
