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

struct EffectText {
  std::string path, name, upper;
};

// The files NAME.h of shared/effects, ordered by name.
std::vector<EffectText> effects_in(const EmbeddedFiles& files) {
  constexpr std::string_view folder = "shared/effects/";
  std::vector<EffectText> effects;
  for (auto file = files.lower_bound(folder); file != files.end() && file->first.starts_with(folder);
       ++file) {
    const std::string path = file->first, name = path.substr(folder.size(), path.rfind('.') - folder.size());
    std::string upper = name;
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    effects.push_back({path, name, upper});
  }
  return effects;
}

// Defines IF_NAME_HOOK(X), which is X(list of inputs, function, list of surface inputs) if the effect has the
// list NAME_HOOK_INPUTS, or the list of another hook. Then it defines `any`, too.
std::string hook_text(const EffectText& effect, const std::string& hook, const char* any,
                      const std::string& list = "") {
  std::string lower = hook;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const std::string inputs = effect.upper + (list.empty() ? hook : list) + "_INPUTS",
                    macro = "#define IF_" + effect.upper + hook + "(X)";
  return "#ifdef " + inputs + '\n' + (any ? "#define " + std::string(any) + '\n' : "") + macro + " X(" +
         inputs + ", " + effect.name + lower + ", OWN_" + effect.upper + ")\n#else\n" + macro + "\n#endif\n";
}

// Defines HOOK_EFFECTS(X) as IF_NAME_HOOK(X) of all effects.
std::string hooks_text(const std::vector<EffectText>& effects, const std::string& hook) {
  std::string text = "#define " + hook.substr(1) + "_EFFECTS(X)";
  for (const EffectText& effect : effects) text += " IF_" + effect.upper + hook + "(X)";
  return text + '\n';
}

// Defines LIGHT_EFFECTS(X), the lists of all hooks for lights: effect by effect, as EffectState::reach_arguments
// has them.
std::string inputs_text(const std::vector<EffectText>& effects) {
  std::string text = "#define LIGHT_EFFECTS(X)";
  for (const EffectText& effect : effects) {
    for (const char* hook : {"_LIT", "_REACH", "_TINT", "_MEETS", "_SURFACE"})
      text += " IF_" + effect.upper + hook + "(X)";
  }
  return text + '\n';
}

// The definition of NAME_SURFACE_INPUTS in an effect's text, or nothing.
std::string surface_list(const std::string& text, const EffectText& effect) {
  const size_t begin = text.find("#define " + effect.upper + "_SURFACE_INPUTS(");
  if (begin == text.npos) return "";
  size_t end = text.find('\n', begin);
  while (end != text.npos && text[end - 1] == '\\') end = text.find('\n', end + 1);
  return text.substr(begin, end - begin) + '\n';
}

// The text of "shared/effect_surfaces.h": of each effect whose EFFECT_NAME is defined, the inputs that
// surfaces own. They stand before the effects' texts, since a point that is shaded has their values.
std::string surfaces_text(const EmbeddedFiles& files) {
  const std::vector<EffectText> effects = effects_in(files);
  std::string text = "#include \"shared/inputs.h\"\n";
  for (const EffectText& effect : effects) {
    const std::string list = surface_list(files.at(effect.path), effect),
                      own = "#define OWN_" + effect.upper + "(ROW)";
    text += "#ifdef EFFECT_" + effect.upper + '\n' + list + "#endif\n";
    text += "#ifdef " + effect.upper + "_SURFACE_INPUTS\n" + own + ' ' + effect.upper +
            "_SURFACE_INPUTS(ROW)\n#else\n" + own + "\n#endif\n";
    text += hook_text(effect, "_SURFACE", "HAS_SURFACE_VALUES");
  }
  return text + hooks_text(effects, "_SURFACE");
}

// The text of "shared/effects.h". It includes the effects whose EFFECT_NAME is defined. For each hook,
// BASE_EFFECTS(X) expands to X(NAME_BASE_INPUTS, NAME_base, list of surface inputs) for each that defines
// NAME_BASE_INPUTS. If any of them has a background, BACKGROUND_OF_EFFECTS is defined; if any answers for lights, REACHED_BY_EFFECTS, TINTED_BY_EFFECTS, MET_BY_EFFECTS or
// LIT_BY_EFFECTS is defined.
std::string effects_text(const EmbeddedFiles& files) {
  const std::vector<EffectText> effects = effects_in(files);
  std::string text = "#include \"shared/inputs.h\"\n#include \"shared/effect_surfaces.h\"\n";
  for (const EffectText& effect : effects) {
    text += "#ifdef EFFECT_" + effect.upper + "\n#include \"" + effect.path + "\"\n#endif\n";
    text += hook_text(effect, "_BASE", nullptr) + hook_text(effect, "_BACKGROUND", "BACKGROUND_OF_EFFECTS") +
            hook_text(effect, "_REACH", "REACHED_BY_EFFECTS") +
            hook_text(effect, "_TINT", "TINTED_BY_EFFECTS") + hook_text(effect, "_MEETS", "MET_BY_EFFECTS") +
            hook_text(effect, "_LIT", "LIT_BY_EFFECTS") + hook_text(effect, "_RADIANCE", nullptr, "_LIT") +
            hook_text(effect, "_TERMS", nullptr, "_LIT");
  }
  for (const char* hook :
       {"_BASE", "_BACKGROUND", "_REACH", "_TINT", "_MEETS", "_LIT", "_RADIANCE", "_TERMS"})
    text += hooks_text(effects, hook);
  return text + inputs_text(effects);
}

std::string text_of(std::string_view path, const EmbeddedFiles& files) {
  if (path == "shared/effects.h") return effects_text(files);
  if (path == "shared/effect_surfaces.h") return surfaces_text(files);
  return embedded_file(path, files);
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
    std::istringstream lines(text_of(path, files_));
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
