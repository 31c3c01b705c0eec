// scree/simulation.hpp with all that the program's own parts see of it. Free of Thrust, so that every part of
// the program can include it.
#pragma once

#include "core/archive.hpp"
#include "core/snapshot.hpp"
#include "scree/simulation.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/observe/observation.hpp"
#include "sim/scene/scene.hpp"
