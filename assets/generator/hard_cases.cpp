// SPDX-License-Identifier: MIT
#include "assets/generator/hard_cases.h"

#include <fmt/format.h>

#include <vector>

namespace shutter::generator {

namespace {

constexpr glm::vec3 kRoomBackground{0.18f, 0.18f, 0.18f}; // the room fills the picture
constexpr glm::vec3 kYardSky{0.42f, 0.58f, 0.80f};
constexpr glm::vec3 kOpenSky{0.30f, 0.52f, 0.90f};

BenchCase makeCase(
    const char* name,
    const char* title,
    const char* hard,
    GltfWriter (*build)(),
    glm::vec3 background,
    glm::vec2 peakMotionPx
) {
    return {
        .name = name,
        .title = title,
        .description = fmt::format(
            "{}; the longest motion is {} to {} px at {}x{}.",
            hard,
            peakMotionPx.x,
            peakMotionPx.y,
            kCaseSizePx.x,
            kCaseSizePx.y
        ),
        .build = build,
        .background = background,
        .peakMotionPx = peakMotionPx};
}

BenchCase withParticlesAlone(BenchCase one) {
    one.movesParticles = true;
    return one;
}

std::vector<BenchCase> makeCases() {
    return {
        makeCase(
            "translation",
            "Translation",
            "A toy glider crosses a papered wall, a cushion and a sofa at once, so that each side "
            "of its silhouette hides another pattern",
            &buildTranslationCase,
            kRoomBackground,
            {23.0f, 30.0f}
        ),
        makeCase(
            "spin",
            "Spin",
            "A pinwheel turns by 22 degrees before bricks, so that motion changes its direction "
            "and length within a tile and paths are arcs",
            &buildSpinCase,
            kYardSky,
            {33.0f, 40.0f}
        ),
        makeCase(
            "wheel_spokes",
            "Wheel with spokes, rolling",
            "An old bicycle rolls past: spokes turn further than the gap between them, the rim "
            "is static at the ground and moves at twice the speed at its top",
            &buildWheelSpokesCase,
            kYardSky,
            {32.0f, 38.0f}
        ),
        makeCase(
            "camera_pan",
            "Camera pan",
            "The camera turns in a still yard: every pixel moves, none is revealed by another, and "
            "the picture's border brings in what no layer holds",
            &buildCameraPanCase,
            kYardSky,
            {28.0f, 34.0f}
        ),
        makeCase(
            "camera_dolly",
            "Camera dolly",
            "The camera runs forward: motion points away from one place, is zero there and grows "
            "towards the border, most for near objects",
            &buildCameraDollyCase,
            kYardSky,
            {29.0f, 37.0f}
        ),
        makeCase(
            "camera_orbit",
            "Camera orbit",
            "The camera circles a statue that stays nearly still while what is before and behind "
            "it moves in opposite directions",
            &buildCameraOrbitCase,
            kYardSky,
            {30.0f, 38.0f}
        ),
        makeCase(
            "crossing_same_colour",
            "Crossing, same colour",
            "Two jugs of one colour cross in opposite directions, one before the other, so that "
            "colour cannot separate them and one tile holds both motions",
            &buildCrossingCase,
            kRoomBackground,
            {25.0f, 31.0f}
        ),
        makeCase(
            "static_post",
            "Static post before a mover",
            "A loaded sledge runs behind thin posts that are static and must stay sharp, though "
            "what moves behind them is uncovered all the time",
            &buildStaticPostCase,
            kYardSky,
            {31.0f, 38.0f}
        ),
        makeCase(
            "self_overlap",
            "Self-overlap",
            "A coil with a ring flies and turns before the room: through its gaps it hides and "
            "reveals parts of itself, which object ids cannot separate",
            &buildSelfOverlapCase,
            kRoomBackground,
            {30.0f, 39.0f}
        ),
        makeCase(
            "long_motion",
            "Motion longer than a tile",
            "A glider flies by at three tiles of 40 px in an exposure, beyond the reach of a "
            "filter "
            "that clamps motion to one tile",
            &buildLongMotionCase,
            kYardSky,
            {115.0f, 145.0f}
        ),
        makeCase(
            "thin_geometry",
            "Thin geometry",
            "A wire gate slides, blades of grass sway and a ball flies behind still wires: much of "
            "it is about a pixel wide or less, so that depth and motion alias",
            &buildThinGeometryCase,
            kYardSky,
            {16.0f, 26.0f}
        ),
        makeCase(
            "sky_horizon",
            "Sky and horizon",
            "A balloon and a glider move before open sky, which has no depth, and before the "
            "horizon, while the camera turns a little",
            &buildSkyHorizonCase,
            kOpenSky,
            {22.0f, 34.0f}
        ),
        makeCase(
            "walking_figure",
            "Walking figure",
            "A person walks past: limbs swing against the body and bend, so that nothing of it "
            "moves as a rigid body does",
            &buildWalkingFigureCase,
            kYardSky,
            {9.0f, 14.0f}
        ),
        makeCase(
            "running_figure_pan",
            "Running figure, camera pans along",
            "A person runs and the camera turns with it: the yard streaks by behind limbs that "
            "swing both ways",
            &buildRunningFigureCase,
            kYardSky,
            {18.0f, 26.0f}
        ),
        makeCase(
            "morphing_ball",
            "Morphing ball",
            "A ball grows spikes by morph targets while it stays in its place: every pixel of its "
            "silhouette moves outwards in another direction",
            &buildMorphCase,
            kYardSky,
            {48.0f, 80.0f}
        ),
        makeCase(
            "waving_flag",
            "Waving flag",
            "A flag in a storm: folds run through it, hide one another and change within a tile",
            &buildFlagCase,
            kYardSky,
            {15.0f, 26.0f}
        ),
        makeCase(
            "whip",
            "Whip",
            "A chain of joints curls over so fast that its tip turns by 120 degrees in an exposure",
            &buildWhipCase,
            kYardSky,
            {230.0f, 270.0f}
        ),
        makeCase(
            "collapsing_limb",
            "Collapsing limb",
            "An arm of a walking person is scaled to nothing within the exposure, as games hide "
            "limbs: at shutter close no surface of it is left",
            &buildCollapseCase,
            kYardSky,
            {7.0f, 13.0f}
        ),
        makeCase(
            "sliding_pane",
            "Sliding pane",
            "A pane of tinted glass under a rail slides past and turns by 20 degrees: no raster "
            "image holds both it and the wall that is seen through it",
            &buildSlidingPaneCase,
            kYardSky,
            {60.0f, 110.0f}
        ),
        makeCase(
            "mover_behind_glass",
            "Mover behind glass",
            "A crate slides behind two still, tinted panes and before a third: the panes must stay "
            "as they are",
            &buildBehindGlassCase,
            kYardSky,
            {25.0f, 35.0f}
        ),
        makeCase(
            "glass_carriage",
            "Glass carriage",
            "A frame, its glass and the ball inside ride past together: what is behind the glass "
            "changes with it",
            &buildGlassCarriageCase,
            kYardSky,
            {30.0f, 42.0f}
        ),
        withParticlesAlone(makeCase(
            "sparks",
            "Sparks",
            "A grinder throws sparks that cover the background: they have no motion vectors, "
            "and an exposure sees each of them elsewhere",
            &buildSparksCase,
            kYardSky,
            {26.0f, 36.0f}
        )),
        withParticlesAlone(makeCase(
            "smoke",
            "Smoke",
            "Turning puffs drift by over one another and fade before the wall, so that no pixel "
            "has one motion",
            &buildSmokeCase,
            kYardSky,
            {15.0f, 26.0f}
        )),
        withParticlesAlone(makeCase(
            "additive_sparks",
            "Additive sparks",
            "Three hundred sparks of up to twelve times white, born and dying in the exposure: "
            "each is seen for its share of it, and their light adds up",
            &buildAdditiveSparksCase,
            kYardSky,
            {28.0f, 42.0f}
        )),
    };
}

} // namespace

std::span<const BenchCase> listHardCases() {
    static const std::vector<BenchCase> kCases = makeCases();
    return kCases;
}

} // namespace shutter::generator
