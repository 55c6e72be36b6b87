// SPDX-License-Identifier: MIT
// Components that tests of the registry give to entities.
#pragma once

namespace shutter::ecs {

struct Position {
    double x = 0.0;
};

struct Health {
    int points = 100;
};

} // namespace shutter::ecs
