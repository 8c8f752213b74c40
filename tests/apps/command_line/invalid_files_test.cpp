// Invalid files, most of them invalid on purpose (the Khronos validator's own test files): each ends quickly
// with an image or with one line, and nothing is written except that image.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>

#include "support/run_program.h"
#include "support/shared_files.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> files_below(const fs::path& folder) {
  std::set<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) files.insert(entry.path());
  return files;
}

// Empty: valid.
std::string fault_of(const fs::path& file, const TempFolder& folder, int& status) {
  const fs::path output = folder.path / "x.png";
  fs::remove(output);
  const ProgramRun run =
      run_program({"render", file, "--size", "16x16", "-o", output, "--quiet"}, {}, std::chrono::seconds(5));
  status = run.status;
  if (run.timed_out) return "did not end";
  if (run.signal) return "ended by signal " + std::to_string(run.signal);
  std::set<fs::path> expected;
  if (run.status == 0) expected.insert(output);
  if (files_below(folder.path) != expected) return "wrote other than its image";
  const auto lines = std::count(run.err.begin(), run.err.end(), '\n');
  if (run.status == 0) return lines == 0 ? "" : "printed " + run.err;
  if (run.status != 2) return "ended with " + std::to_string(run.status) + ": " + run.err;
  if (lines != 1) return "printed " + std::to_string(lines) + " lines: " + run.err;
  if (run.err.find(file.filename().string()) == std::string::npos)
    return "does not name the file: " + run.err;
  return "";
}

TEST(InvalidFiles, EachEndsWithAnImageOrOneLineThatNamesIt) {
  LIGHTGRID_NEEDS_SHARED("scenes/invalid");
  const fs::path root = shared_folder() / "scenes/invalid";
  const auto before = files_below(root);
  std::vector<fs::path> files;
  for (const fs::path& path : before) {
    if (path.extension() == ".gltf" || path.extension() == ".glb") files.push_back(path);
  }
  ASSERT_EQ(files.size(), 292u);

  std::mutex mutex;
  std::atomic<size_t> next = 0;
  std::map<int, int> endings;
  const auto work = [&] {
    const TempFolder folder;
    for (size_t i; (i = next++) < files.size();) {
      int status = -1;
      const std::string fault = fault_of(files[i], folder, status);
      const std::lock_guard lock(mutex);
      EXPECT_EQ(fault, "") << files[i];
      ++endings[status];
    }
  };
  std::thread other(work);
  work();
  other.join();
  RecordProperty("images", endings[0]);
  RecordProperty("refused", endings[2]);
  // Both kinds must occur: a loader that refuses everything, or nothing, would be useless.
  EXPECT_GT(endings[0], 50);
  EXPECT_GT(endings[2], 50);
  EXPECT_EQ(files_below(root), before);
}

}  // namespace
}  // namespace lightgrid::app
