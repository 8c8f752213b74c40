// Bounds of rounding errors: valid for all magnitudes as long as nothing under- or overflows.
#pragma once

#include "certify/real.h"

namespace lightgrid::certify {

// The form of a node, from those that its path gives. Division, square root and floor have no form unless given: they
// throw.
Form form_of(const Path& path, int id);

// 1 where the node is never negative, -1 where never positive, else 0, from the path's signs and its comparisons with
// 0. 2: the comparisons contradict it.
int sign_of(const Path& path, int id);

// A bound of the relative error of a node whose sums never cancel: terms have one sign, or both are inputs. Infinite
// where a sum may cancel. `given`: of nodes other than inputs, which are exact. Relative errors of division and
// square root, in u: 1 where they are rounded correctly.
struct Device {
  double division = u, root = u;
};
double relative_error(const Path& path, int id, const std::map<int, double>& given = {},
                      const Device& device = {});

// Whether the node grows (1), falls (-1) or neither (0) with another node, all else fixed; 2: unknown.
int direction_of(const Path& path, int id, int with);

}  // namespace lightgrid::certify
