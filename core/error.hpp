// The errors belong to the interface; inside they go by this name.
#pragma once

#include "scree/error.hpp"
