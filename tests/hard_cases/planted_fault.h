// A fault that is planted into the text of the kernels, and the hard cases that are meant to find it.
#pragma once

#include <gtest/gtest.h>

#include "verify/run.h"

namespace lightgrid::lab::verify {

struct PlantedFault {
  const char *name, *right, *wrong;  // a part of the kernels, and what stands there instead
  std::vector<std::string> by;       // cases: "group/name"
  const char* kernel = "";           // only kernels whose text has this get the fault
  const char* hunted = nullptr;      // the class of the hunt of shadows that finds it soon
};

// *planted: in how many texts.
inline std::unique_ptr<CullEngine> faulty_engine(const PlantedFault& fault, int* planted) {
  return device_engine("", [fault, planted](std::string text) {
    if (text.find(fault.kernel) == text.npos) return text;
    const std::string_view right = fault.right, wrong = fault.wrong;
    size_t at = text.find(right);
    *planted += at != text.npos;
    for (; at != text.npos; at = text.find(right, at + wrong.size())) text.replace(at, right.size(), wrong);
    return text;
  });
}

// Plants the fault and expects that each of its cases fails.
inline std::unique_ptr<CullEngine> expect_found(const PlantedFault& fault) {
  int planted = 0;
  auto engine = faulty_engine(fault, &planted);
  for (const std::string& name : fault.by) {
    const auto chosen = chosen_cases("^" + name + "$");
    EXPECT_EQ(chosen.size(), 1u) << name;
    for (const HardCase* hard_case : chosen) EXPECT_TRUE(fails(*hard_case, *engine, 0)) << name;
  }
  EXPECT_GT(planted, 0) << "no kernel has this text";
  return engine;
}

inline std::string name_of_fault(const testing::TestParamInfo<PlantedFault>& info) { return info.param.name; }

}  // namespace lightgrid::lab::verify
