// SPDX-License-Identifier: MIT
#include "tests/support/stage.h"

#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/tonemap/tonemap.h"
#include "modules/truth/truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace shutter::test {

namespace {

render::FrameRequest makeRequest(const SceneBuilder& scene, const Shot& shot) {
    render::FrameRequest request;
    request.view.camera = scene.camera;
    scene::CameraShutter shutter = shot.shutter;
    shutter.exposureSeconds = shot.exposureSeconds;
    shutter.phase = shot.phase;
    request.view.exposure = scene::computeExposure(shutter, shot.seconds, shot.frameSeconds);
    request.view.instant = shot.instant;
    request.view.width = shot.width;
    request.view.height = shot.height;
    request.view.background = shot.background;
    request.view.ambient = shot.ambient;
    request.intermediates = shot.aovs;
    request.wantDisplay = shot.wantDisplay;
    return request;
}

render::FrameResult unwrap(core::Result<render::FrameResult> result) {
    if (result)
        return std::move(result).value();
    ADD_FAILURE() << result.error().message;
    return {};
}

} // namespace

std::vector<std::string_view> listBlurMethods(const gpu::Device& device) {
    std::vector<std::string_view> names;
    for (const motion_blur::Method* method : motion_blur::listMethods()) {
        const bool isAble = method->rays == motion_blur::RayNeed::None ||
                            (method->rays == motion_blur::RayNeed::Any && device.hasRays()) ||
                            device.hasRayQuery();
        if (isAble && method->blursObjects)
            names.emplace_back(method->name);
    }
    return names;
}

std::vector<std::string_view> listRasterMethods(const gpu::Device& device) {
    std::vector<std::string_view> names{"sharp", "accumulate"};
    for (const std::string_view name : listBlurMethods(device))
        if (motion_blur::getMethod(name).readsRaster)
            names.push_back(name);
    return names;
}

Stage::Stage(gpu::Device& device, const SceneBuilder& scene)
    : mDevice(device), mScene(scene), mRenderer(device, scene.world.assets) {}

render::FrameResult Stage::render(const Shot& shot) {
    render::FrameRequest request = makeRequest(mScene, shot);
    auto cap = mRenderer.measureMotionCap(mScene.world, request.view);
    if (!cap) {
        ADD_FAILURE() << cap.error().message;
        return {};
    }
    request.view.exposure.cap = std::move(cap).value();
    if (shot.method == "accumulate")
        return renderAccumulated(shot, request);
    if (shot.method == "truth")
        return renderTruth(shot, request);
    motion_blur::MotionBlurSettings settings = shot.settings;
    if (const motion_blur::Method* method = motion_blur::findMethod(shot.method))
        settings.method = method;
    else
        EXPECT_EQ(shot.method, "sharp") << "there is no such method";
    const core::Status valid = motion_blur::validate(settings);
    if (!valid) {
        ADD_FAILURE() << valid.error().message;
        return {};
    }
    motion_blur::MotionBlurPlugin blur(mDevice, mRenderer.scene(), settings);
    tonemap::Tonemap tonemap(mDevice, {});
    std::vector<render::PostEffect*> effects;
    if (shot.method != "sharp")
        effects.push_back(&blur);
    effects.push_back(&tonemap);
    if (shot.last)
        effects.push_back(shot.last);
    return unwrap(mRenderer.renderFrame(mScene.world, request, effects));
}

render::FrameResult
Stage::renderAccumulated(const Shot& shot, const render::FrameRequest& request) {
    accumulate::Accumulate sum(mDevice);
    tonemap::Tonemap tonemap(mDevice, {});
    const std::vector<render::PostEffect*> effects{&sum, &tonemap};
    render::FrameResult result;
    for (uint32_t i = 0; i < shot.instants; ++i) {
        const bool last = i + 1 == shot.instants;
        render::FrameRequest instant = request;
        instant.view = accumulate::makeInstant(request.view, i, shot.instants, shot.pixel, 0);
        instant.wantColor = last;
        instant.wantDisplay = last && shot.wantDisplay;
        sum.setInstant(i, shot.instants);
        result = unwrap(mRenderer.renderFrame(mScene.world, instant, effects));
    }
    return result;
}

render::FrameResult Stage::renderTruth(const Shot& shot, const render::FrameRequest& request) {
    truth::Truth rays(mDevice, mRenderer.scene(), {shot.pixel, shot.seed});
    tonemap::Tonemap tonemap(mDevice, {});
    const std::vector<render::PostEffect*> effects{&rays, &tonemap};
    render::FrameRequest batch = request;
    batch.view.lodBias += truth::computeLodBias(shot.pixel, shot.instants);
    const uint32_t longest = shot.batch > 0 ? shot.batch : shot.instants;
    render::FrameResult result;
    for (uint32_t done = 0; done < shot.instants;) {
        const uint32_t count = std::min(longest, shot.instants - done);
        rays.setBatch(done, count);
        result = unwrap(mRenderer.renderFrame(mScene.world, batch, effects));
        done += count;
    }
    return result;
}

render::FrameResult renderOnce(gpu::Device& device, const SceneBuilder& scene, const Shot& shot) {
    return Stage(device, scene).render(shot);
}

std::string describeMotionBlur(const render::FrameResult& result) {
    const core::Decision* decision =
        render::findDecision(result.statistics.explanations, "motion blur");
    return decision ? core::describe(*decision) : "not asked";
}

} // namespace shutter::test
