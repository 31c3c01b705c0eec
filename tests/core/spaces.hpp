// Tests over spaces: one text, run for each space that the build has.
#pragma once

#include "core/space.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace scree::test {

using Spaces = ::testing::Types<SCREE_SPACES>;

/// Names the space in the test's name: ParallelTest/host.
struct SpaceName {
  template <class Space>
  static std::string GetName(int) {
    return Space::name;
  }
};

/// Skips, saying why, where the space is built but the machine has nothing to run it on.
template <class Space>
class InSpace : public ::testing::Test {
 protected:
  void SetUp() override {
    if constexpr (!std::is_same_v<Space, Host>) {
      const DeviceInfo info = device_info();
      if (!info.available) GTEST_SKIP() << "no GPU: " << info.name;
    }
  }
};

}  // namespace scree::test
