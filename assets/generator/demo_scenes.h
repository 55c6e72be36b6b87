// SPDX-License-Identifier: MIT
// The worlds of the gameplay demos (game/demos). A game finds what it plays with by the names of
// nodes, which assets/README.md lists; it moves them itself, so that nothing here has a velocity;
// waves move flags and grass, and a clip the gallery's runner.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/picture.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace shutter::generator {

[[nodiscard]] GltfWriter buildRallyScene();
[[nodiscard]] GltfWriter buildGalleryScene();
[[nodiscard]] GltfWriter buildSpinScene();

// Their small textures; all tile. Colours are sRGB-coded, [0, 1].
[[nodiscard]] Picture meadow();                                  ///< mown in stripes along v
[[nodiscard]] Picture roadway();                                 ///< once across, dashes along v
[[nodiscard]] Picture checkers(glm::vec3 a, glm::vec3 b);        ///< 2 x 2 fields a tile
[[nodiscard]] Picture stripes(glm::vec3 a, glm::vec3 b);         ///< 4 + 4 along u, a tile
[[nodiscard]] Picture arrows(glm::vec3 ground, glm::vec3 arrow); ///< 2 chevrons that point to +u
[[nodiscard]] Picture leaves(glm::vec3 color);                   ///< crowns of trees, tiles
[[nodiscard]] Picture rings(glm::vec3 rim, glm::vec3 fill); ///< of a round cap, a target's face

/// `sun`: the one light of a demo.
void addDemoSun(GltfWriter& writer, glm::vec3 direction);

/// A point of the closed centre line of the rally's course.
struct CoursePoint {
    glm::vec2 place{0.0f};     ///< x, z, metres
    glm::vec2 direction{0.0f}; ///< of driving, unit
    float curvature = 0.0f;    ///< 1/m, positive turns to the right
};

/// Places of the gates, in driving order.
[[nodiscard]] std::span<const glm::vec2> listCourseGates();

/// The Catmull-Rom curve through the gates. \param gate counted from 0, not rounded; wraps
[[nodiscard]] CoursePoint findCoursePoint(float gate);

/// Metres from the centre line, to half a metre.
[[nodiscard]] float measureCourseDistance(glm::vec2 place);

/// Objects in the landscape.
struct RallyLand {
    Shape fenceRails;
    Shape fencePosts;
    Shape gatePoles;
    Shape startBanner;
    Shape banners;
    Shape arrowBoards; ///< uv of one arrow a board
    Shape tyres;
    Shape seats; ///< of the grandstand
    Shape awning;
    std::vector<Shape> spectators{}; ///< one per colour
};

/// Meadow, road, hills, trees, fences and gates: one node `land`.
void addRallyLand(GltfWriter& writer, const RallyLand& land);
/// `ground`: the square of the fairground and its objects.
void addSquare(GltfWriter& writer);
/// `car` with body, wheels and a camera.
void addRallyCar(GltfWriter& writer);

} // namespace shutter::generator
