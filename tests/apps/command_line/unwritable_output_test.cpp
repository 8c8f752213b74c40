// Output that cannot be written: a full device, a full disk under files and PoCL's cache, too little memory.
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "support/run_command.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

using Words = std::vector<std::string>;

// One picture of few pixels, by OpenCL alone.
const Words small_picture = {"render", "spheres", "--size",     "32x18", "--lights",
                             "3",      "-t",      "visibility", "--gl",  "none"};

Words with_words(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class FullStdout : public testing::TestWithParam<const char*> {};

TEST_P(FullStdout, EndsWithThreeAndOneLineThatNamesIt) {
  const TempFolder folder;
  std::string words = GetParam();
  if (const size_t at = words.find("FOLDER"); at != std::string::npos) words.replace(at, 6, folder.path);
  std::istringstream stream(words);
  const ProgramRun run = run_program(Words(std::istream_iterator<std::string>(stream), {}), {},
                                     std::chrono::seconds(120), "/dev/full");
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("lightgrid: stdout: cannot be written: No space left on device\n"));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

// Each command that prints results, as text and as JSON, and help.
INSTANTIATE_TEST_SUITE_P(
    Each, FullStdout,
    testing::Values(
        "--help", "compare --help", "scenes", "scenes --json -", "techniques", "techniques --json -",
        "devices", "devices --json -", "plan spheres", "plan spheres --json -", "verify --list",
        "verify --list --json -",
        "render spheres --size 16x9 -t visibility --gl none -o FOLDER/x.png --json -",
        "compare spheres --size 16x9 --frames 1 -t visibility --gl none -o FOLDER/report",
        "compare spheres --size 16x9 --frames 1 -t visibility --gl none -o FOLDER/report --json -",
        "capture spheres --size 16x9 -t visibility --gl none -o FOLDER/frame",
        "inspect spheres --size 16x9 -t visibility --gl none --pixel 8,4",
        "inspect spheres --size 16x9 -t visibility --gl none --pixel 8,4 --json -"));

TEST(ClosedStdout, IsNoFileOfTheProgram) {
  const TempFolder folder;
  const std::string file = folder.path / "scenes.json";
  const CommandOutcome run =
      run_command("\"" + std::string(lightgrid_program) + "\" render spheres --size 16x9 " +
                  "-t visibility --gl none -o " + std::string(folder.path / "x.png") +
                  " --json - 2>&1 >&-; echo status $?");
  EXPECT_THAT(run.output, HasSubstr("lightgrid: stdout: cannot be written: Bad file descriptor"));
  EXPECT_THAT(run.output, HasSubstr("status 3"));
}

TEST(FullDevice, AsAFileOfResultsIsNamed) {
  const ProgramRun run = run_program({"scenes", "--json", "/dev/full"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.err, "lightgrid: /dev/full: cannot be written: No space left on device\n");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

// Runs the program where `folder` is a file system of its own, of `size`. Needs namespaces that a user may
// make.
ProgramRun run_on_small_disk(const TempFolder& folder, const std::string& size, const Words& words,
                             const Words& environment = {}) {
  Words all = {"unshare",
               "-rm",
               "sh",
               "-c",
               "mount -t tmpfs -o size=" + size + " none \"$0\" && exec \"$@\"",
               folder.path,
               lightgrid_program};
  return run_words(with_words(all, words), environment);
}

#define NEEDS_SMALL_DISK()                                                                  \
  {                                                                                         \
    const TempFolder tried;                                                                 \
    const ProgramRun run = run_on_small_disk(tried, "1m", {"--help"});                      \
    if (run.status != 0) GTEST_SKIP() << "no file system can be mounted here: " << run.err; \
  }

TEST(FullDisk, UnderPoclsCacheIsLeftForATemporaryFolder) {
  NEEDS_SMALL_DISK();
  const TempFolder disk, temporary, output;
  const std::string image = output.path / "x.png";
  const ProgramRun run = run_on_small_disk(
      disk, "64k", with_words(small_picture, {"-o", image}),
      {"XDG_CACHE_HOME=" + disk.path.string(), "LIGHTGRID_TUNED=off", "TMPDIR=" + temporary.path.string()});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(image));
  EXPECT_THAT(run.err, HasSubstr((disk.path / "pocl/kcache").string() + ": its disk is full"));
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path)) << "its temporary folder is left behind";
}

// The compiler and PoCL then end the process themselves, by exit(1) or abort().
TEST(FullDisk, UnderThePoclCacheThatTheUserNamesEndsWithThreeAndALineThatNamesIt) {
  NEEDS_SMALL_DISK();
  for (const char* size : {"64k", "256k", "600k"}) {
    const TempFolder disk, output;
    const ProgramRun run = run_on_small_disk(
        disk, size,
        with_words(small_picture, {"--device", "Portable Computing Language", "-o", output.path / "x.png"}),
        {"POCL_CACHE_DIR=" + disk.path.string(), "LIGHTGRID_CL_CACHE=driver", "LIGHTGRID_TUNED=off"});
    if (run.err.find("no OpenCL device's name") != std::string::npos) GTEST_SKIP() << "not PoCL: " << run.err;
    EXPECT_EQ(run.status, 3) << size << " signal " << run.signal << ": " << run.err;
    EXPECT_THAT(run.err, HasSubstr("lightgrid: " + disk.path.string() + ": no room for compiled kernels"))
        << size;
  }
}

