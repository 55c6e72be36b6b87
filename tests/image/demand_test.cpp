// SPDX-License-Identifier: MIT
// A frame costs only what it shows, without changing the picture; passes that may be omitted;
// frames of another method while pipelines are being made; what a renderer keeps from frame to
// frame, and frames that the CPU submits before the GPU is done with those before.
#include "engine/image/metrics.h"
#include "engine/rays/tlas.h"
#include "engine/scene/history.h"
#include "game/shot/picture_features.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/particles/particle_emitter.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <array>
#include <fcntl.h>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::CompositeRule;
using motion_blur::UntilReady;
using test::AdaptiveLaw;
using test::Frames;
using test::SceneBuilder;
using test::Shot;

/// A sphere that crosses the picture.
SceneBuilder makeSphere() {
    SceneBuilder scene = test::makeView();
    scene.add(
        test::makeSphere(0.5, scene.addColor({1.0f, 0.4f, 0.1f})),
        {.position = {0, 0, -2}, .velocity = {0.5, 0.2, 0}}
    );
    return scene;
}

/// ... before a wall of waves.
SceneBuilder makeCrossing() {
    SceneBuilder scene = makeSphere();
    scene.add(test::makeQuad(9.0, 9.0, scene.addWaves()), {.position = {0, 0, -4}});
    return scene;
}

/// A frame of a game: exposed for the share of 1/24 s.
Shot frameShot(std::string_view method, double exposureSeconds = 0.5) {
    return {
        .method = method,
        .exposureSeconds = exposureSeconds,
        .phase = scene::ShutterPhase::End,
        .frameSeconds = 1.0 / 24.0};
}

class DemandLaw : public test::RayTest {
  protected:
    static render::FrameResult draw(
        const SceneBuilder& scene,
        const motion_blur::MotionBlurSettings& settings,
        std::string_view method = "hybrid"
    ) {
        return test::renderOnce(
            device(),
            scene,
            {.method = method,
             .width = 160,
             .height = 120,
             .background = math::vec3(0.2f, 0.3f, 0.4f),
             .settings = settings}
        );
    }
};

TEST_F(DemandLaw, NoRayIsTracedInFrontOfTheSkyAndThePictureIsTheSame) {
    const SceneBuilder scene = makeSphere();
    const auto frame = draw(scene, {});
    EXPECT_GT(frame.statistics.counters.at("pixels masked"), 100u);
    EXPECT_EQ(frame.statistics.counters.at("rays traced"), 0u);
    EXPECT_EQ(test::countPasses(frame, "TLAS"), 0u);
    EXPECT_EQ(test::countPasses(frame, "sky reveal"), 1u);
    const auto traced = draw(scene, {.revealTraversal = motion_blur::RevealTraversal::Stepping});
    EXPECT_GT(traced.statistics.counters.at("rays traced"), 100u);
    EXPECT_GT(test::countPasses(traced, "TLAS"), 0u);
    EXPECT_TRUE(test::sameBits(frame.color, traced.color));
}

TEST_F(DemandLaw, HybridWithoutRaysIsSkippedInFrontOfTheSkyToo) {
    gpu::DeviceOptions options;
    options.validate = true;
    options.bestTier = gpu::RayTier::None;
    auto lower = gpu::Device::create(options);
    ASSERT_TRUE(lower.ok());
    const SceneBuilder scene = makeSphere();
    render::Renderer renderer(*lower.value(), scene.world.assets);
    motion_blur::MotionBlurPlugin blur(
        *lower.value(), renderer.scene(), {.method = &motion_blur::getMethod("hybrid")}
    );
    render::FrameRequest request;
    request.view.camera = scene.camera;
    request.view.exposure = scene::computeExposure({1.0}, 0.0);
    request.view.width = request.view.height = 64;
    request.wantReasons = true;
    render::Effect* effects[] = {&blur};
    const auto frame = renderer.renderFrame(scene.world, request, {.effects = effects});
    ASSERT_TRUE(frame.ok());
    EXPECT_NE(test::describeMotionBlur(frame.value()).find("needs rays"), std::string::npos);
    EXPECT_EQ(lower.value()->validationMessageCount(), 0u);
}

