// The errors that scree throws. They belong to the public interface; the sources inside include them from
// here.
#pragma once

#include "scree/error.hpp"
