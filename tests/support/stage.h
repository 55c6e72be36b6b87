// SPDX-License-Identifier: MIT
// One call from a world to a picture, by any method.
#pragma once

#include "engine/gpu/device.h"
#include "engine/render/renderer.h"
#include "engine/scene/motion.h"
#include "game/shot/picture_drawer.h"
#include "modules/accumulate/accumulate.h"
#include "modules/motion_blur/methods.h"
#include "modules/tonemap/tonemap.h"
#include "tests/kit/scene_builder.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::test {

/// Names of the motion blur's methods that blur moving objects and that the device can run.
[[nodiscard]] std::vector<std::string_view> listBlurMethods(const gpu::Device& device);

/// Names of the methods that share the raster image's half floats and may be held against it bit by
/// bit: sharp, accumulate and the motion blur's that read the raster image.
[[nodiscard]] std::vector<std::string_view> listRasterMethods(const gpu::Device& device);

struct Shot {
    std::string_view method = "sharp"; ///< "accumulate", "truth" or one of the motion blur's
    uint32_t width = 96;
    uint32_t height = 64;
    double seconds = 0.0;
    double exposureSeconds = 1.0;
    scene::ShutterPhase phase = scene::ShutterPhase::Centre;
    scene::CameraShutter shutter{}; ///< the rest of it; the two above count
    double frameSeconds = scene::kStillFrameSeconds;
    std::optional<double> instant{}; ///< sharp: shutter time; none: the raster instant
    math::vec3 background{0.0f};
    math::vec3 ambient{0.0f};
    shadows::ShadowSettings shadows{};
    uint32_t instants = 16;            ///< accumulate: instants; truth: rays per pixel
    std::optional<double> maxStepPx{}; ///< accumulate: so many instants that none is farther apart
    uint32_t seed = 0;                 ///< truth only
    uint32_t batch = 0;                ///< truth: rays per pixel of each frame; 0: all in one
    accumulate::PixelModel pixel = accumulate::PixelModel::Centre;
    /// Of the motion blur; its method is set here. As many samples for each, so that methods
    /// compare.
    motion_blur::MotionBlurSettings settings{.sampleCount = 15};
    std::set<std::string> aovs{};
    bool wantDisplay = false;
    /// Declared after the method's own effects and the tone map; null: none.
    render::Effect* last = nullptr;
};

/// A world that is uploaded once and drawn, by game::PictureDrawer, as often as one likes. Entities
/// may move between shots; assets may not change.
class Stage {
  public:
    Stage(gpu::Device& device, const SceneBuilder& scene);

    /// Fails the test, and returns an empty result, if the device cannot run the method or drawing
    /// reports an error.
    [[nodiscard]] render::FrameResult render(const Shot& shot);

  private:
    gpu::Device& mDevice;
    const SceneBuilder& mScene;
    render::Renderer mRenderer;
};

/// Frames drawn in sequence, as in a game: effects keep their history from frame to frame, and no
/// history is drawn again.
class Frames {
  public:
    /// \param scene outlives this
    Frames(
        gpu::Device& device, const SceneBuilder& scene, const motion_blur::BlurBudget& budget = {}
    );

    /// With reasons and the graph's dump. Fails the test, and returns an empty result, on an error.
    /// \param change applied to the request to the drawer
    [[nodiscard]] render::FrameResult
    draw(const Shot& shot, const std::function<void(game::PictureRequest&)>& change = {});

  private:
    gpu::Device& mDevice;
    const SceneBuilder& mScene;
    motion_blur::BlurBudget mBudget;
    render::Renderer mRenderer;
    std::optional<tonemap::Tonemap> mTonemap; ///< since Shot::wantDisplay
    game::PictureDrawer mDrawer;
};

/// Expects time-sampled rays, and sharp frames at many times, to see the same to 45 dB, and the
/// sharp picture to be no nearer to that than `mostSharp` dB: something moves in it.
void expectTruthsAgree(Stage& stage, Shot shot, double mostSharp = 40.0);

/// How many of the frame's passes have `part` in their names.
[[nodiscard]] size_t countPasses(const render::FrameResult& frame, std::string_view part);

/// Whether a pass of the frame has this name.
[[nodiscard]] bool hasPass(const render::FrameResult& frame, std::string_view name);

/// "ran: ..." or "skipped: ..." of the motion blur; "not requested" where the frame had none.
[[nodiscard]] std::string describeMotionBlur(const render::FrameResult& result);

/// For tests that need one picture of a scene.
[[nodiscard]] render::FrameResult
renderOnce(gpu::Device& device, const SceneBuilder& scene, const Shot& shot);

} // namespace shutter::test