TEST(FullDisk, UnderAReportEndsWithThreeAndALineThatNamesTheFile) {
  NEEDS_SMALL_DISK();
  const TempFolder disk;
  const ProgramRun run = run_on_small_disk(disk, "16k",
                                           {"compare", "spheres", "--size", "64x36", "--frames", "1", "-t",
                                            "visibility", "--gl", "none", "-o", disk.path / "report"});
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("lightgrid: " + (disk.path / "report").string()));
  EXPECT_THAT(run.err, HasSubstr("No space left on device"));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

// Earlier output is removed with the folder that the run made.
TEST(FullDisk, UnderAReportLeavesNothing) {
  NEEDS_SMALL_DISK();
  const TempFolder disk;
  const ProgramRun run = run_words(
      {"unshare", "-rm", "sh", "-c",
       "mount -t tmpfs -o size=16k none \"$0\"; \"$@\" -o \"$0/report\"; echo status $?; ls -A \"$0\"",
       disk.path, lightgrid_program, "compare", "spheres", "--size", "64x36", "--frames", "1", "-t",
       "visibility", "--gl", "none"});
  EXPECT_EQ(run.out, "status 3\n") << run.err;
}

// As nobody where the tests run as root, whom no permission holds.
TEST(FolderOfAnother, EndsWithTwoAndOneLineAndNothingIsLeft) {
  const TempFolder others, temporary;
  const auto inside = others.path / "inside";
  std::filesystem::create_directories(inside);
  std::filesystem::permissions(temporary.path, std::filesystem::perms::all);
  std::filesystem::permissions(others.path, std::filesystem::perms::all);
  const bool root = geteuid() == 0;
  Words as_nobody;
  if (root) as_nobody = {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
  if (root && run_words(with_words(as_nobody, {lightgrid_program, "--version"})).status != 0)
    GTEST_SKIP() << "nobody cannot run the program here";
  const auto expect_line = [&](const std::string& command, const std::string& output,
                               const std::string& why) {
    const ProgramRun run = run_words(
        with_words(with_words(as_nobody, {lightgrid_program, command, "spheres", "--quiet", "-o"}), {output}),
        {"HOME=/dev/null", "XDG_CACHE_HOME=/dev/null", "LIGHTGRID_TUNED=off",
         "TMPDIR=" + temporary.path.string()});
    EXPECT_EQ(run.status, 2) << command << ": " << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(output)) << command;
    EXPECT_THAT(run.err, HasSubstr(why)) << command;
  };
  using std::filesystem::perms;
  std::filesystem::permissions(
      inside, perms::owner_read | perms::owner_exec | perms::others_read | perms::others_exec);
  for (const char* command : {"compare", "capture", "frontier"}) {
    expect_line(command, inside, "no file can be made in it: Permission denied");
    expect_line(command, inside / "new", "cannot be made a folder: Permission denied");
  }
  expect_line("render", inside / "x.png",
              "no file can be made in " + inside.string() + ": Permission denied");
  std::filesystem::permissions(others.path, perms::none);
  for (const char* command : {"compare", "capture", "frontier"})
    expect_line(command, inside / "new", "cannot be made a folder: Permission denied");
  expect_line("render", inside / "x.png", inside.string() + ": Permission denied");
  std::filesystem::permissions(others.path, perms::all);
  EXPECT_TRUE(std::filesystem::is_empty(inside));
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path)) << "the temporary cache is left behind";
}

// Ends it by `signal` once its temporary cache is in use.
TEST(TemporaryCacheFolder, IsRemovedByAnInterrupt) {
  for (const char* signal : {"INT", "TERM", "HUP", "KILL"}) {
    const TempFolder temporary, output;
    // A shell lets what it starts in the background ignore SIGINT.
    const std::string script =
        "env --default-signal \"$@\" & for i in $(seq 1000); do sleep 0.02; "
        "ls \"$TMPDIR\"/*/* >/dev/null 2>&1 && break; done; kill -" +
        std::string(signal) + " $!; kill -" + signal +
        " $! 2>/dev/null; wait $!; echo $?; for i in $(seq 500); do "
        "ls \"$TMPDIR\" | grep -q . || exit 0; sleep 0.02; done; exit 1";
    const ProgramRun run =
        run_words(with_words({"sh", "-c", script, "sh", lightgrid_program},
                             with_words(small_picture, {"--frames", "10000", "-o", output.path / "x.png"})),
                  {"HOME=/dev/null", "XDG_CACHE_HOME=/dev/null", "LIGHTGRID_TUNED=off",
                   "TMPDIR=" + temporary.path.string()});
    EXPECT_EQ(run.status, 0) << signal << ": its temporary folder is left behind " << run.err;
    EXPECT_THAT(run.out, AnyOf(HasSubstr("130"), HasSubstr("143"), HasSubstr("129"), HasSubstr("137")))
        << "ended by itself";
  }
}

// A limit of address space ends drivers in many ways: no device, an exception in a thread of theirs, abort().
TEST(TooLittleMemory, IsToldAsThat) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer needs terabytes of address space";
#endif
  const TempFolder output;
  for (const char* limit_kb : {"200000", "250000", "300000", "340000", "400000", "550000"}) {
    const ProgramRun run = run_words(with_words(
        {"sh", "-c", "ulimit -v " + std::string(limit_kb) + "; exec \"$@\"", "sh", lightgrid_program},
        {"render", "hall", "--size", "640x360", "-t", "forward_plus", "-o", output.path / "x.png"}));
    EXPECT_EQ(run.status, 3) << limit_kb << " signal " << run.signal << ": " << run.err;
    EXPECT_THAT(run.err, AnyOf(HasSubstr("out of memory"), HasSubstr("_MEMORY"))) << limit_kb;
  }
}

}  // namespace
}  // namespace lightgrid::app
