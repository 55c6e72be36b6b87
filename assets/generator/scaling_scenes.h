// SPDX-License-Identifier: MIT
// Scenes with one parameter each, for curves of cost. In all of them only that parameter changes:
// camera `main` is static, no clip plays but the crowd's, movers have velocities and are at their
// place at time 0; exposure 1/60 s, phase `end`. Resolution and exposure need no separate scene:
// the vase scene is the base of those curves.
#pragma once

#include "assets/generator/gltf_writer.h"

namespace shutter::generator {

inline constexpr double kScalingSeconds = 0.0;
inline constexpr double kScalingExposureSeconds = 1.0 / 60.0;
inline constexpr const char* kScalingPhase = "end"; ///< as `shutter render --phase` takes it
inline constexpr const char* kScalingCamera = "main";

inline constexpr int kMaxEntityCount = 10'000;
inline constexpr int kMinTriangleCount = 1'000;
inline constexpr int kMaxTriangleCount = 1'000'000;

/// `count` boxes, all moving, that share one mesh and one material, in a grid before a wall. They
/// get smaller as they get more: together they always hide the same share of the picture, and move
/// by the same 12 to 20 px at 1280x720. \param count clamped to [1, kMaxEntityCount]
[[nodiscard]] GltfWriter buildEntitiesScene(int count);

/// A grid of `count` boxes that share one mesh, of which `movers`, spread over it, move by 12 to 20
/// px at 1280x720; the others are static. `merged`: those are one mesh of one entity; the picture
/// is the same. No wall. \param count clamped to [1, kMaxEntityCount]; movers to [0, count]
[[nodiscard]] GltfWriter buildFewMoversScene(int count, int movers, bool merged);

inline constexpr int kMaxBodyCount = 200;

/// `count` persons of two skinned meshes walk before a wall, each in another phase of its stride,
/// by 6 to 10 px at 1280x720. The more they are, the farther away the picture shows them: together
/// they hide about the same share of it. \param walk false: all are static \param count clamped to
/// [0, kMaxBodyCount]
[[nodiscard]] GltfWriter buildCrowdScene(int count, bool walk);
[[nodiscard]] GltfWriter buildCrowdScene(int count);

/// One mover and a relief behind it, each half of `count` triangles, within 2 %. The shapes stay,
/// their detail changes. \param count clamped to [kMinTriangleCount, kMaxTriangleCount]
[[nodiscard]] GltfWriter buildTrianglesScene(int count);

/// Panels that move by 24 px at 1280x720 cover `share` of a 16:9 picture before a still wall; the
/// number of panels stays, their width changes; at 0 there are none.
/// \param share clamped to [0, 1]; NaN counts as 0
[[nodiscard]] GltfWriter buildMovingShareScene(float share);

inline constexpr int kPanelColumns = 16;
inline constexpr int kPanelRows = 9;

/// kPanelColumns x kPanelRows panels before a wall, each in a cell of 80 x 80 px at 1280x720. Those
/// in the lower left `columns` x `rows` cells move by 8 px, each row against the next; the others
/// are static. Whatever the region, the picture and the meshes are the same, and the work in a
/// region grows with its area: movers, background and silhouettes are in every cell.
/// \param columns, rows clamped to [0, kPanelColumns] and [0, kPanelRows]; where one is 0 nothing
/// moves
[[nodiscard]] GltfWriter buildMovingRegionScene(int columns, int rows);

} // namespace shutter::generator
