// SPDX-License-Identifier: MIT
// The pictures on our surfaces. All tile. Their features are bold on purpose: where a blur method
// guesses the background wrong, the pattern must give it away.
#pragma once

#include "assets/generator/picture.h"

#include <glm/glm.hpp>

namespace shutter::generator {

// Any scene; colours are sRGB-coded, [0, 1].
[[nodiscard]] Picture wood(glm::vec3 dark, glm::vec3 light); ///< grain along u
[[nodiscard]] Picture planks();                              ///< floor boards along u
[[nodiscard]] Picture stone(glm::vec3 color);

// The room.
[[nodiscard]] Picture wovenCheck();  ///< 4 checks a tile
[[nodiscard]] Picture pinkLattice(); ///< 8 x 8 diamonds with dots
[[nodiscard]] Picture blueHerringbone();
[[nodiscard]] Picture wallpaper(); ///< 2 x 2 ogees a tile
[[nodiscard]] Picture redGlaze();  ///< once around the vase
[[nodiscard]] Picture rug();
[[nodiscard]] Picture landscape(); ///< for a frame, does not tile

// The courtyard.
[[nodiscard]] Picture bricks();      ///< 4 x 8 bricks a tile
[[nodiscard]] Picture paving();      ///< 4 x 4 slabs a tile
[[nodiscard]] Picture crateBoards(); ///< one crate side
[[nodiscard]] Picture chevrons();    ///< 2 x 2 a tile
[[nodiscard]] Picture beachBall();
[[nodiscard]] Picture polePaint();   ///< 2 red bands a tile
[[nodiscard]] Picture rimPaint();    ///< once around a rim: four pale marks on red
[[nodiscard]] Picture toyBlock();    ///< one side
[[nodiscard]] Picture windowPanes(); ///< one window

} // namespace shutter::generator
