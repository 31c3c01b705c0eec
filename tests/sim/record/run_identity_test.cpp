#include "sim/record/run_identity.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

const RunIdentity of_checkpoint{
    .version = "1", .commit = "abc", .space = "host", .scene = "format: 1\ngravity: 0\n", .bodies = 7};

TEST(RunIdentity, EachPropertyThatMustBeTheSameIsNamed) {
  EXPECT_EQ(difference_of(of_checkpoint, of_checkpoint), "");
  RunIdentity other = of_checkpoint;
  other.commit = "def";
  EXPECT_EQ(difference_of(of_checkpoint, other), "") << "of this a run is warned";
  other = of_checkpoint;
  other.version = "2";
  EXPECT_EQ(difference_of(of_checkpoint, other), "the checkpoint is of version 1, and this is 2");
  other = of_checkpoint;
  other.scene = "format: 1\ngravity: 1\n";
  EXPECT_EQ(difference_of(of_checkpoint, other),
            "the checkpoint is of another scene: it has `gravity: 0`, this one `gravity: 1`");
  other = of_checkpoint;
  other.bodies = 8;
  EXPECT_EQ(difference_of(of_checkpoint, other),
            "the bodies differ from those of the checkpoint: a file they are read from has changed");
  other = of_checkpoint;
  other.space = "cuda";
  EXPECT_EQ(difference_of(of_checkpoint, other),
            "the checkpoint is of a run on host, and this is one on cuda (--device host)");
}

}  // namespace
}  // namespace scree
