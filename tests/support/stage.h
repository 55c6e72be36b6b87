// SPDX-License-Identifier: MIT
// One call from a world to a picture, by any method.
#pragma once

#include "engine/gpu/device.h"
#include "engine/render/renderer.h"
#include "engine/scene/motion.h"
#include "modules/accumulate/accumulate.h"
#include "modules/motion_blur/settings.h"
#include "tests/support/scene_builder.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

namespace shutter::test {

enum class Method {
    Sharp,
    OwnVelocity,
    McGuire2012,
    Guertin2014,
    Jimenez2014,
    Gather,
    Hybrid,
    Accumulate,
    Truth
};

/// Those that share the raster image's half floats and may be held against it bit by bit.
inline constexpr Method kAllMethods[] = {
    Method::Sharp,
    Method::OwnVelocity,
    Method::McGuire2012,
    Method::Guertin2014,
    Method::Jimenez2014,
    Method::Gather,
    Method::Hybrid,
    Method::Accumulate};

/// Those of modules/motion_blur.
inline constexpr Method kBlurMethods[] = {
    Method::OwnVelocity,
    Method::McGuire2012,
    Method::Guertin2014,
    Method::Jimenez2014,
    Method::Gather,
    Method::Hybrid};

[[nodiscard]] const char* describe(Method method);

struct Shot {
    Method method = Method::Sharp;
    uint32_t width = 96;
    uint32_t height = 64;
    double seconds = 0.0;
    double exposureSeconds = 1.0;
    scene::ShutterPhase phase = scene::ShutterPhase::Centre;
    scene::CameraShutter shutter{}; ///< the rest of it; the two above count
    double frameSeconds = scene::kStillFrameSeconds;
    std::optional<double> instant{}; ///< Sharp: shutter time; none: the raster instant
    math::vec3 background{0.0f};
    math::vec3 ambient{0.0f};
    uint32_t instants = 16; ///< Accumulate: instants; Truth: rays a pixel
    uint32_t seed = 0;      ///< Truth only
    uint32_t batch = 0;     ///< Truth: rays a pixel of each frame; 0: all in one
    accumulate::PixelModel pixel = accumulate::PixelModel::Centre;
    motion_blur::MotionBlurSettings settings{}; ///< kBlurMethods; their method is set here
    std::set<std::string> aovs{};
    bool wantDisplay = false;
    /// Declared after the method's own effects; null: none.
    render::PostEffect* last = nullptr;
};

/// A world that was uploaded once, and is drawn as often as one likes. Entities may move between
/// shots; assets may not change.
class Stage {
  public:
    Stage(gpu::Device& device, const SceneBuilder& scene);

    /// Fails the test (and returns an empty result) where the engine reports an error.
    [[nodiscard]] render::FrameResult render(const Shot& shot);

  private:
    [[nodiscard]] render::FrameResult
    renderAccumulated(const Shot& shot, const render::FrameRequest& request);
    [[nodiscard]] render::FrameResult
    renderTruth(const Shot& shot, const render::FrameRequest& request);

    gpu::Device& mDevice;
    const SceneBuilder& mScene;
    render::Renderer mRenderer;
};

/// "ran: ..." or "skipped: ..." of the motion blur; "not asked" where the frame had none.
[[nodiscard]] std::string describeMotionBlur(const render::FrameResult& result);

/// For tests that need one picture of a scene.
[[nodiscard]] render::FrameResult
renderOnce(gpu::Device& device, const SceneBuilder& scene, const Shot& shot);

} // namespace shutter::test