TEST_F(DemandLaw, NormalsAreDrawnOnlyForWhatReadsThem) {
    const SceneBuilder scene = makeCrossing();
    const auto draws = [&](const char* method, const char* intermediate) {
        const render::FrameResult frame =
            Frames(device(), scene).draw(frameShot(method), [&](game::PictureRequest& request) {
                request.frame.intermediates = {intermediate};
            });
        return frame.dump.find("normal") != std::string::npos;
    };
    EXPECT_TRUE(draws("hybrid", "depth"));
    EXPECT_TRUE(draws("sharp", "normal"));
    EXPECT_FALSE(draws("sharp", "depth"));
    EXPECT_FALSE(draws("resolved", "depth"));
}

TEST_F(DemandLaw, UnusedResourcesAreFreedAfterAWhile) {
    const SceneBuilder scene = makeCrossing();
    Frames frames(device(), scene);
    for (int i = 0; i < 2; ++i)
        (void)frames.draw(frameShot("hybrid", 0.0));
    device().collect();
    const gpu::LivingObjects still = device().living();
    (void)frames.draw(frameShot("hybrid"));
    // Pipelines and the read-back of counters stay; they know no picture's size.
    EXPECT_GT(device().living().accelerationStructures, still.accelerationStructures);
    // One more: retired objects are freed when the next frame is done.
    for (uint32_t i = 0; i <= core::kFramesKept; ++i)
        (void)frames.draw(frameShot("hybrid", 0.0));
    device().collect();
    EXPECT_EQ(device().living().accelerationStructures, still.accelerationStructures);
    EXPECT_EQ(device().living().images, still.images);
    EXPECT_GT(frames.draw(frameShot("hybrid")).statistics.counters.at("rays traced"), 0u);
}

TEST_F(DemandLaw, ATooSmallBudgetEndsWithTheCheapestBlurAndAReport) {
    const SceneBuilder scene = makeCrossing();
    const Shot shot = frameShot("gather");
    motion_blur::MotionBlurSettings settings = shot.settings;
    settings.method = &motion_blur::getMethod("gather");
    const double last = double(motion_blur::makeLevels(settings).size() - 1);
    Frames frames(device(), scene, {1e-6});
    render::FrameResult frame;
    const core::Decision* budget = nullptr;
    for (int i = 0; i < 40; ++i) {
        frame = frames.draw(shot);
        const auto& explanations = frame.statistics.explanations;
        const auto* blur = render::findDecision(explanations, "motion blur");
        ASSERT_NE(blur, nullptr);
        ASSERT_TRUE(blur->run) << "a budget took the blur away: " << blur->reason;
        EXPECT_GT(frame.statistics.measures.at("blur ms"), 0.0);
        budget = render::findDecision(explanations, "blur budget");
        ASSERT_NE(budget, nullptr);
        EXPECT_EQ(budget->run, frame.statistics.measures.at("blur budget level") > 0.0);
    }
    EXPECT_EQ(frame.statistics.measures.at("blur budget level"), last);
    EXPECT_EQ(test::countPasses(frame, "own velocity"), 1u);
    EXPECT_NE(budget->reason.find("4 samples"), std::string::npos) << budget->reason;
    EXPECT_FALSE(test::sameBits(frame.color, frames.draw(frameShot("gather", 0.0)).color));
}

TEST_F(DemandLaw, ABudgetOfPlentyChangesNoBit) {
    const SceneBuilder scene = makeCrossing();
    Frames limited(device(), scene, {1e6});
    Frames unlimited(device(), scene);
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(test::sameBits(
            limited.draw(frameShot("gather")).color, unlimited.draw(frameShot("gather")).color
        ));
}

