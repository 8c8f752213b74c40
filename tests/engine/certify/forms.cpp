#include "certify/forms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace lightgrid::certify {
namespace {

constexpr double up = 1 + 1e-12;

std::vector<std::string> factors_of(const std::string& monomial) {
  std::vector<std::string> factors;
  std::istringstream in(monomial);
  for (std::string factor; std::getline(in, factor, '*');) factors.push_back(factor);
  return factors;
}

std::string product_of(std::vector<std::string> factors) {
  std::sort(factors.begin(), factors.end());
  std::string monomial;
  for (const std::string& factor : factors) monomial += (monomial.empty() ? "" : "*") + factor;
  return monomial;
}

std::string product_of(const std::string& a, const std::string& b) {
  std::vector<std::string> factors = factors_of(a);
  for (const std::string& factor : factors_of(b)) factors.push_back(factor);
  return product_of(factors);
}

bool is_power_of_two(const Node& n) {
  int exponent;
  return n.op == 'c' && std::abs(std::frexp(n.value, &exponent)) == 0.5;
}

Form rounded(Form f) {
  f.error = f.error + (f.size + f.error) * Polynomial(u);
  return f;
}

class FormsOfPath {
 public:
  explicit FormsOfPath(const Path& path) : path_(path), known_(path.forms) {}
  const Form& of(int id) {
    if (const auto at = known_.find(id); at != known_.end()) return at->second;
    return known_[id] = computed(path_.nodes[size_t(id)]);
  }

 private:
  Form computed(const Node& n) {
    switch (n.op) {
      case 'c':
        return {Polynomial(std::abs(n.value)), {}};
      case 'n':
      case 'a':
        return of(n.a);
      case 'r':
        return rounded(of(n.a));
      case '+':
      case '-': {
        const Form a = of(n.a), b = of(n.b);
        return rounded({a.size + b.size, a.error + b.error});
      }
      case '*': {
        const Form a = of(n.a), b = of(n.b);
        const Form f{a.size * b.size, a.size * b.error + a.error * b.size + a.error * b.error};
        const bool exact =
            is_power_of_two(path_.nodes[size_t(n.a)]) || is_power_of_two(path_.nodes[size_t(n.b)]);
        return exact ? f : rounded(f);
      }
      default:
        throw std::runtime_error(std::string("no form of ") + n.op + " " + n.name);
    }
  }
  const Path& path_;
  std::map<int, Form> known_;
};

}  // namespace

double Polynomial::operator[](const std::string& monomial) const {
  const auto at = terms_.find(monomial);
  return at == terms_.end() ? 0 : at->second;
}

void Polynomial::add(const std::string& monomial, double coefficient) {
  if (coefficient != 0)
    terms_[monomial] = terms_[monomial] == 0 ? coefficient : (terms_[monomial] + coefficient) * up;
}

Polynomial Polynomial::operator+(const Polynomial& o) const {
  Polynomial sum = *this;
  for (const auto& [monomial, c] : o.terms_) sum.add(monomial, c);
  return sum;
}

Polynomial Polynomial::operator*(const Polynomial& o) const {
  Polynomial product;
  for (const auto& [m, c] : terms_)
    for (const auto& [n, d] : o.terms_) product.add(product_of(m, n), c == 1 ? d : d == 1 ? c : c * d * up);
  return product;
}

Polynomial Polynomial::with(const std::string& from, const Polynomial& to) const {
  Polynomial result;
  for (const auto& [monomial, c] : terms_) {
    std::vector<std::string> rest = factors_of(monomial);
    bool found = true;
    for (const std::string& factor : factors_of(from)) {
      const auto at = std::find(rest.begin(), rest.end(), factor);
      if (at == rest.end())
        found = false;
      else
        rest.erase(at);
    }
    if (!found)
      result.add(monomial, c);
    else
      result = result + Polynomial(product_of(rest), c) * to;
  }
  return result;
}

bool Polynomial::covers(const Polynomial& needed) const {
  return std::all_of(needed.terms_.begin(), needed.terms_.end(),
                     [&](const auto& term) { return term.second <= (*this)[term.first]; });
}

std::string Polynomial::text() const {
  std::ostringstream out;
  out.precision(8);
  for (const auto& [monomial, c] : terms_) out << " " << c / u << "u " << monomial << ";";
  return out.str();
}

