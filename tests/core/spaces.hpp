// Typed tests over spaces: one text, which runs for each space of the build.
#pragma once

#include "core/space.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace scree::test {

using Spaces = ::testing::Types<SCREE_SPACES>;

/// Names the space in the name of the test: ParallelTest/host.
struct SpaceName {
  template <class Space>
  static std::string GetName(int) {
    return Space::name;
  }
};

/// A test fixture that skips with a reason where the space is built but the machine cannot run it.
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
