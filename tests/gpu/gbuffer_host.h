// SPDX-License-Identifier: MIT
// A host with the engine's G-buffer, which describes the motion of the engine's scene.
#pragma once

#include "engine/extract/frame_view.h"
#include "engine/graph/execute.h"
#include "engine/graph/graph.h"
#include "engine/render/renderer.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "game/shot/picture_features.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/gpu/embedding_host.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::test {

/// What scene::ResponseShape::Triangle is.
[[nodiscard]] inline std::vector<math::ResponsePoint> triangleResponse() {
    return {{0.0, 0.0}, {0.5, 1.0}, {1.0, 0.0}};
}

/// Takes the engine's G-buffer as a host would give its own: raw handles of images in the layouts
/// they happen to have. Blurs it into another picture (view 0) and, a copy of it, in place (view
/// 1); the frame continues with the original.
class HostOfTheGBuffer : public render::Effect {
  public:
    HostOfTheGBuffer(
        gpu::Device& device,
        motion_blur::EmbeddedMotionBlur& blur,
        const motion_blur::MotionBlurSettings& hosts,
        math::uvec2 sizePx
    )
        : settings(hosts), output(device, sizePx), inPlace(device, sizePx), byC(device, sizePx),
          mBlur(blur) {}

    motion_blur::MotionBlurSettings settings;
    Picture output;
    Picture inPlace;
    /// With it the C interface draws the same picture once more, under its number 0.
    ShutterBlur* blurOfC = nullptr;
    Picture byC;
    /// The response of the frame as C has it, which takes no address of a table.
    std::vector<math::ResponsePoint> responseForC;
    int64_t frameNumber = 0;
    /// Describes the motion in the frame. Referenced objects must live until the frame is recorded.
    std::function<void(const render::PictureContext&, motion_blur::HostMotion&)> describeMotion;

    bool dropsIds = false; ///< the host has none

    /// Turns the rays that are handed in into a reveal of the host's own.
    std::function<void(motion_blur::HostInputs&)> takeRays;
    /// Changes inputs of the host, but the images of the G-buffer. Referenced objects must live
    /// until the frame has ended.
    std::function<void(const render::PictureContext&, motion_blur::HostInputs&)> changeInputs;

    [[nodiscard]] std::string name() const override { return "host"; }

    [[nodiscard]] render::Needs decide(const render::DecideContext&) const override {
        return {.run = {true, "the test reads it"}, .normals = true};
    }