TEST_F(DemandLaw, AQuarterOfTheRaysRevealsNearlyTheSame) {
    const SceneBuilder scene = makeCrossing();
    const auto full = draw(scene, {});
    const auto& counted = full.statistics.counters;
    double last = 1.01;
    for (const float share : {1.0f, 0.6f, 0.25f, 0.1f, 0.0f}) {
        const auto frame = draw(scene, {.rayShare = share});
        const auto& counters = frame.statistics.counters;
        const double traced =
            double(counters.at("rays traced")) / double(counted.at("rays traced"));
        // The rims of the mask have quads with few masked pixels.
        EXPECT_LE(traced, share + 0.2) << share;
        EXPECT_GE(traced, 0.6 * share) << share;
        EXPECT_LE(traced, last);
        last = traced;
        if (share >= 0.25f) {
            EXPECT_EQ(counters.at("pixels masked"), counted.at("pixels masked"));
        }
        if (share == 1.0f)
            EXPECT_TRUE(test::sameBits(frame.color, full.color));
        else
            EXPECT_GT(image::computePsnr(frame.color, full.color), share >= 0.25f ? 40.0 : 25.0);
        if (share == 0.0f) {
            const auto weights =
                draw(scene, {.composite = CompositeRule::Weights, .rayShare = 0.0f});
            EXPECT_TRUE(test::sameBits(weights.color, draw(scene, {}, "gather").color));
        }
    }
}

TEST_F(DemandLaw, HalfOfTheResolutionAlongAPanIsHardToSeeAndForSmearsAlongRowsAndColumnsAlone) {
    const auto pan = [](const math::dvec3& velocityPx) {
        SceneBuilder scene = test::makePixelView(120);
        scene.add(
            test::makeQuad(900, 900, scene.addWaves()),
            {.position = {0, 0, -10}, .velocity = velocityPx}
        );
        return scene;
    };
    const SceneBuilder across = pan({20, 20, 0});
    const auto full = draw(across, {}, "gather");
    EXPECT_GT(full.statistics.counters.at("blocks uniform"), 200u);
    EXPECT_TRUE(test::sameBits(draw(across, {.halfResolutionPx = 8}, "gather").color, full.color));
    const SceneBuilder along = pan({24, 3, 0});
    const auto expected = draw(along, {}, "gather").color;
    const auto half = draw(along, {.halfResolutionPx = 8}, "gather").color;
    EXPECT_FALSE(test::sameBits(half, expected));
    EXPECT_GT(image::computePsnr(half, expected), 40.0);
    // Longer than anything moves.
    EXPECT_TRUE(test::sameBits(draw(along, {.halfResolutionPx = 100}, "gather").color, expected));
}

/// A pane that moves before a wall.
SceneBuilder makePane() {
    SceneBuilder scene = test::makeWavyRoom(6.0, 9.0, 7.0);
    test::addCard(
        scene, {0.7, 0.7}, {1, 0, 0}, {.position = {-0.2, 0, -2}, .velocity = {0.8, 0.1, 0}}
    );
    return scene;
}

void expectOneClear(const char* method) {
    const SceneBuilder scene = makePane();
    const auto frame = Frames(test::sharedDevice(), scene).draw(frameShot(method, 0.25));
    EXPECT_EQ(test::countPasses(frame, "clear"), 1u) << method;
}

TEST_F(DemandLaw, AllClearedResourcesOfAMethodShareOnePass) {
    for (const char* method : {"gather", "hybrid", "resolved"})
        expectOneClear(method);
}

TEST_F(AdaptiveLaw, AllClearedResourcesShareOnePass) {
    expectOneClear("adaptive");
}

