// SPDX-License-Identifier: MIT
// Valid and invalid history of `resolved`: pictures drawn in sequence by one renderer, with events
// in between. A frame gets the same history whether the previous frame stored it or it is drawn
// again.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

constexpr double kFramesPerSecond = 48.0;
constexpr double kExposureSeconds = 0.5 / kFramesPerSecond;

/// A textured wall and a red box that crosses the picture's upper half in front of it.
struct Scene {
    test::SceneBuilder builder;
    ecs::Entity box;

    /// \param isGrey the wall is of one grey
    explicit Scene(bool isGrey = false) {
        builder.setPerspective(0.9);
        builder.add(
            test::makeQuad(8, 6, isGrey ? builder.addColor(math::vec3(0.3f)) : builder.addWaves()),
            {.position = {0, 0, -5}}
        );
        box = builder.add(
            test::makeBox({0.6, 0.6, 0.5}, builder.addColor({1.0f, 0.0f, 0.0f})),
            {.position = {-0.3, 0.6, -3}, .velocity = {24.0, 0.0, 0.0}}
        );
    }

    [[nodiscard]] scene::World& world() { return builder.world; }
};

struct FrameOptions {
    std::string_view method = "resolved";
    bool history = true;
    uint32_t width = 192;
    uint32_t height = 128;
    ecs::Entity camera; ///< null: the scene's
    double exposureSeconds = kExposureSeconds;
};

/// Draws frames of a scene in any order, as an application does.
class HistoryFrames : public test::Frames {
  public:
    HistoryFrames(gpu::Device& device, const Scene& scene) : Frames(device, scene.builder) {}

    render::FrameResult at(int frame, const FrameOptions& options = {}) {
        test::Shot shot{
            .method = options.method,
            .width = options.width,
            .height = options.height,
            .seconds = frame / kFramesPerSecond,
            .exposureSeconds = options.exposureSeconds,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 1.0 / kFramesPerSecond};
        shot.settings.history = options.history;
        return draw(shot, [&](game::PictureRequest& request) {
            if (options.camera != ecs::Entity{})
                request.frame.view.camera = options.camera;
        });
    }
};

/// 0 where nothing moves.
uint64_t countFromLast(const render::FrameResult& frame) {
    const auto& counters = frame.statistics.counters;
    const auto found = counters.find("samples from the last frame");
    return found == counters.end() ? 0 : found->second;
}

/// The raster of the previous frame was drawn once more.
bool drawsLast(const render::FrameResult& frame) {
    return test::hasPass(frame, "last G-buffer");
}

class ResolvedHistory : public test::GpuTest {
  protected:
    /// The frame as it is after one that kept its raster.
    render::FrameResult drawFollowing(Scene& scene, FrameOptions options = {}, int frame = 0) {
        HistoryFrames frames(device(), scene);
        (void)frames.at(frame - 1, options);
        auto drawn = frames.at(frame, options);
        EXPECT_FALSE(drawsLast(drawn));
        EXPECT_GT(countFromLast(drawn), 0u);
        return drawn;
    }

    /// The frame as it is drawn without the one before.
    render::FrameResult drawAlone(Scene& scene, FrameOptions options = {}, int frame = 0) {
        options.history = false;
        return HistoryFrames(device(), scene).at(frame, options);
    }
};

TEST_F(ResolvedHistory, ThePreviousFrameIsLookedUp) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    const auto drawn = frames.at(0);
    EXPECT_GT(countFromLast(drawn), 0u);
    EXPECT_FALSE(test::sameBits(drawn.color, drawAlone(scene).color));
}

TEST_F(ResolvedHistory, FramesBeforeACutAreNotLookedUp) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    // The frame of the cut is sharp; the one after it moves, and must not see past the cut.
    scene::cut(scene.world(), scene.builder.camera, -0.75 / kFramesPerSecond);
    const auto ofCut = frames.at(0);
    EXPECT_EQ(countFromLast(ofCut), 0u);
    EXPECT_TRUE(test::sameBits(ofCut.color, drawAlone(scene).color));
    EXPECT_TRUE(test::sameBits(frames.at(1).color, HistoryFrames(device(), scene).at(1).color));
}

