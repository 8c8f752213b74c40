// The points of a frontier: techniques with settings. By default a star around the defaults: each technique
// as it is, then one setting at a time.
#pragma once

#include <string>
#include <vector>

#include "frontier/record.h"
#include "session/compare.h"

namespace lightgrid {

struct ChosenPoint {
  Contestant contestant;
  int frames = 1;  // averaged, each with other random ranges
  std::string label;
};

// `techniques` as compare's -t, or empty: the default points, of which those that need OpenGL are left out
// without it. `vary`: "KEY=V1,V2": each technique that reads KEY with each value, one key at a time;
// "frames=1,4,16": averaged frames of points with range=stochastic. Duplicates are dropped. Throws
// Error(input) that names what is wrong.
std::vector<ChosenPoint> chosen_points(const std::vector<std::string>& techniques,
                                       const std::vector<std::string>& vary, const Settings& common,
                                       bool opengl);

// The point with which each other is measured in turn: forward_plus as it is or, without OpenGL, visibility.
ChosenPoint baseline_point(const Settings& common, bool opengl);

// "visibility:range=cutoff,cutoff=0.05": what differs from the defaults and has an effect.
std::string label_of(const Contestant& contestant, int frames);

}  // namespace lightgrid