TEST_F(DemandLaw, UnreadCountersAreNotReadBack) {
    const SceneBuilder scene = makePane();
    Frames frames(device(), scene);
    const auto check = [&](const char* method, const char* counter, const char* pass) {
        const auto draw = [&](bool wantCounters) {
            return frames.draw(frameShot(method, 0.25), [&](game::PictureRequest& request) {
                request.frame.wantCounters = wantCounters;
            });
        };
        // Frames that follow are alike: the first builds what rays need and counts its blocks.
        (void)draw(true);
        const render::FrameResult counted = draw(true);
        const render::FrameResult plain = draw(false);
        EXPECT_TRUE(counted.statistics.counters.contains(counter)) << method;
        EXPECT_FALSE(plain.statistics.counters.contains(counter)) << method;
        EXPECT_TRUE(test::hasPass(counted, pass)) << method;
        EXPECT_FALSE(test::hasPass(plain, pass)) << method;
        EXPECT_EQ(plain.statistics.passes.size() + 1, counted.statistics.passes.size()) << method;
        EXPECT_TRUE(test::sameBits(plain.color, counted.color)) << method;
        // They choose how the next frame's still pixels are copied.
        EXPECT_TRUE(plain.statistics.counters.contains("blocks still")) << method;
    };
    check("hybrid", "pixels masked", "read ray mask counters");
    check("resolved", "unresolved samples", "read resolved counters");
}

/// Pipelines that three frames request on a device that makes them ahead, as `play` does on GPUs.
uint32_t countRequested(const gpu::Device& like, const SceneBuilder& scene, const char* method) {
    gpu::DeviceOptions options;
    options.validate = true;
    options.wanted = like.info().name;
    options.pipelinesAhead = gpu::PipelinesAhead::Always;
    auto device = gpu::Device::create(options);
    EXPECT_TRUE(device) << device.error().message;
    if (!device)
        return 0;
    {
        Frames frames(*device.value(), scene);
        for (const double seconds : {0.2, 0.25, 0.3})
            (void)frames.draw(frameShot(method, seconds));
    }
    EXPECT_EQ(device.value()->validationMessageCount(), 0u);
    return device.value()->lazyPipelineCount();
}

TEST_F(DemandLaw, AGpuCompilesTheSearchesThatItsFramesUse) {
    SceneBuilder lens = makePane();
    lens.world.registry.add(lens.camera, scene::CameraLens{.fStop = 1.4, .focusDistance = 0.5});
    SceneBuilder deforming = makePane();
    const test::Placement joints[] = {
        {.position = {0.3, -0.5, -2}}, {.position = {0, 0.5, 0}, .angularVelocity = {0, 0, 2}}};
    test::addSkinned(
        deforming, test::makeStrip(0.3, 1.0, 4, deforming.addColor({0.9f, 0.2f, 0.1f})), joints
    );
    const SceneBuilder pane = makePane();
    const SceneBuilder sphere = makeSphere();
    const SceneBuilder* const scenes[] = {&pane, &sphere, &deforming, &lens};
    for (const SceneBuilder* scene : scenes) {
        // There are 64 variants of each of three passes that search.
        EXPECT_LE(countRequested(device(), *scene, "resolved"), 50u);
        EXPECT_LE(countRequested(device(), *scene, "gather"), 25u);
    }
}

/// A device that makes pipelines ahead, except for one, which waits until it is released.
class HoldingDevice {
  public:
    HoldingDevice(const std::string& name, gpu::RayTier tier) {
        gpu::DeviceOptions options;
        options.validate = true;
        options.wanted = name;
        options.bestTier = tier;
        options.pipelinesAhead = gpu::PipelinesAhead::Always;
        EXPECT_EQ(mkfifo(mFifo.c_str(), S_IRUSR | S_IWUSR), 0);
        auto made = test::openFaulty(
            options, "SHUTTER_FAULT_HOLD", "ray reveal through blended surfaces=" + mFifo.string()
        );
        EXPECT_TRUE(made) << made.error().message;
        if (made)
            mDevice = std::move(made).value();
    }

    ~HoldingDevice() {
        letGo();
        mDevice.reset();
        close(mWriter);
        std::filesystem::remove(mFifo);
    }

    HoldingDevice(const HoldingDevice&) = delete;
    HoldingDevice& operator=(const HoldingDevice&) = delete;

