// MatchFinder for the spaces of this build. For parallel sources alone.
#pragma once

#include "core/space_matches_device.hpp"
#include "core/space_matches_host.hpp"
