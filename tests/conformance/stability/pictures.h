// SPDX-License-Identifier: MIT
// Pictures of one scene by every method, and questions about their values.
#pragma once

#include "engine/image/image.h"
#include "engine/render/renderer.h"
#include "game/shot/picture_drawer.h"
#include "tests/conformance/stability/measured.h"
#include "tests/conformance/stability/shapes.h"

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::stability {

struct View {
    uint32_t width = 64;
    uint32_t height = 48;
    double seconds = 0.0;
    double exposureSeconds = 1.0;
    scene::ShutterPhase phase = scene::ShutterPhase::Centre;
    scene::ShutterMode mode = scene::ShutterMode::Physical;
    double frameSeconds = scene::kStillFrameSeconds;
    math::vec3 background{0.0f};
    math::vec3 ambient{0.0f};
    uint32_t samples = 0; ///< instants or rays of the truths; 0: four
};

/// Draws a scene as often as one likes; entities may move in between.
class Drawer {
  public:
    Drawer(
        gpu::Device& device,
        SceneBuilder scene,
        const motion_blur::MotionBlurSettings& settings = {}
    );

    /// With every intermediate of the method, unless told otherwise.
    [[nodiscard]] core::Result<render::FrameResult>
    draw(std::string_view method, const View& view, bool intermediates = true);

    [[nodiscard]] gpu::Device& device() { return mDevice; }

    [[nodiscard]] scene::World& world() { return mShot.world; }

  private:
    gpu::Device& mDevice;
    game::Shot mShot;
    motion_blur::MotionBlurSettings mSettings;
    render::Renderer mRenderer;
    game::PictureDrawer mDrawer;
};

/// Values and those among them that are NaN or infinite.
struct Census {
    uint64_t values = 0;
    uint64_t notFinite = 0;

    void add(const image::Image& picture);
    void add(const render::FrameResult& frame); ///< the picture and every intermediate
};

/// "no NaN or infinity": the row of a census.
[[nodiscard]] Measured describe(const Census& census, std::string check = "finite");

/// Least and greatest of each of three channels.
struct Range {
    double least[3] = {
        std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::infinity()};
    double greatest[3] = {
        -std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()};

    void add(const image::Image& picture);
};

/// One unit in the last place of the half float `value`.
[[nodiscard]] double halfUlp(double value);

/// The largest of many errors, and where it was.
struct Worst {
    double error = 0.0; ///< NaN counts as infinity
    uint64_t samples = 0;
    std::string note;

    void add(double value, std::string_view where = {});
};

[[nodiscard]] Measured
describe(const Worst& worst, std::string check, std::string unit, double bound);

/// How far `picture` leaves the range, in units in the last place of a half float.
void addExcursion(
    Worst& worst, const image::Image& picture, const Range& range, std::string_view where
);

/// Largest difference of the first three channels.
void addDifference(
    Worst& worst, const image::Image& a, const image::Image& b, std::string_view where
);

/// A hash of every value of the pictures and the intermediates.
[[nodiscard]] uint64_t hashFrame(const render::FrameResult& frame);

/// Every method in every phase: the rows "finite" and "inside the range of what was filtered".
[[nodiscard]] core::Result<Measurements> measureEveryMethod(Drawer& drawer, View view);

/// Rays at one instant against raster: the rows "rays see what raster draws", the share of pixels
/// that differ by more than two steps of 255, and "something is drawn".
[[nodiscard]] core::Result<Measurements> measureRays(Drawer& drawer, View view);

/// A hard case whose scene `build` makes: measureEveryMethod() and measureRays().
[[nodiscard]] HardCase makeSceneCase(
    std::string name,
    std::string title,
    std::string description,
    std::function<void(SceneBuilder&)> build,
    View view = {}
);

} // namespace shutter::stability
