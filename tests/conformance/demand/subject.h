// SPDX-License-Identifier: MIT
// Scenes drawn again and again by turns, each with a renderer of its own: what one keeps from frame
// to frame another does not disturb.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "engine/render/renderer.h"
#include "game/options/shot_arguments.h"
#include "game/shot/picture_drawer.h"
#include "game/shot/shot.h"
#include "tests/conformance/demand/claim.h"
#include "tests/conformance/stability/shapes.h"

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::demand {

/// A scene and its shot.
struct Stage {
    game::ShotArguments arguments; ///< the size is the subjects'
    game::Shot shot;
};

/// Writes a generated scene into the options' folder and loads it as `shutter render` does.
/// \param arguments camera, time and shutter
[[nodiscard]] core::Result<std::unique_ptr<Stage>> loadStage(
    const DemandOptions& options,
    const std::string& name,
    const std::function<generator::GltfWriter()>& build,
    game::ShotArguments arguments
);

/// The same of a scene of assets/generator/scaling_scenes.h, with its own camera, time and shutter.
[[nodiscard]] core::Result<std::unique_ptr<Stage>> loadScalingStage(
    const DemandOptions& options,
    const std::string& name,
    const std::function<generator::GltfWriter()>& build
);

/// A scene made in code, with a physical shutter that ends at the raster instant.
[[nodiscard]] std::unique_ptr<Stage> makeStage(test::SceneBuilder scene, double exposureSeconds);

/// A stage drawn by one method.
class Subject {
  public:
    /// \param stage outlives this
    /// Error: the method needs rays and the device has none.
    [[nodiscard]] static core::Result<std::unique_ptr<Subject>> create(
        gpu::Device& device,
        const Stage& stage,
        std::string_view method,
        uint32_t width,
        uint32_t height
    );

    /// An effect of the caller's in the place of a method's.
    [[nodiscard]] static core::Result<std::unique_ptr<Subject>> createWithEffect(
        gpu::Device& device,
        const Stage& stage,
        std::unique_ptr<render::PostEffect> effect,
        uint32_t width,
        uint32_t height
    );

    /// The next picture: tone mapped, read back, with the intermediates asked for.
    [[nodiscard]] core::Result<render::FrameResult> draw();

    [[nodiscard]] const game::MethodInfo& method() const { return *mMethod.method; }

    /// Names as `--aov` takes them, of the pictures from now on.
    void setIntermediates(std::set<std::string> names) { mIntermediates = std::move(names); }

    void setDump(bool wanted) { mWantsDump = wanted; }

    /// By how much a picture's time is later than that of the one before; 0 at first.
    void setStep(double seconds) { mStepSeconds = seconds; }

  private:
    Subject(
        gpu::Device& device, const Stage& stage, game::ShotOptions shot, game::MethodOptions method
    );

    const Stage& mStage;
    game::ShotOptions mShot;
    game::MethodOptions mMethod;
    std::set<std::string> mIntermediates;
    bool mWantsDump = false;
    render::Renderer mRenderer;
    std::unique_ptr<render::PostEffect> mEffect; ///< in the place of a method's; null: none
    tonemap::Tonemap mTonemap;
    game::PictureDrawer mDrawer;
    double mSeconds = 0.0;
    double mStepSeconds = 0.0;
};

using Subjects = std::vector<std::unique_ptr<Subject>>;
using Frames = std::vector<render::FrameStatistics>;

/// Name in FrameStatistics::measures of what takeTurns() adds: milliseconds of processors that the
/// whole process took for the picture, a software device's threads among them. Other programs on
/// the machine change it far less than the time on the wall.
inline constexpr const char* kProcessMilliseconds = "process ms";

/// Draws all by turns, every other round backwards, so that a busy moment of the machine falls on
/// all alike. Each is drawn twice before, which does not count: shaders are compiled then, and
/// memory is taken. \return a list of `rounds` frames a subject
[[nodiscard]] core::Result<std::vector<Frames>>
takeTurns(const Subjects& subjects, uint32_t rounds);

} // namespace shutter::demand