Form form_of(const Path& path, int id) { return FormsOfPath(path).of(id); }

int sign_of(const Path& path, int id) {
  const auto zero = [&](int at) {
    return path.nodes[size_t(at)].op == 'c' && path.nodes[size_t(at)].value == 0;
  };
  int found = 0;
  const auto join = [&](int sign) { found = found == 0 || found == sign ? sign : 2; };
  if (const auto at = path.signs.find(id); at != path.signs.end()) join(at->second);
  for (const Choice& c : path.choices) {
    if (c.a != id || !zero(c.b) || c.op == '=') continue;
    join((c.op == '>' || c.op == 'g') == c.taken ? 1 : -1);
  }
  if (found != 0) return found;
  const Node& n = path.nodes[size_t(id)];
  const auto of = [&](int at) { return sign_of(path, at); };
  switch (n.op) {
    case 'c':
      return n.value >= 0 ? 1 : -1;
    case 's':
    case 'a':
      return 1;
    case 'n':
      return -of(n.a);
    case '*':
      return n.a == n.b ? 1 : of(n.a) * of(n.b);
    case '/':
      return of(n.a) * of(n.b);
    case '+':
      return of(n.a) == of(n.b) ? of(n.a) : 0;
    case '-':
      return of(n.a) == -of(n.b) ? of(n.a) : 0;
    default:
      return 0;
  }
}

double relative_error(const Path& path, int id, const std::map<int, double>& given, const Device& device) {
  if (const auto at = given.find(id); at != given.end()) return at->second;
  const Node& n = path.nodes[size_t(id)];
  const auto of = [&](int at) { return relative_error(path, at, given, device); };
  const auto after = [](double before, double own) { return ((1 + before) * (1 + own) - 1) * up; };
  switch (n.op) {
    case 'i':
    case 'c':
      return 0;
    case 'a':
    case 'n':
      return of(n.a);
    case 's':
      return after(1 - std::sqrt(1 - of(n.a)), device.root);
    case '*': {
      const double before = after(of(n.a), of(n.b));
      return is_power_of_two(path.nodes[size_t(n.a)]) || is_power_of_two(path.nodes[size_t(n.b)])
                 ? before
                 : after(before, u);
    }
    case '/':
      return after(after(of(n.a), 1 / (1 - of(n.b)) - 1), device.division);
    case '+':
    case '-': {
      const int a = sign_of(path, n.a), b = sign_of(path, n.b) * (n.op == '-' ? -1 : 1);
      const double most = std::max(of(n.a), of(n.b));
      return most == 0 || (a != 0 && a == b) ? after(most, u) : std::numeric_limits<double>::infinity();
    }
    default:
      return std::numeric_limits<double>::infinity();
  }
}

int direction_of(const Path& path, int id, int with) {
  if (id == with) return 1;
  const Node& n = path.nodes[size_t(id)];
  if (n.a < 0) return 0;
  const auto of = [&](int at) { return direction_of(path, at, with); };
  const auto sign = [&](int at) { return sign_of(path, at); };
  const auto join = [](int a, int b) { return a == 0 || a == b ? b : b == 0 ? a : 2; };
  // A direction times a sign; a factor of unknown sign is no hindrance where nothing changes.
  const auto times = [](int direction, int s) {
    return direction == 0 ? 0 : direction == 2 || s * s != 1 ? 2 : direction * s;
  };
  const int a = of(n.a), b = n.b < 0 ? 0 : of(n.b);
  const auto opposite = [](int d) { return d == 2 ? 2 : -d; };
  switch (n.op) {
    case 's':
    case 'f':
      return a;
    case 'n':
      return opposite(a);
    case 'a':
      return times(a, sign(n.a));
    case '+':
      return join(a, b);
    case '-':
      return join(a, opposite(b));
    case '*':
      return join(times(a, sign(n.b)), times(b, sign(n.a)));
    case '/':
      return b != 0 && sign(n.b) * sign(n.b) != 1 ? 2
                                                  : join(times(a, sign(n.b)), times(opposite(b), sign(n.a)));
    default:
      return 2;
  }
}

}  // namespace lightgrid::certify