    void letGo() {
        if (mWriter < 0)
            mWriter = open(mFifo.c_str(), O_RDWR); // does not wait for a reader
    }

    [[nodiscard]] gpu::Device* device() const { return mDevice.get(); }

  private:
    std::filesystem::path mFifo = std::filesystem::temp_directory_path() /
                                  ("shutter_held_pipeline_" + std::to_string(getpid()));
    int mWriter = -1;
    std::unique_ptr<gpu::Device> mDevice;
};

/// Destruction waits for pipelines in progress: a failing test must release them.
struct LetGoAtEnd {
    HoldingDevice& holding;

    ~LetGoAtEnd() { holding.letGo(); }
};

class StandIn : public test::RayTest {
  protected:
    static render::FrameResult draw(Frames& frames, const char* method, UntilReady untilReady) {
        return frames.draw(frameShot(method, 0.25), [&](game::PictureRequest& request) {
            request.untilReady = untilReady;
        });
    }

    static bool standsIn(const render::FrameResult& frame) {
        return frame.statistics.measures.contains("blur stands in");
    }

    /// `hybrid` on a device of the tier.
    static void checkTier(gpu::RayTier tier) {
        HoldingDevice holding(device().info().name, tier);
        const SceneBuilder scene = makePane();
        ASSERT_TRUE(holding.device());
        {
            Frames frames(*holding.device(), scene);
            const LetGoAtEnd atEnd{holding};
            const auto waited = draw(frames, "hybrid", UntilReady::Wait);
            EXPECT_FALSE(standsIn(waited));
            EXPECT_TRUE(test::hasPass(waited, "build TLAS"));
            EXPECT_TRUE(test::hasPass(waited, "ray reveal"));

            // Now the one for scenes without blended surfaces is made, which is not enough: one may
            // come into sight in any frame.
            const auto held = draw(frames, "hybrid", UntilReady::StandIn);
            ASSERT_TRUE(standsIn(held));
            EXPECT_FALSE(test::hasPass(held, "count"));
            EXPECT_FALSE(test::hasPass(held, "build TLAS")) << "nobody traces rays";
            const auto gathered = draw(frames, "gather", UntilReady::StandIn);
            EXPECT_FALSE(standsIn(gathered)) << "gather has nothing to wait for";
            EXPECT_TRUE(test::sameBits(held.color, gathered.color));

            holding.letGo();
            auto ready = draw(frames, "hybrid", UntilReady::StandIn);
            for (int i = 0; i < 1000 && standsIn(ready); ++i)
                ready = draw(frames, "hybrid", UntilReady::StandIn);
            EXPECT_FALSE(standsIn(ready)) << "hybrid never took over";
            EXPECT_TRUE(test::sameBits(ready.color, waited.color));
            EXPECT_FALSE(test::sameBits(ready.color, gathered.color))
                << "the scene shows no difference";
        }
        EXPECT_EQ(holding.device()->validationMessageCount(), 0u);
    }
};

// Each in a separate process: the layer reads its held pipelines once.
TEST_F(StandIn, GatherDrawsUntilBothKindsOfRevealArePreparedByQueries) {
    checkTier(gpu::RayTier::RayQuery);
}

TEST_F(StandIn, GatherDrawsUntilBothKindsOfRevealArePreparedByRayPipelines) {
    checkTier(gpu::RayTier::Pipeline);
}

TEST_F(StandIn, NoFallbackMethodRunsIfPipelinesAreMadeOnFirstUse) {
    const SceneBuilder scene = makePane();
    Frames frames(device(), scene);
    EXPECT_FALSE(standsIn(draw(frames, "hybrid", UntilReady::StandIn)));
}

class KeptFrames : public test::Frames {
  public:
    using Frames::Frames;

    render::FrameResult hybrid(double seconds, uint32_t width = 96) {
        return draw(
            {.method = "hybrid",
             .width = width,
             .seconds = seconds,
             .exposureSeconds = 0.5,
             .aovs = {"motion", "mesh_id"}}
        );
    }
};

