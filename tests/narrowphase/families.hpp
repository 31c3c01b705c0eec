// The families of box pairs as parameters of tests.
#pragma once

#include "bench/narrowphase/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace scree {

inline std::string test_name(const testing::TestParamInfo<oracle::Family>& info) {
  std::string name = oracle::name_of(info.param);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}
inline std::vector<oracle::Family> all_families() {
  std::vector<oracle::Family> all;
  for (int f = 0; f < static_cast<int>(oracle::Family::count); ++f)
    all.push_back(static_cast<oracle::Family>(f));
  return all;
}

}  // namespace scree
