// Files with faults: those of the format's own validator, and those of the conformance set with changed
// bytes. Those that load are also posed at one time.
#include <algorithm>
#include <fstream>
#include <random>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/timer.h"
#include "scene/animation.h"
#include "scene/load_gltf.h"
#include "support/shared_files.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

// Small limits, so that files with the largest allowed sizes are still processed quickly.
constexpr GltfLimits limits{
    .max_image_side = 4096, .max_image_bytes = size_t(1) << 28, .max_vertices = 1'000'000};

std::vector<fs::path> gltf_files_below(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

// At a time between keys, or past them; a pose that is not finite is an input error too.
void pose(Scene& scene) {
  try {
    set_time(scene, 0.37 * duration_of(scene) + 1e-3);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
  }
}

// False if it is refused; anything except a scene or an input error fails the test.
bool loads(const fs::path& path) {
  try {
    Scene scene = load_gltf(path, -1, limits);
    pose(scene);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return false;
  }
}

class GltfHostile : public testing::Test {
  void SetUp() override { set_log_level(LogLevel::quiet); }
  void TearDown() override { set_log_level(LogLevel::normal); }
};

TEST_F(GltfHostile, every_file_of_the_validator_ends_in_a_scene_or_an_input_error) {
  LIGHTGRID_NEEDS_SHARED("scenes/invalid/glTF-Validator");
  const std::vector<fs::path> files = gltf_files_below(shared_folder() / "scenes/invalid/glTF-Validator");
  ASSERT_EQ(files.size(), 292u);
  int refused = 0;
  for (const fs::path& file : files) {
    const Timer timer;
    const bool loaded = loads(file);
    refused += !loaded;
    EXPECT_LT(timer.elapsed_ms(), 2000) << file;
    EXPECT_TRUE(loaded || file.stem() != "valid") << file;
  }
  EXPECT_EQ(refused, 81) << "as docs/gltf.md says";
}

class Mutator {
 public:
  Mutator(const fs::path& file, uint32_t seed) : random_(seed) {
    std::ifstream in(file, std::ios::binary);
    original_.assign(std::istreambuf_iterator<char>(in), {});
  }

  std::string next() {
    std::string out = original_;
    for (int change = 0; change < 1 + int(random_() % 4); ++change) {
      const size_t at = random_() % out.size();
      switch (random_() % 5) {
        case 0:
          out[at] = static_cast<char>(random_());
          break;
        case 1:
          out[at] ^= static_cast<char>(1 << random_() % 8);
          break;
        case 2:
          out.erase(at, random_() % 8);
          break;
        case 3:
          out.insert(at, out.substr(random_() % out.size(), random_() % 16));
          break;
        default:
          change_digit(out, at);
          break;
      }
      if (out.empty()) return original_;
    }
    return out;
  }

 private:
  // Numbers are the most sensitive: another digit, a longer number, a sign, an exponent.
  void change_digit(std::string& text, size_t from) {
    const size_t at = text.find_first_of("0123456789", from);
    if (at == std::string::npos) return;
    static constexpr const char* values[] = {"0",     "9",   "-1", "4294967296", "99999999999999999999",
                                             "1e300", "0.5", "255"};
    text.replace(at, 1, values[random_() % std::size(values)]);
  }

  std::string original_;
  std::mt19937 random_;
};

// std::mt19937 gives the same numbers everywhere, so a failure's seed is enough to see it again.
TEST_F(GltfHostile, changed_bytes_end_in_a_scene_or_an_input_error) {
  LIGHTGRID_NEEDS_SHARED("scenes/conformance");
  constexpr int rounds = 60;
  for (const fs::path& file : gltf_files_below(shared_folder() / "scenes/conformance")) {
    if (fs::file_size(file) > 100'000) continue;
    const TempFolder folder;
    fs::copy(file.parent_path(), folder.path, fs::copy_options::recursive);
    Mutator mutator(file, 7);
    int loaded = 0;
    for (int round = 0; round < rounds; ++round) {
      std::ofstream(folder.path / file.filename(), std::ios::binary) << mutator.next();
      SCOPED_TRACE(fmt::format("{} round {}", file.string(), round));
      const Timer timer;
      loaded += loads(folder.path / file.filename());
      EXPECT_LT(timer.elapsed_ms(), 5000);
    }
    EXPECT_GT(rounds - loaded, 0) << file << ": no change was noticed";
  }
}

// The validator's files are the seeds closest to the loader's checks.
TEST_F(GltfHostile, changed_bytes_of_wrong_files_end_in_a_scene_or_an_input_error) {
  LIGHTGRID_NEEDS_SHARED("scenes/invalid/glTF-Validator");
  const TempFolder folder;
  for (const fs::path& file : gltf_files_below(shared_folder() / "scenes/invalid/glTF-Validator")) {
    if (fs::file_size(file) == 0) continue;
    Mutator mutator(file, 11);
    for (int round = 0; round < 10; ++round) {
      std::ofstream(folder.path / file.filename(), std::ios::binary) << mutator.next();
      SCOPED_TRACE(fmt::format("{} round {}", file.string(), round));
      loads(folder.path / file.filename());
    }
  }
}

}  // namespace
}  // namespace lightgrid