void expectWritten(const render::FrameResult& frame, uint64_t rows, uint64_t motions) {
    EXPECT_EQ(frame.statistics.counters.at("entity rows written"), rows);
    EXPECT_EQ(frame.statistics.counters.at("entity motions written"), motions);
}

/// A mover in front of `count` tiles of a wall, each a separate entity.
struct Crowd {
    SceneBuilder scene;
    std::vector<ecs::Entity> tiles;
    ecs::Entity mover;

    explicit Crowd(size_t count) {
        scene.setPerspective(0.9);
        const auto material = scene.addWaves();
        const auto tile = scene.addMesh({test::makeQuad(0.32, 0.3, material)});
        const auto pane = test::addGlass(scene, {0.2f, 0.6f, 0.9f, 0.5f});
        const auto glass = scene.addMesh({test::makeQuad(0.32, 0.3, pane)});
        for (size_t i = 0; i < count; ++i) {
            const dvec3 place(-3.2 + 0.34 * double(i % 20), -2.2 + 0.31 * double(i / 20), -5.0);
            tiles.push_back(scene.add(i % 16 == 15 ? glass : tile, {.position = place}));
        }
        mover = test::addCard(
            scene, {0.6, 0.6}, {1, 0, 0}, {.position = {-0.2, 0, -2}, .velocity = {0.5, 0.1, 0}}
        );
    }

    math::Transform& transformOf(ecs::Entity entity) {
        return scene.world.registry.get<scene::LocalTransform>(entity).transform;
    }
};

TEST_F(DemandLaw, AStillFrameWritesNeitherRowsNorMotionsAndBuildsNothing) {
    Crowd crowd(40);
    scene::hide(crowd.scene.world, crowd.mover);
    KeptFrames frames(device(), crowd.scene);
    const auto first = frames.hybrid(0.0);
    expectWritten(first, 40, 0);
    const auto second = frames.hybrid(1.0);
    expectWritten(second, 0, 0);
    EXPECT_FALSE(test::hasPass(second, "build TLAS"));
    EXPECT_TRUE(test::sameBits(first.color, second.color));
}

TEST_F(DemandLaw, OnlyMovingRowsAreWritten) {
    const Crowd crowd(40);
    KeptFrames frames(device(), crowd.scene);
    expectWritten(frames.hybrid(0.0), 41, 1);
    const auto second = frames.hybrid(0.1);
    expectWritten(second, 1, 1);
    EXPECT_TRUE(test::hasPass(second, "build TLAS")) << "the mover stands elsewhere";
    const auto paused = frames.hybrid(0.1);
    expectWritten(paused, 0, 1);
    EXPECT_FALSE(test::hasPass(paused, "build TLAS")) << "no instance moved";
    EXPECT_TRUE(test::hasPass(paused, "ray reveal"));
    EXPECT_TRUE(test::sameBits(second.color, paused.color));
}

TEST_F(DemandLaw, ManyStaticInstancesHaveATlasThatIsBuiltOnce) {
    Crowd crowd(rays::kStaticTlasInstances);
    KeptFrames frames(device(), crowd.scene);
    const auto first = frames.hybrid(0.0);
    EXPECT_TRUE(test::hasPass(first, "build TLAS"));
    EXPECT_TRUE(test::hasPass(first, "build TLAS of movers"));
    const auto second = frames.hybrid(0.1);
    EXPECT_FALSE(test::hasPass(second, "build TLAS"));
    EXPECT_TRUE(test::hasPass(second, "build TLAS of movers"));
    crowd.transformOf(crowd.scene.camera).translation.x = 0.1;
    EXPECT_TRUE(test::hasPass(frames.hybrid(0.2), "build TLAS")) << "seen from another place";
}