TEST_F(ResolvedHistory, FramesOfAnotherCameraAreNotLookedUp) {
    Scene scene;
    const ecs::Entity other = scene.world().registry.create();
    scene.world().registry.add(other, scene::LocalTransform{{.translation = {0.3, 0, 0.5}}});
    scene.world().registry.add(other, scene.builder.cameraSettings());
    scene.world().cameras.push_back(other);
    HistoryFrames frames(device(), scene);
    for (int frame = -2; frame < 0; ++frame) {
        (void)frames.at(frame);
        (void)frames.at(frame, {.camera = other});
    }
    EXPECT_TRUE(test::sameBits(frames.at(0).color, drawFollowing(scene).color));
    EXPECT_TRUE(test::sameBits(
        frames.at(0, {.camera = other}).color, drawFollowing(scene, {.camera = other}).color
    ));
}

TEST_F(ResolvedHistory, AFrameAfterAnotherMethodFindsTheSameHistory) {
    const FrameOptions small = {.width = 96, .height = 64};

    struct Before {
        std::string what;
        int frame;
        FrameOptions options;
        FrameOptions own;
    };

    const std::vector<Before> cases = {
        {"after another size", -1, {}, small},
        {"after a gap", -3, {}, {}},
        {"after another method", -1, {.method = "gather"}, {}},
        {"after a sharp frame", -1, {.exposureSeconds = 0.0}, {}},
        {"after one without history", -1, {.history = false}, {}}};
    for (const auto& [what, before, options, own] : cases) {
        Scene scene;
        HistoryFrames frames(device(), scene);
        (void)frames.at(before, options);
        const auto drawn = frames.at(0, own);
        EXPECT_TRUE(drawsLast(drawn)) << what;
        EXPECT_TRUE(test::sameBits(drawn.color, drawFollowing(scene, own).color)) << what;
        EXPECT_FALSE(drawsLast(frames.at(1, own))) << what << ": this one kept its own";
    }
    Scene scene;
    const auto first = HistoryFrames(device(), scene).at(0);
    EXPECT_TRUE(drawsLast(first));
    EXPECT_TRUE(test::sameBits(first.color, drawFollowing(scene).color)) << "the first frame";
}

TEST_F(ResolvedHistory, AFrameFromWhichOnTheLensSpreadsFindsTheSameHistory) {
    // The wall is static in the raster of the frame before, whose lens left all in focus.
    Scene scene;
    scene.world().registry.add(
        scene.builder.camera,
        scene::FocusMotion{
            {{-0.6 / kFramesPerSecond, 5.0, 1e6}, {-0.55 / kFramesPerSecond, 5.0, 0.02}}}
    );
    HistoryFrames frames(device(), scene);
    EXPECT_FALSE(test::hasPass(frames.at(-1), "filter lens"));
    const auto following = frames.at(0);
    EXPECT_TRUE(test::hasPass(following, "filter lens"));
    EXPECT_GT(countFromLast(following), 0u);
    const auto alone = HistoryFrames(device(), scene).at(0);
    EXPECT_TRUE(drawsLast(alone));
    EXPECT_TRUE(test::sameBits(alone.color, following.color));
}

TEST_F(ResolvedHistory, AFrameThatIsDrawnAgainFindsTheSameAgain) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    const auto first = frames.at(0);
    EXPECT_GT(countFromLast(first), 0u);
    // As while time is paused: nothing is drawn for it, however long.
    for (int i = 0; i < 3; ++i) {
        const auto again = frames.at(0);
        EXPECT_FALSE(drawsLast(again)) << i;
        EXPECT_TRUE(test::sameBits(again.color, first.color)) << i;
    }
    const auto resumed = frames.at(1);
    EXPECT_FALSE(drawsLast(resumed));
    EXPECT_TRUE(test::sameBits(resumed.color, drawFollowing(scene, {}, 1).color));
}

TEST_F(ResolvedHistory, NoHistoryIsDrawnIfNoneIsLookedUp) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    EXPECT_FALSE(drawsLast(frames.at(0, {.exposureSeconds = 0.0})));
    EXPECT_FALSE(drawsLast(frames.at(1, {.method = "gather"})));
    EXPECT_FALSE(drawsLast(frames.at(2, {.history = false})));
    scene::cut(scene.world(), scene.builder.camera, 2.5 / kFramesPerSecond);
    EXPECT_FALSE(drawsLast(frames.at(3))) << "nothing moves in the frame of a cut";
    const auto afterCut = frames.at(4);
    EXPECT_TRUE(drawsLast(afterCut)) << "the frame of the cut is history of the one after it";
    EXPECT_GT(countFromLast(afterCut), 0u);
    scene.world().registry.remove<scene::LinearVelocity>(scene.box);
    const auto still = frames.at(5);
    EXPECT_FALSE(drawsLast(still));
    EXPECT_FALSE(test::hasPass(still, "pack surface") || test::hasPass(still, "keep colour"));
}

