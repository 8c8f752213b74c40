// The places that a technique, a cull test and an error measure need: the source files that name them are
// counted (docs/overview.md#how-to-add).
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "results/error_measures.h"
#include "shared/cull_settings.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "techniques/technique.h"

namespace lightgrid {
namespace {

using testing::IsEmpty;
using Naming = std::map<std::string, std::set<std::string>>;  // of each file what it names

// Comments may name anything.
std::string code_of(const std::string& text) { return std::regex_replace(text, std::regex("//[^\n]*"), ""); }

std::string text_at(const std::string& path) {
  return file_bytes(std::filesystem::path(source_folder) / path);
}

// Files of these folders of the checkout in which one of an item's texts stands.
Naming files_that_name(const std::vector<std::string>& folders,
                       const std::map<std::string, std::vector<std::string>>& texts) {
  const std::filesystem::path root = source_folder;
  Naming found;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string code = code_of(file_bytes(entry.path()));
      for (const auto& [item, own_texts] : texts) {
        if (std::ranges::any_of(own_texts, [&](auto& text) { return code.find(text) != code.npos; }))
          found[entry.path().lexically_relative(root).generic_string()].insert(item);
      }
    }
  }
  return found;
}

// What one of the two says and the other does not: lines "FILE: NAME".
std::set<std::string> differences(const Naming& found, const Naming& expected) {
  std::set<std::string> lines[2], apart;
  for (const Naming* naming : {&found, &expected}) {
    for (const auto& [file, names] : *naming) {
      for (const std::string& name : names) lines[naming == &expected].insert(file + ": " + name);
    }
  }
  std::ranges::set_symmetric_difference(lines[0], lines[1], std::inserter(apart, apart.end()));
  return apart;
}

std::vector<std::string> mentions(const std::string& text, const std::string& word) {
  const std::regex whole("\\b" + word + "\\b");
  std::vector<std::string> all;
  for (std::sregex_iterator at(text.begin(), text.end(), whole), end; at != end; ++at)
    all.push_back(at->str());
  return all;
}

// Its own file, a declaration and a row in registry.cpp, and its page (Techniques.HaveAPageEach…). Files that
// name a technique as text do so by choice; none of them needs a new one.
TEST(Adding, ATechniqueTakesItsFileAndTheRegistry) {
  std::map<std::string, std::vector<std::string>> texts;
  Naming expected = {
      // Defaults of commands, and the techniques that stand in for others without OpenGL.
      {"src/app/cull.cpp", {"forward_plus"}},
      {"src/app/inspect.cpp", {"forward_plus"}},
      {"src/app/plan.cpp", {"forward_plus"}},
      {"src/app/view.cpp", {"deferred_tiled", "forward_plus"}},
      {"src/bench/culling_run.cpp", {"forward_plus"}},
      {"src/capture/capture.cpp", {"forward_plus", "visibility"}},
      {"src/frontier/precision.cpp", {"forward_plus", "visibility"}},
      {"src/session/comparison.cpp", {"forward", "forward_plus", "visibility"}},
      {"src/session/scene_choice.cpp", {"forward_plus", "visibility"}},
      // The reference.
      {"src/frontier/brute_force.cpp", {"forward", "visibility"}},
      {"src/session/runs.cpp", {"forward", "visibility"}},
      // Messages of its own passes.
      {"src/passes/light_index/blending_probe.cpp", {"lidr"}},
      {"src/passes/light_index/layout.cpp", {"lidr"}},
      // What is varied, markers of some families, and a sentence about two.
      {"src/frontier/points.cpp",
       {"deferred_tiled", "forward_plus", "lidr", "visibility", "voxel_lights", "world_grid"}},
      {"src/frontier/plots.cpp", {"clustered", "deferred", "lidr", "visibility"}},
      {"src/report/overview.cpp", {"clustered", "forward_plus"}},
  };
  const std::string registry = code_of(text_at("src/techniques/registry.cpp"));
  for (const Technique* t : techniques()) {
    const std::string name = t->name;
    texts[name] = {'"' + name + '"', '"' + name + ':', "extern const Technique " + name + "{"};
    expected["src/techniques/" + name + ".cpp"] = {name};
    EXPECT_EQ(mentions(registry, name).size(), 2u) << name;
  }
  EXPECT_THAT(differences(files_that_name({"src"}, texts), expected), IsEmpty());
}

// Its row with its number, and its function in light_cell_tests.h, where tests of planes share one.
TEST(Adding, ACullTestTakesItsRowAndItsFunction) {
  std::map<std::string, std::vector<std::string>> texts;
  std::set<std::string> all;
  const std::string numbers = text_at("src/shared/cull_settings.h");
  const std::regex number("#define CULL_(\\w+) \\d");
  for (std::sregex_iterator at(numbers.begin(), numbers.end(), number), end; at != end; ++at) {
    std::string upper = (*at)[1], lower = upper;
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    all.insert(lower);
    for (const char* after : {"\n", " ", ")", ",", "}", ";"}) {
      texts[lower].push_back("CullTest::" + lower + after);
      texts[lower].push_back("CULL_" + upper + after);
    }
  }
  EXPECT_EQ(all.size(), std::size(cull_tests));
  const Naming expected = {
      {"src/shared/cull_settings.h", all},
      {"kernels/culling/light_cell_tests.h", {"exact", "planes", "sphere"}},
      // The default.
      {"src/culling/light_culler.h", {"planes_aabb"}},
      {"src/plan/settings.h", {"planes_aabb"}},
      // Kernels that compute more, or less, for one test.
      {"kernels/culling/bin_cells.h", {"exact"}},
      {"kernels/culling/bin_tiles.h", {"exact"}},
      {"kernels/culling/cell.h", {"exact"}},
      {"kernels/culling/project.h", {"aabb", "planes_aabb", "sphere"}},
      // Checks that hold between certain tests.
      {"src/verify/agreement.cpp", {"aabb", "exact", "planes", "planes_aabb"}},
      {"src/verify/camera.cpp", {"exact", "planes"}},
      {"src/verify/depth_bounds.cpp", {"exact"}},
      {"src/verify/lists.cpp", {"exact"}},
  };
  EXPECT_THAT(differences(files_that_name({"src", "kernels"}, texts), expected), IsEmpty());
}

// Its field, and its function with its row in error_measures.cpp.
TEST(Adding, AnErrorMeasureTakesItsFieldAndItsRow) {
  std::map<std::string, std::vector<std::string>> texts;
  std::set<std::string> all;
  for (const ErrorMeasure& measure : error_measures()) {
    const std::string key = measure.key;
    all.insert(key);
    texts[key] = {"ImageError::" + key + ",", '"' + key + "\", \""};
    const std::string results = text_at("src/results/results.h");
    const size_t begin = results.find("struct ImageError {");
    const std::string fields = results.substr(begin, results.find("};", begin) - begin);
    EXPECT_THAT(fields, testing::HasSubstr("  double " + key + " = 0;"));
  }
  const Naming expected = {
      {"src/results/error_measures.cpp", all},
      // The frontier's own records have a max_rel.
      {"src/frontier/answer_csv.cpp", {"max_rel"}},
      {"src/frontier/gate.cpp", {"max_rel"}},
      {"src/frontier/page/figures.js", {"max_rel"}},
  };
  EXPECT_THAT(differences(files_that_name({"src"}, texts), expected), IsEmpty());
}

}  // namespace
}  // namespace lightgrid