    void declare(render::PictureContext& context) override {
        struct Data {
            graph::ImageHandle color, motionDepth, normal, entityId;
        };

        motion_blur::HostInputs inputs;
        inputs.width = context.facts.width;
        inputs.height = context.facts.height;
        inputs.rasterTime = context.facts.rasterTime;
        inputs.response = context.response;
        inputs.frameNumber = frameNumber;
        inputs.rays.frameConstants = context.frameConstants;
        if (context.rays) {
            inputs.rays.tlas = context.rays->tlas;
            inputs.rays.scene = context.rays->textures;
            inputs.rays.frameConstants = context.rays->frameConstants;
            inputs.rays.hasBlended = context.rays->hasBlended;
        }
        if (describeMotion)
            describeMotion(context, inputs.motion);
        if (changeInputs)
            changeInputs(context, inputs);
        using graph::Access;
        const auto timed = context.timedRays;
        const graph::BufferHandle level =
            context.rays ? context.rays->tlasBuffer : graph::BufferHandle{};
        context.graph.addPass<Data>(
            "host",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.color = builder.read(context.color, Access::SampledCompute);
                data.motionDepth =
                    builder.read(context.gbuffer.motionDepth, Access::SampledCompute);
                data.normal = builder.read(context.gbuffer.normal, Access::SampledCompute);
                data.entityId = builder.read(context.gbuffer.entityId, Access::SampledCompute);
                if (level.isValid())
                    builder.read(level, Access::AccelerationRead);
                if (timed)
                    for (const graph::BufferHandle buffer : {timed->tlasBuffer, timed->boxesBuffer})
                        if (buffer.isValid())
                            builder.read(buffer, Access::AccelerationRead);
                builder.sideEffect();
            },
            [this, inputs, level](const Data& data, graph::PassContext& pass) {
                const auto give = [&](graph::ImageHandle image) {
                    return motion_blur::HostImage{
                        pass.resources.image(image).handle(), kSampled, kSampled};
                };
                motion_blur::HostInputs given = inputs;
                given.color = give(data.color);
                given.motionDepth = give(data.motionDepth);
                given.normal = give(data.normal);
                if (!dropsIds)
                    given.entityId = give(data.entityId);
                if (level.isValid())
                    given.rays.tlasBuffer = pass.resources.buffer(level);
                if (takeRays)
                    takeRays(given);
                recordBoth(pass.commands, given);
            }
        );
    }

  private:
    void recordBoth(VkCommandBuffer commands, motion_blur::HostInputs& inputs) {
        inputs.output = output.output();
        const core::Status other = mBlur.record(commands, 0, inputs, settings);
        ASSERT_TRUE(other.ok()) << other.error().message;
        output.recordReadback(commands);
        if (blurOfC)
            recordByC(commands, inputs);

        const VkImage color = inputs.color.image;
        moveOn(commands, color, kSampled, kCopied);
        moveOn(commands, inPlace.handle(), kNothing, kWritten);
        const VkImageCopy region = wholeCopy(inputs.width, inputs.height);
        vkCmdCopyImage(
            commands, color, kCopied.layout, inPlace.handle(), kWritten.layout, 1, &region
        );
        moveOn(commands, color, kCopied, kSampled);
        inputs.output = {};
        inputs.color = {inPlace.handle(), kWritten, kCopied};
        inputs.motion.view = 1;
        const core::Status same = mBlur.record(commands, 1, inputs, settings);
        ASSERT_TRUE(same.ok()) << same.error().message;
        inPlace.recordReadback(commands);
    }

    void recordByC(VkCommandBuffer commands, const motion_blur::HostInputs& inputs) {
        motion_blur::HostInputs given = inputs;
        given.output = byC.output();
        given.responsePoints = responseForC;
        const InputsForC reported(given);
        ShutterBlurSettings inC = shutterBlurDefaultSettings();
        inC.method = settings.method->name;
        inC.sampleCount = settings.sampleCount;
        const std::string rays = std::to_string(settings.raysPerPixel);
        const ShutterBlurValue value{"raysPerPixel", rays.c_str()};
        inC.values = &value;
        inC.valueCount = 1;
        ASSERT_EQ(
            shutterBlurRecord(blurOfC, commands, 0, &reported.inputs, &inC), SHUTTER_BLUR_SUCCESS
        ) << shutterBlurGetMessage();
        byC.recordReadback(commands);
    }

    motion_blur::EmbeddedMotionBlur& mBlur;
};

/// The camera when the shutter closes, and, as the one before, when it opens.
[[nodiscard]] inline motion_blur::HostCameras
declareCameras(const scene::World& world, const extract::ViewRequest& view) {
    const scene::ExposureMotion moves(world, view.camera, view.exposure);
    const auto& camera = world.registry.get<scene::Camera>(view.camera);
    const auto viewAt = [&](double s) { return glm::inverse(moves.worldFromCamera(s)); };
    const auto clipAt = [&](double s) {
        return extract::makeProjection(camera, moves.cameraYFov(s), view);
    };
    motion_blur::HostCameras cameras;
    cameras.areGiven = true;
    cameras.viewFromWorld = viewAt(1.0);
    cameras.clipFromView = clipAt(1.0);
    cameras.viewFromWorldBefore = viewAt(0.0);
    cameras.clipFromViewBefore = clipAt(0.0);
    return cameras;
}

/// Describes the engine's scene as a host would.
class MotionDescriber {
  public:
    /// \param instantCount of the method
    /// \param times of the keys besides the raster instant; empty: the instants
    explicit MotionDescriber(uint32_t instantCount, std::vector<double> times = {})
        : mInstantCount(instantCount), mTimes(std::move(times)) {}

