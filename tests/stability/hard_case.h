// SPDX-License-Identifier: MIT
// What hard cases share: their pictures by every method, figures that are held to bounds, and
// filters over G-buffers made in memory.
#pragma once

#include "assets/generator/mesh_shapes.h"
#include "modules/motion_blur/motion_blur.h"
#include "tests/kit/graph_rig.h"
#include "tests/kit/sweep.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::stability {

using test::Placement;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

/// The value; without one the test fails with the error's message.
template <class Value> [[nodiscard]] Value need(core::Result<Value> result) {
    if (!result)
        throw std::runtime_error(result.error().message);
    return std::move(result).value();
}

/// The largest of many errors, and where it was met.
struct Worst {
    double error = 0.0; ///< NaN counts as infinity
    uint64_t samples = 0;
    std::string note{};

    void add(double value, std::string_view where = {});
    /// 1 for each value that is NaN or infinite.
    void addNotFinite(const image::Image& picture, std::string_view where = {});
    /// Differences of the first three channels.
    void addDifference(const image::Image& a, const image::Image& b, std::string_view where = {});
};

/// Expects samples, none of them worse than the bound. --gtest_output=json:FILE writes the worst
/// with its bound.
void hold(
    const std::string& check, const Worst& worst, double bound = 0.0, const std::string& unit = ""
);

/// One unit in the last place of the half float `value`.
[[nodiscard]] double halfUlp(double value);

/// Least and greatest of each of three channels.
struct Range {
    double least[3];
    double greatest[3];

    Range();
    void add(const image::Image& picture);
    /// How far the picture leaves the range, in units in the last place of a half float.
    void addExcursion(Worst& worst, const image::Image& picture, std::string_view where) const;
};

/// Every method with its own number of samples, the truths with four; the size is 64x48.
[[nodiscard]] Shot makeShot();
/// ... before a background that is not black, in some light.
[[nodiscard]] Shot makeLitShot();

/// All that the device can run, `sharp` first.
[[nodiscard]] std::vector<std::string_view> listMethods(const gpu::Device& device);

/// By the method. \param hasIntermediates with all that it has
[[nodiscard]] render::FrameResult
draw(Stage& stage, Shot shot, std::string_view method, bool hasIntermediates = true);

/// Sees a picture. \param shot that it is of, with its phase
using Judge = std::function<
    void(std::string_view method, const Shot& shot, const render::FrameResult& frame)>;

/// In which phases of the shutter a method draws. SHUTTER_ALL=1: each in all three.
enum class Phases : uint8_t {
    InTurn, ///< one for each method, another one in a scene of another label
    OfShot, ///< the shot's own
};

/// Pictures of every method, and their intermediates, are finite and within the range of the
/// filtered picture. \param label for the report
void holdEveryMethod(
    gpu::Device& device,
    Stage& stage,
    const Shot& shot,
    const std::string& label = "",
    Phases phases = Phases::InTurn,
    const Judge& judge = {}
);

[[nodiscard]] scene::Primitive
makePrimitive(const generator::Shape& shape, scene::AssetIndex material);

/// Hard cases that every method draws: all of them in one process, with one set of pipelines.
class HardCases : public test::GpuTest {};

/// A textured wall that fills the picture (the first entity) and a lit sphere before it that moves.
/// \return the sphere
ecs::Entity addWallAndSphere(SceneBuilder& scene);

/// A camera at the origin with -Z forward, perspective, 0.9 rad high.
[[nodiscard]] SceneBuilder makeEmptyScene();

/// Every pass has something to do: movers before each other, holes, light, a camera that turns.
[[nodiscard]] SceneBuilder makeBusyScene();

/// A hash of every value of the pictures and the intermediates.
[[nodiscard]] uint64_t hashFrame(const render::FrameResult& frame);

/// A synthetic G-buffer; all of one size.
struct GBuffer {
    image::Image color;       ///< RGBA
    image::Image motionDepth; ///< motion in pixels, depth in metres, unused

    GBuffer(uint32_t width, uint32_t height)
        : color(width, height, 4), motionDepth(width, height, 4) {}

    /// Rounds to half floats, as the image that is filtered holds them.
    void setColor(uint32_t x, uint32_t y, float r, float g, float b) {
        const float values[] = {r, g, b};
        for (uint32_t c = 0; c < 3; ++c)
            color.at(x, y, c) = image::roundToHalf(values[c]);
        color.at(x, y, 3) = 1.0f;
    }

    void setMotion(uint32_t x, uint32_t y, float right, float down, float depth) {
        const float values[] = {right, down, depth};
        std::copy(values, values + 3, &motionDepth.at(x, y, 0));
    }
};

/// What a filter of one layer made of it.
struct Blurred {
    image::Image color;
    image::Image tiles;    ///< empty where the method has none
    image::Image dominant; ///< likewise
};

/// Filters G-buffers with one set of pipelines.
class FilterRig {
  public:
    explicit FilterRig(gpu::Device& device) : mDevice(device), mEffect(device, VK_NULL_HANDLE) {}

    Blurred blur(
        const GBuffer& gbuffer,
        const motion_blur::MotionBlurSettings& settings,
        double rasterTime = 0.5
    ) {
        test::GraphRig rig(mDevice);
        motion_blur::MotionBlurInputs inputs;
        inputs.color = rig.uploadColor(gbuffer.color);
        inputs.motionDepth = rig.upload(gbuffer.motionDepth);
        inputs.rasterTime = rasterTime;
        const motion_blur::MotionBlurOutputs outputs = mEffect.add(rig.graph, inputs, settings);
        const bool hasTiles = outputs.view("tile_max").isValid();
        const size_t color = rig.want(outputs.color);
        const size_t tiles = hasTiles ? rig.want(outputs.view("tile_max")) : 0;
        const size_t dominant = hasTiles ? rig.want(outputs.view("tiles")) : 0;
        (void)need(rig.run());
        if (!hasTiles)
            return {rig.take(color), {}, {}};
        return {rig.take(color), rig.take(tiles), rig.take(dominant)};
    }

  private:
    gpu::Device& mDevice;
    motion_blur::MotionBlur mEffect;
};

} // namespace shutter::stability