TEST_F(DemandLaw, ATableWritesTheRowsAndMasksThatChangedAndAllAfterAFrameThatItMissed) {
    const Crowd crowd(40);
    const gpu_scene::GpuScene scene(device(), crowd.scene.world.assets);
    extract::FrameExtractor extractor;
    gpu_scene::EntityTable table(device());
    const auto extract = [&](double seconds) -> const extract::ExtractedFrame& {
        extract::ViewRequest view;
        view.camera = crowd.scene.camera;
        view.exposure = scene::computeExposure({0.5, scene::ShutterPhase::Centre}, seconds);
        return *extractor.update(crowd.scene.world, scene.layout(), view).value();
    };
    EXPECT_EQ(table.update(extract(0.0)).rows, 41u);
    EXPECT_EQ(table.update(extract(0.1)).rows, 1u);
    (void)extract(0.2);
    EXPECT_EQ(table.update(extract(0.3)).rows, 41u);
    const std::vector<extract::ExtraRow> extra(1);
    EXPECT_EQ(table.update(extract(0.4), nullptr, extra).rows, 2u) << "of this frame only";
    EXPECT_EQ(table.update(extract(0.5)).rows, 1u);
    const uint32_t mover = 40;
    const std::vector<extract::RowMask> masks{{0, 7u}, {mover, 11u}};
    EXPECT_EQ(table.update(extract(0.6), &masks).rows, 3u) << "the mover, and two masks";
    EXPECT_EQ(table.update(extract(0.7), &masks).rows, 1u) << "masks are as they were";
    EXPECT_EQ(table.update(extract(0.8)).rows, 1u) << "no ray needs them";
    const std::vector<extract::RowMask> none;
    EXPECT_EQ(table.update(extract(0.9), &none).rows, 3u);
}

TEST_F(DemandLaw, PicturesAreThoseOfARendererThatKeptNothing) {
    for (const size_t count : {size_t{60}, rays::kStaticTlasInstances + 40}) {
        Crowd crowd(count);
        scene::World& world = crowd.scene.world;
        const std::array joints{
            test::Placement{.position = {0.6, -0.8, -3}},
            test::Placement{.position = {0, 0.8, 0}, .angularVelocity = {0.4, 0, 0.9}}};
        const auto strip = crowd.scene.addTextured(crowd.scene.addWaveTexture(), true);
        test::addSkinned(crowd.scene, test::makeStrip(0.5, 1.6, 8, strip), joints);
        double seconds = 0.0;
        uint32_t width = 96;
        const std::vector<std::function<void()>> edits{
            [] {},
            [&] { seconds = 0.1; },
            [&] { crowd.transformOf(crowd.tiles[25]).translation.z = -3.0; },
            [&] { crowd.transformOf(crowd.tiles[25]).translation.z = -2.5; },
            [&] { scene::hide(world, crowd.tiles[30]); },
            [&] {
                crowd.transformOf(crowd.scene.camera).translation = {0.1, 0.1, 0.2};
            },
            [&] {
                world.registry.add(crowd.scene.camera, scene::LinearVelocity{{0.2, 0, 0}});
            },
            [&] { seconds = 0.15; },
            [&] { world.registry.remove<scene::LinearVelocity>(crowd.scene.camera); },
            [&] { scene::despawn(world, crowd.tiles[3]); },
            [&] { scene::show(world, crowd.tiles[30], 0.0); },
            [&] { width = 112; },
            [&] { scene::despawn(world, crowd.mover); }};
        KeptFrames kept(device(), crowd.scene);
        for (size_t i = 0; i < edits.size(); ++i) {
            edits[i]();
            const auto frame = kept.hybrid(seconds, width);
            KeptFrames fresh(device(), crowd.scene);
            const auto expected = fresh.hybrid(seconds, width);
            EXPECT_TRUE(test::sameBits(frame.color, expected.color)) << count << ", edit " << i;
            for (const auto& [name, image] : expected.intermediates)
                EXPECT_TRUE(test::sameBits(frame.intermediates.at(name), image)) << name << i;
        }
    }
}