    void declare(
        const scene::World& world,
        const render::PictureContext& context,
        motion_blur::HostMotion& motion
    ) {
        const scene::ExposureInterval& exposure = context.view.exposure;
        const scene::ExposureMotion moves(world, context.view.camera, exposure);
        const std::vector<double> times = listTimes(exposure);
        const auto& camera = world.registry.get<scene::Camera>(context.view.camera);
        mKeys.clear();
        for (const double s : times)
            mKeys.push_back(
                {s,
                 glm::inverse(moves.worldFromCamera(s)),
                 extract::makeProjection(camera, moves.cameraYFov(s), context.view)}
            );
        declareMovers(context.frame, moves, times, exposure.rasterTime);
        mResponse = scene::computeResponseTable(exposure.shutter.response);
        motion.keys = mKeys;
        motion.rowCount = uint32_t(context.frame.worldFromObject.size());
        motion.movers = mMovers;
        motion.rowIds = mIds;
        motion.response = mResponse ? &*mResponse : nullptr;
        motion.followsLast = followsLast;
    }

    bool followsLast = false;
    bool knowsMovers = true; ///< false: only which rows move, not how

  private:
    [[nodiscard]] std::vector<double> listTimes(const scene::ExposureInterval& exposure) const {
        std::vector<double> times = mTimes;
        if (times.empty())
            for (uint32_t i = 0; i < mInstantCount; ++i)
                times.push_back(
                    scene::invertResponse(exposure.shutter.response, (i + 0.5) / mInstantCount)
                );
        if (std::find(times.begin(), times.end(), exposure.rasterTime) == times.end())
            times.push_back(exposure.rasterTime);
        std::sort(times.begin(), times.end());
        return times;
    }

    /// All rows, whether they move or not.
    void declareMovers(
        const extract::ExtractedFrame& frame,
        const scene::ExposureMotion& moves,
        const std::vector<double>& times,
        double rasterTime
    ) {
        const size_t rows = frame.worldFromObject.size();
        mMovers.clear();
        mIds.clear();
        mMatrices.assign(rows, {});
        for (uint32_t row = 0; row < rows; ++row) {
            const ecs::Entity entity = frame.entityHandles[row];
            mIds.push_back(uint64_t(entity.generation) << 32u | entity.index);
            if (!knowsMovers && moves.mayObjectMove(entity))
                mMovers.push_back({row, {}});
            if (!knowsMovers)
                continue;
            for (const double s : times)
                mMatrices[row].push_back(
                    s == rasterTime ? frame.worldFromObject[row] : moves.worldFromObject(entity, s)
                );
            mMovers.push_back({row, mMatrices[row]});
        }
    }

    uint32_t mInstantCount;
    std::vector<double> mTimes;
    std::vector<motion_blur::HostCameraKey> mKeys;
    std::vector<motion_blur::HostMover> mMovers;
    std::vector<std::vector<math::dmat4>> mMatrices;
    std::vector<uint64_t> mIds;
    std::optional<shader::ResponseTable> mResponse;
};

inline constexpr math::uvec2 kStageSize{96, 64};

struct StagedFrame {
    render::FrameResult result; ///< its colour is the plugin's
    image::Image output;
    image::Image inPlace;
    image::Image byC;
};

/// Draws frames of a scene with a host's blur before the plugin's.
class BlurStage {
  public:
    /// \param blurs whose recordings are all done; it has two frames and views
    /// \param blurOfC the same; null: the C interface draws nothing
    BlurStage(
        gpu::Device& device,
        SceneBuilder& scene,
        motion_blur::EmbeddedMotionBlur& blurs,
        ShutterBlur* blurOfC,
        const motion_blur::MotionBlurSettings& hosts,
        const motion_blur::MotionBlurSettings& plugins
    )
        : BlurStage(device, scene, hosts, plugins, [&](auto&) { return &blurs; }) {
        host.blurOfC = blurOfC;
        for (uint32_t i = 0; i < 2; ++i) {
            EXPECT_TRUE(blurs.markDone(i).ok() && blurs.closeView(i).ok());
            EXPECT_TRUE(!blurOfC || shutterBlurCloseView(blurOfC, i) == SHUTTER_BLUR_SUCCESS);
        }
    }

    /// With a blur of its own, whose scene layout is the renderer's.
    BlurStage(
        gpu::Device& device,
        SceneBuilder& scene,
        motion_blur::HostDevice described,
        const motion_blur::MotionBlurSettings& settings
    )
        : BlurStage(device, scene, settings, settings, [&](const render::Renderer& drawing) {
              described.sceneLayout = drawing.scene().textureLayout();
              mOwn = motion_blur::EmbeddedMotionBlur::create(described).value();
              return mOwn.get();
          }) {}

