// Bounds as polynomials in the sizes of inputs, and the form of a number: a bound of its size and of its error.
// u = 2^-24 bounds the relative error of one operation.
#pragma once

#include <map>
#include <string>

namespace lightgrid::certify {

constexpr double u = 0x1p-24;

// Coefficients >= 0 of monomials: "" is 1, "R" a size, "R*side" a product (factors sorted). Each operation
// rounds coefficients up.
class Polynomial {
 public:
  Polynomial() = default;
  Polynomial(double constant) { add("", constant); }
  Polynomial(const std::string& size, double factor = 1) { add(size, factor); }
  double operator[](const std::string& monomial) const;
  void add(const std::string& monomial, double coefficient);
  Polynomial operator+(const Polynomial& o) const;
  Polynomial operator*(const Polynomial& o) const;
  // Each monomial `from`, times the rest of a product, becomes `to` times that.
  Polynomial with(const std::string& from, const Polynomial& to) const;
  // Whether no coefficient of `needed` is larger than here; all coefficients as text, in u.
  bool covers(const Polynomial& needed) const;
  std::string text() const;
  const std::map<std::string, double>& terms() const { return terms_; }

 private:
  std::map<std::string, double> terms_;
};

// |exact| <= size and |computed - exact| <= error.
struct Form {
  Polynomial size, error;
};

// A number of this size whose relative error is at most `relative`.
inline Form sized(const std::string& size, double relative = 0) { return {size, Polynomial(size, relative)}; }

}  // namespace lightgrid::certify
