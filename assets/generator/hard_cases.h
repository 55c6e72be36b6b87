// SPDX-License-Identifier: MIT
// Twenty-four scenes, each made to be hard for motion blur in one way that the literature names.
#pragma once

#include "assets/generator/gltf_writer.h"

#include <glm/glm.hpp>

#include <span>
#include <string>

namespace shutter::generator {

/// Places and motions of the cases are laid out in pixels of this picture, exposure and time.
inline constexpr glm::vec2 kCaseSizePx{640.0f, 360.0f};
inline constexpr double kCaseExposureSeconds = 1.0 / 60.0;
/// Clips hold before time 0; until this time even eight times the exposure fits.
inline constexpr double kCaseSeconds = 0.2;

struct BenchCase {
    const char* name;        ///< of its file, without ".glb"; [a-z_]
    const char* title;       ///< for people
    std::string description; ///< one sentence: the difficulty, and the length of the motion
    GltfWriter (*build)();
    double timeSeconds = kCaseSeconds;
    double exposureSeconds = kCaseExposureSeconds;
    const char* phase = "end"; ///< as `shutter render --phase` takes it
    const char* camera = "main";
    glm::vec3 background; ///< linear RGB where nothing is hit
    /// Bounds of the longest motion of any pixel or particle over the exposure, at kCaseSizePx;
    /// [x, y].
    glm::vec2 peakMotionPx;
    bool movesParticles = false; ///< only particles move
};

/// In the order in which they are meant to be read.
[[nodiscard]] std::span<const BenchCase> listHardCases();

// The cases' scenes, by the objects that they move.
[[nodiscard]] GltfWriter buildTranslationCase();
[[nodiscard]] GltfWriter buildSpinCase();
[[nodiscard]] GltfWriter buildWheelSpokesCase();
[[nodiscard]] GltfWriter buildLongMotionCase();
[[nodiscard]] GltfWriter buildCameraPanCase();
[[nodiscard]] GltfWriter buildCameraDollyCase();
[[nodiscard]] GltfWriter buildCameraOrbitCase();
[[nodiscard]] GltfWriter buildCrossingCase();
[[nodiscard]] GltfWriter buildStaticPostCase();
[[nodiscard]] GltfWriter buildSelfOverlapCase();
[[nodiscard]] GltfWriter buildThinGeometryCase();
[[nodiscard]] GltfWriter buildSkyHorizonCase();
[[nodiscard]] GltfWriter buildWalkingFigureCase();
[[nodiscard]] GltfWriter buildRunningFigureCase();
[[nodiscard]] GltfWriter buildMorphCase();
[[nodiscard]] GltfWriter buildFlagCase();
[[nodiscard]] GltfWriter buildWhipCase();
[[nodiscard]] GltfWriter buildCollapseCase();
[[nodiscard]] GltfWriter buildSlidingPaneCase();
[[nodiscard]] GltfWriter buildBehindGlassCase();
[[nodiscard]] GltfWriter buildGlassCarriageCase();
[[nodiscard]] GltfWriter buildSparksCase();
[[nodiscard]] GltfWriter buildSmokeCase();
[[nodiscard]] GltfWriter buildAdditiveSparksCase();

} // namespace shutter::generator