    render::FrameResult drawSharp() {
        return renderer.renderFrame(mScene.world, makeRequest(), {}).value();
    }

    StagedFrame draw() {
        auto drawn =
            renderer.renderFrame(mScene.world, makeRequest(), mFeatures.listWith(mEffects));
        EXPECT_TRUE(drawn.ok()) << drawn.error().message;
        StagedFrame frame{std::move(drawn).value(), host.output.read(), host.inPlace.read(), {}};
        if (host.blurOfC)
            frame.byC = host.byC.read();
        return frame;
    }

    void giveTriangle() {
        shutter.response.shape = scene::ResponseShape::Triangle;
        host.responseForC = triangleResponse();
    }

    /// With each frame of the host's.
    void declareMotion(MotionDescriber& describer) {
        host.describeMotion = [this,
                               &describer](const render::PictureContext& context, auto& motion) {
            describer.declare(mScene.world, context, motion);
        };
    }

  private:
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mOwn;

    template <class FindBlur>
    BlurStage(
        gpu::Device& device,
        SceneBuilder& scene,
        const motion_blur::MotionBlurSettings& hosts,
        const motion_blur::MotionBlurSettings& plugins,
        const FindBlur& findBlur
    )
        : renderer(device, scene.world.assets), blur(findBlur(renderer)),
          host(device, *blur, hosts, kStageSize), mScene(scene),
          mPlugin(device, renderer.scene(), plugins), mFeatures(device, renderer.scene()) {
        shutter.exposureSeconds = 0.5;
        request.view.camera = scene.camera;
        request.view.width = kStageSize.x;
        request.view.height = kStageSize.y;
    }

  public:
    render::Renderer renderer;
    motion_blur::EmbeddedMotionBlur* blur;
    HostOfTheGBuffer host;
    scene::CameraShutter shutter;
    render::FrameRequest request;
    double seconds = 0.0; ///< of the frame
    double frameSeconds = scene::kStillFrameSeconds;

  private:
    [[nodiscard]] render::FrameRequest makeRequest() const {
        render::FrameRequest made = request;
        made.view.exposure = scene::computeExposure(shutter, seconds, frameSeconds);
        return made;
    }

    SceneBuilder& mScene;
    motion_blur::MotionBlurPlugin mPlugin;
    game::PictureFeatures mFeatures;
    std::vector<render::Effect*> mEffects{&host, &mPlugin};
};

/// Stages whose blurs of either interface the tests of a suite share.
class StagedTest : public EmbeddedTest {
  protected:
    static void TearDownTestSuite() {
        sBlurOfC.reset();
        EmbeddedTest::TearDownTestSuite();
    }

    static ShutterBlur* blurOfC() {
        if (!sBlurOfC)
            sBlurOfC.emplace(device());
        return sBlurOfC->blur;
    }

  private:
    static inline std::optional<BlurOfC> sBlurOfC;
};

/// The host's pictures by both interfaces and in place are the plugin's, bit for bit.
inline void expectSame(const StagedFrame& drawn) {
    EXPECT_TRUE(sameBits(drawn.output, drawn.result.color));
    EXPECT_TRUE(sameBits(drawn.inPlace, drawn.result.color));
    if (drawn.byC.width > 0) {
        EXPECT_TRUE(sameBits(drawn.byC, drawn.result.color));
    }
}

/// Two movers that cross before a wall; the nearer one spins as it goes.
inline void buildMovers(SceneBuilder& scene) {
    scene.setPerspective(1.0);
    const auto wall = scene.addTextured(scene.addWaveTexture(), true);
    const auto front = scene.addTextured(scene.addWaveTexture(32), true);
    scene.add(
        makeQuad(1.2, 1.2, front), {.position = {0.2, 0.1, -3.0}, .velocity = {1.0, 0.2, 0.0}}
    );
    scene.add(
        makeBox(math::dvec3(0.8), front),
        {.position = {-1.0, -0.4, -4.0}, .velocity = {-0.2, 0.0, 0.0}, .angularVelocity = {0, 0, 1}}
    );
    scene.add(makeQuad(12.0, 8.0, wall), {.position = {0.0, 0.0, -6.0}});
}

} // namespace shutter::test
