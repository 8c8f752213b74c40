#include "base/embedded.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

namespace lightgrid {
namespace {

// The text of "shared/effects.h". It includes each file NAME.h of shared/effects, ordered by name, if
// EFFECT_NAME is defined. BASE_EFFECTS(X) expands to X(NAME_BASE_INPUTS, NAME_base) for each file that
// defines NAME_BASE_INPUTS; REACH_EFFECTS(X) likewise. If there are any, REACHED_BY_EFFECTS is defined.
std::string effects_text(const EmbeddedFiles& files) {
  constexpr std::string_view folder = "shared/effects/";
  std::string text = "#include \"shared/inputs.h\"\n", bases = "#define BASE_EFFECTS(X)",
              reaches = "#define REACH_EFFECTS(X)";
  for (auto file = files.lower_bound(folder); file != files.end() && file->first.starts_with(folder);
       ++file) {
    const std::string path = file->first, name = path.substr(folder.size(), path.rfind('.') - folder.size());
    std::string upper = name;
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    const auto hook = [&](const std::string& kind, const std::string& function, const char* if_any) {
      const std::string inputs = upper + kind + "_INPUTS", macro = "IF_" + upper + kind + "(X)";
      text += "#ifdef " + inputs + "\n" + if_any + "#define " + macro + " X(" + inputs + ", " + name +
              function + ")\n#else\n#define " + macro + "\n#endif\n";
      return ' ' + macro;
    };
    text += "#ifdef EFFECT_" + upper + "\n#include \"" + path + "\"\n#endif\n";
    bases += hook("_BASE", "_base", "");
    reaches += hook("_REACH", "_reach", "#define REACHED_BY_EFFECTS\n");
  }
  return text + bases + '\n' + reaches + '\n';
}

// The branches of #ifs that enclose a line, outermost first. Each branch has a number of its own.
using Branches = std::vector<int>;

class Expansion {
 public:
  explicit Expansion(const EmbeddedFiles& files) : files_(files) {}

  // Leaves a file out if an earlier expansion is certainly read: its branches enclose this place. Otherwise a
  // macro makes sure that the preprocessor reads the file only once.
  void include(const std::string& path) {
    std::vector<Branches>& earlier = expanded_[path];
    const auto encloses = [&](const Branches& b) {
      return std::ranges::mismatch(b, branches_).in1 == b.end();
    };
    if (std::ranges::any_of(earlier, encloses)) return;
    const bool guarded = !earlier.empty() || !branches_.empty();
    earlier.push_back(branches_);
    std::string macro = "EXPANDED_";  // "NAME/X.h" and "NAME_X.h" have different ones
    for (const char c : path) macro += std::isalnum(uint8_t(c)) ? std::string(1, c) : c == '/' ? "__" : "_";
    if (guarded) text += "#ifndef " + macro + "\n#define " + macro + '\n';
    append(path);
    if (guarded) text += "#endif\n";
  }

  std::string text;

 private:
  void append(std::string_view path) {
    std::istringstream lines(path == "shared/effects.h" ? effects_text(files_) : embedded_file(path, files_));
    for (std::string line; std::getline(lines, line);) {
      constexpr std::string_view directive = "#include \"";
      if (line.starts_with(directive)) {
        include(line.substr(directive.size(), line.rfind('"') - directive.size()));
      } else if (line != "#pragma once") {
        follow_branches(line);
        text += line + '\n';
      }
    }
  }

  void follow_branches(std::string_view line) {
    const size_t hash = line.find_first_not_of(' ');
    if (hash == line.npos || line[hash] != '#') return;
    line.remove_prefix(std::min(line.find_first_not_of(' ', hash + 1), line.size()));
    if (line.starts_with("el") || line.starts_with("endif")) branches_.pop_back();
    if (line.starts_with("el") || line.starts_with("if")) branches_.push_back(++count_);
  }

  const EmbeddedFiles& files_;
  std::map<std::string, std::vector<Branches>> expanded_;
  Branches branches_;
  int count_ = 0;
};

}  // namespace

const std::string& embedded_file(std::string_view path, const EmbeddedFiles& files) {
  const auto found = files.find(path);
  if (found == files.end()) {
    std::fprintf(stderr, "no embedded file \"%.*s\"\n", int(path.size()), path.data());
    std::abort();
  }
  return found->second;
}

std::string with_includes(std::string_view path, const EmbeddedFiles& files) {
  Expansion expansion(files);
  expansion.include(std::string(path));
  return std::move(expansion.text);
}

}  // namespace lightgrid
