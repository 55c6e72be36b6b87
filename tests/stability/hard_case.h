// SPDX-License-Identifier: MIT
// What hard cases share: their pictures by every method, and figures that are held to bounds.
#pragma once

#include "assets/generator/mesh_shapes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cstdint>
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

/// Pictures of every method in every phase, and their intermediates, are finite and within the
/// range of the filtered picture. \param label for the report
void holdEveryMethod(
    gpu::Device& device, Stage& stage, const Shot& shot, const std::string& label = ""
);

[[nodiscard]] scene::Primitive
makePrimitive(const generator::Shape& shape, scene::AssetIndex material);

/// A textured wall that fills the picture (the first entity) and a lit sphere before it that moves.
/// \return the sphere
ecs::Entity addWallAndSphere(SceneBuilder& scene);

/// A camera at the origin with -Z forward, perspective, 0.9 rad high.
[[nodiscard]] SceneBuilder makeEmptyScene();

/// Every pass has something to do: movers before each other, holes, light, a camera that turns.
[[nodiscard]] SceneBuilder makeBusyScene();

/// A hash of every value of the pictures and the intermediates.
[[nodiscard]] uint64_t hashFrame(const render::FrameResult& frame);

} // namespace shutter::stability
