// scree/simulation.hpp, together with the types that the program's own parts get from it. It is free of
// Thrust, so that every part of the program can include it.
#pragma once

#include "core/archive.hpp"
#include "core/snapshot.hpp"
#include "scree/simulation.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/observe/observation.hpp"
#include "sim/scene/scene.hpp"
