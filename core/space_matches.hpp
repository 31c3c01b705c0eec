// MatchFinder for the spaces of this build. For parallel libraries alone.
#pragma once

#include "core/space_matches_device.hpp"
#include "core/space_matches_host.hpp"