TEST_F(ResolvedHistory, TheFirstFrameThatMovesIsAsNearToTheTruthAsTheNext) {
    Scene scene;
    // It is static until the shutter opens for frame 0.
    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    path.keys.resize(3);
    for (const auto& [key, seconds, x] :
         {std::tuple{0, -1.0, -0.3}, {1, -kExposureSeconds, -0.3}, {2, 1.0, 24.0}}) {
        path.keys[key].seconds = seconds;
        path.keys[key].position = {x, 0.6, -3};
    }
    scene.world().registry.remove<scene::LinearVelocity>(scene.box);
    scene.world().registry.add(scene.box, path);
    HistoryFrames frames(device(), scene);
    for (int frame = -3; frame < 0; ++frame)
        EXPECT_FALSE(test::hasPass(frames.at(frame), "resolve")) << frame;
    const auto drawn = frames.at(0);
    test::Shot truth{
        .method = "accumulate",
        .width = 192,
        .height = 128,
        .exposureSeconds = kExposureSeconds,
        .phase = scene::ShutterPhase::End,
        .frameSeconds = 1.0 / kFramesPerSecond,
        .instants = 15};
    const auto expected = test::renderOnce(device(), scene.builder, truth);
    EXPECT_GT(countFromLast(drawn), 0u);
    EXPECT_GT(
        image::computePsnr(drawn.color, expected.color),
        image::computePsnr(drawAlone(scene).color, expected.color) + 3.0
    );
}

TEST_F(ResolvedHistory, UnusedHistoryIsFreedAfterAWhile) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(0, {.method = "gather"});
    (void)frames.at(1, {.method = "gather"});
    device().collect();
    const uint32_t without = device().living().images;
    (void)frames.at(2);
    (void)frames.at(3);
    for (uint32_t i = 0; i <= render::kFramesKept; ++i)
        (void)frames.at(int(i % 2), {.method = "gather"}); // in which the box is in the picture
    device().collect();
    EXPECT_EQ(device().living().images, without);
}

/// What red exceeds green by at most: where the red box or a ghost of it is.
float findReddest(const image::Image& picture) {
    float most = 0.0f;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            most = std::max(most, picture.at(x, y, 0) - picture.at(x, y, 1));
    return most;
}

TEST_F(ResolvedHistory, RemovedEntitiesLeaveNoGhost) {
    const auto teleportAway = [](Scene& scene) {
        scene::teleport(
            scene.world(), scene.box, {.translation = {0, 0, 50}}, -0.75 / kFramesPerSecond
        );
    };
    const auto hide = [](Scene& scene) { scene::hide(scene.world(), scene.box); };
    const auto despawn = [](Scene& scene) { scene::despawn(scene.world(), scene.box); };
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> events = {
        {"teleported", teleportAway}, {"hidden", hide}, {"despawned", despawn}};
    for (const auto& [name, happen] : events) {
        Scene scene(true);
        // The camera turns, so that every pixel is searched for.
        scene.builder.moveCamera({.angularVelocity = {0.0, 3.0, 0.0}});
        HistoryFrames frames(device(), scene);
        EXPECT_GT(findReddest(frames.at(-1).color), 0.5f) << "the box is in the picture";
        happen(scene);
        const auto drawn = frames.at(0);
        EXPECT_GT(countFromLast(drawn), 0u) << name << ": what left the picture's side";
        EXPECT_LT(findReddest(drawn.color), findReddest(drawAlone(scene).color) + 1e-3f) << name;
    }
}

TEST_F(ResolvedHistory, AppearingEntitiesHaveNoPastAndHideNothingBefore) {
    Scene scene;
    scene::hide(scene.world(), scene.box);
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    scene::show(scene.world(), scene.box, -0.25 / kFramesPerSecond);
    // It is static in this frame: all that is seen is in this frame's raster.
    const auto drawn = frames.at(0);
    EXPECT_EQ(countFromLast(drawn), 0u);
    EXPECT_TRUE(test::sameBits(drawn.color, drawAlone(scene).color));
    (void)frames.at(1);
    EXPECT_GT(countFromLast(frames.at(2)), 0u) << "then it moves, and has a past";
}

} // namespace
} // namespace shutter