constexpr int kFrames = 9;

struct Sequence {
    std::vector<image::Image> colors;
    std::vector<render::Counters> counters;
};

Sequence drawSequence(gpu::Device& device, const std::string& method, uint32_t framesInFlight) {
    // The mover comes and goes, under a camera that moves, a pane crosses it, and sparks fly.
    Crowd crowd(40);
    crowd.scene.moveCamera({.velocity = {0.1, 0, 0}});
    crowd.scene.add(
        test::makeQuad(0.5, 0.4, test::addGlass(crowd.scene, {0.1f, 0.9f, 0.4f, 0.6f})),
        {.position = {0.1, 0.1, -1.5}, .velocity = {-1.0, 0.2, 0}, .angularVelocity = {0, 0, 2}}
    );
    scene::World& world = crowd.scene.world;
    particles::ParticleEmitter emitter;
    emitter.spans = {{.fromSeconds = -1.0, .untilSeconds = 1.0, .perSecond = 60.0}};
    emitter.lifeSeconds = 0.3;
    emitter.velocity = {0.0, 1.0, 0.0};
    emitter.coneDegrees = 90.0;
    test::addEmitter(crowd.scene, emitter, {0.0, 0.0, -2.0});
    render::Renderer renderer(device, world.assets, framesInFlight);
    motion_blur::MotionBlurPlugin blur(
        device, renderer.scene(), {.method = &motion_blur::getMethod(method)}
    );
    const std::vector<render::Effect*> effects{&blur};
    const game::PictureFeatures features(device, renderer.scene());
    Sequence sequence;
    const auto finish = [&] {
        render::FrameResult result = renderer.finishFrame();
        sequence.colors.push_back(std::move(result.color));
        // The number of written rows and the reused data depend on the frames in flight.
        for (const char* own : {"entity rows written", "entity motions written", "history bytes"})
            result.statistics.counters.erase(own);
        sequence.counters.push_back(result.statistics.counters);
    };
    for (int i = 0; i < kFrames; ++i) {
        if (i == 3)
            scene::hide(world, crowd.mover);
        if (i == 6)
            scene::show(world, crowd.mover, 0.05 * i);
        if (renderer.unfinishedCount() == framesInFlight)
            finish();
        render::FrameRequest request;
        request.view.camera = crowd.scene.camera;
        request.view.exposure =
            scene::computeExposure({0.4, scene::ShutterPhase::Centre}, 0.05 * i);
        // The picture changes its size on the way.
        request.view.width = i < 5 ? 96 : 80;
        request.view.height = 64;
        EXPECT_TRUE(renderer.submitFrame(world, request, features.listWith(effects)).ok());
    }
    while (renderer.unfinishedCount() > 0)
        finish();
    return sequence;
}

TEST_F(DemandLaw, OverlappingFramesGiveThePicturesAndCountersOfSequentialOnes) {
    for (const std::string method : {"hybrid", "resolved"}) {
        const Sequence alone = drawSequence(device(), method, 1);
        ASSERT_EQ(alone.colors.size(), size_t{kFrames});
        if (method == "hybrid") {
            EXPECT_GT(alone.counters[2].at("pixels masked"), 100u);
        }
        EXPECT_GT(alone.counters[2].at("blended instants"), 1u);
        EXPECT_NE(alone.counters[2], alone.counters[4]);
        for (const uint32_t count : {2u, gpu::kMaxFramesInFlight}) {
            const Sequence ahead = drawSequence(device(), method, count);
            ASSERT_EQ(ahead.colors.size(), alone.colors.size());
            for (size_t i = 0; i < alone.colors.size(); ++i) {
                EXPECT_TRUE(test::sameBits(ahead.colors[i], alone.colors[i]))
                    << method << count << ", " << i;
                EXPECT_EQ(ahead.counters[i], alone.counters[i]) << method << count << ", " << i;
            }
        }
    }
}

} // namespace
} // namespace shutter
