#include "certify/gappa.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <set>

#include "certify/forms.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace lightgrid::certify {
namespace {

// An expression in Gappa's language: e<i> is exact, r<i> has a rounding after each operation.
class Script {
 public:
  explicit Script(const Path& path) : path_(path) {}

  // Asks for the relative error of a node, with each exact number of it between 2^-60 and 2^60.
  std::string of(int id) {
    define(id);
    std::string given;
    for (const std::string& fact : facts_) given += (given.empty() ? "" : " /\\ ") + fact;
    return fmt::format("@f = float<ieee_32,ne>;\n{}{{ {} -> {} -/ {} in ? }}\n", definitions_, given,
                       name('r', id), name('e', id));
  }

 private:
  const Node& node(int id) const { return path_.nodes[size_t(id)]; }

  std::string name(char kind, int id) const {
    if (node(id).op == 'i') return node(id).name;
    if (node(id).op != 'c') return fmt::format("{}{}", kind, id);
    int exponent;
    const double mantissa = std::frexp(node(id).value, &exponent);
    return fmt::format("{}b{}", int64_t(std::ldexp(mantissa, 53)), exponent - 53);
  }

  std::string expression(char kind, int id) const {
    const Node& n = node(id);
    if (n.op == 's') return fmt::format("sqrt({})", name(kind, n.a));
    if (n.op == 'a') return fmt::format("|{}|", name(kind, n.a));
    if (n.op == 'n') return fmt::format("-{}", name(kind, n.a));
    return fmt::format("{} {} {}", name(kind, n.a), n.op, name(kind, n.b));
  }

  void define(int id) {
    const Node& n = node(id);
    if (n.op == 'c' || !defined_.insert(id).second) return;
    if (n.op == 'i') {
      definitions_ += fmt::format("{0} = f(X{0});\n", n.name);
      return;
    }
    define(n.a);
    if (n.b >= 0) define(n.b);
    const bool rounds = n.op != 'a' && n.op != 'n';
    definitions_ += fmt::format("r{0} {1}= {2};\ne{0} = {3};\n", id, rounds ? "f" : "", expression('r', id),
                                expression('e', id));
    if (!rounds) return;
    for (const char* kind : {"e", "r"}) facts_.push_back(fmt::format("|{}{}| in [1b-61,1b61]", kind, id));
    if (n.op == 's') facts_.push_back(fmt::format("{} in [1b-60,1b60]", name('e', n.a)));
    if (n.op != '+' && n.op != '-') return;
    const int a = sign_of(path_, n.a), b = sign_of(path_, n.b) * (n.op == '-' ? -1 : 1);
    if (a == 0 || a != b) return;
    // Terms of one sign: each is a part of the sum.
    facts_.push_back(fmt::format("{} / e{} in [0,1]", name('e', n.a), id));
    facts_.push_back(fmt::format("{} / e{} in [{}]", name('e', n.b), id, n.op == '-' ? "-1,0" : "0,1"));
  }

  const Path& path_;
  std::set<int> defined_;
  std::string definitions_;
  std::vector<std::string> facts_;
};

}  // namespace

Proved prove_by_gappa(const std::vector<Path>& paths, const std::function<bool(const Path&)>& skip) {
  const TempFolder folder;
  std::set<std::string> scripts;
  Proved proved;
  for (const Path& path : paths)
    for (const int id : path.results) {
      if (path.nodes[size_t(id)].op == 'c' || skip(path)) continue;
      const std::string script = Script(path).of(id);
      if (!scripts.insert(script).second) continue;
      const std::string file = (folder.path / fmt::format("{}.g", scripts.size())).string();
      std::ofstream(file) << script;
      const std::string answer = run_command("gappa 2>&1 " + file).output;
      // "r9 -/ e9 in [-a, b {6e-07, 2^(-20.6)}]", or {-a {..}, b {..}}
      double bound = 0;
      size_t at = answer.find(" in ");
      if (at == std::string::npos) bound = INFINITY;
      for (; at != std::string::npos && (at = answer.find('{', at)) != std::string::npos; ++at)
        bound = std::max(bound, std::abs(std::stod(answer.substr(at + 1))));
      proved.largest = std::max(proved.largest, bound == 0 ? INFINITY : bound);
    }
  proved.scripts = scripts.size();
  return proved;
}

bool has_gappa() { return run_command("command -v gappa").status == 0; }

}  // namespace lightgrid::certify
