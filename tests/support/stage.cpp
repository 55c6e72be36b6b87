// SPDX-License-Identifier: MIT
#include "tests/support/stage.h"

#include "engine/image/metrics.h"
#include "engine/scene/lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
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

/// Error: there is no such method, or its settings are invalid.
core::Result<game::PictureRequest> makePicture(const SceneBuilder& scene, const Shot& shot) {
    const auto method = game::findMethod(shot.method);
    if (!method)
        return method.error();
    const game::MethodFamily family = method.value()->family;
    game::PictureRequest picture;
    picture.frame = makeRequest(scene, shot);
    picture.frame.view.usesLens =
        method.value()->hasLens && scene::hasLens(scene.world, scene.camera);
    picture.method.method = method.value();
    picture.method.samples = shot.instants;
    picture.method.maxStepPx = shot.maxStepPx;
    picture.method.motionBlur = shot.settings;
    if (family == game::MethodFamily::MotionBlur)
        picture.method.motionBlur.method = method.value()->blur;
    if (core::Status valid = motion_blur::validate(picture.method.motionBlur); !valid)
        return valid.error();
    picture.features.shadows = shot.shadows;
    picture.pixel = shot.pixel;
    picture.seed = family == game::MethodFamily::Truth ? shot.seed : 0;
    picture.raysPerFrame = shot.batch > 0 ? shot.batch : shot.instants;
    return picture;
}

} // namespace

std::vector<std::string_view> listBlurMethods(const gpu::Device& device) {
    std::vector<std::string_view> names;
    for (const game::MethodInfo& method : game::listMethods())
        if (method.blur && method.blur->blursObjects && game::canRun(method, device))
            names.emplace_back(method.name);
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
    const auto picture = makePicture(mScene, shot);
    if (!picture) {
        ADD_FAILURE() << picture.error().message;
        return {};
    }
    tonemap::Tonemap tonemap(mDevice, {});
    game::PictureRequest request = picture.value();
    request.ending.push_back(&tonemap);
    if (shot.last)
        request.ending.push_back(shot.last);
    // A drawer for each picture: no effect keeps anything of an earlier one.
    auto drawn = game::PictureDrawer(mDevice, mRenderer).draw(mScene.world, request);
    if (drawn)
        return std::move(drawn).value();
    ADD_FAILURE() << drawn.error().message;
    return {};
}

render::FrameResult renderOnce(gpu::Device& device, const SceneBuilder& scene, const Shot& shot) {
    return Stage(device, scene).render(shot);
}

Frames::Frames(
    gpu::Device& device, const SceneBuilder& scene, const motion_blur::BlurBudget& budget
)
    : mDevice(device), mScene(scene), mBudget(budget), mRenderer(device, scene.world.assets),
      mDrawer(device, mRenderer) {}

render::FrameResult
Frames::draw(const Shot& shot, const std::function<void(game::PictureRequest&)>& change) {
    auto picture = makePicture(mScene, shot);
    if (!picture) {
        ADD_FAILURE() << picture.error().message;
        return {};
    }
    game::PictureRequest& request = picture.value();
    request.method.budget = mBudget;
    request.frame.wantReasons = request.frame.wantDump = true;
    request.drawsFramesBefore = false;
    if (shot.wantDisplay && !mTonemap)
        mTonemap.emplace(mDevice, tonemap::TonemapSettings{});
    if (shot.wantDisplay)
        request.ending.push_back(&*mTonemap);
    if (change)
        change(request);
    auto drawn = mDrawer.draw(mScene.world, request);
    if (drawn)
        return std::move(drawn).value();
    ADD_FAILURE() << drawn.error().message;
    return {};
}

void expectTruthsAgree(Stage& stage, Shot shot, double mostSharp) {
    shot.instants = 256;
    const auto draw = [&](std::string_view method) {
        shot.method = method;
        return stage.render(shot).color;
    };
    const image::Image rays = draw("truth");
    EXPECT_GE(image::computePsnr(rays, draw("accumulate")), 45.0);
    EXPECT_LE(image::computePsnr(rays, draw("sharp")), mostSharp) << "nothing is blurred";
}

size_t countPasses(const render::FrameResult& frame, std::string_view part) {
    const auto& passes = frame.statistics.passes;
    return size_t(std::count_if(passes.begin(), passes.end(), [&](const gpu::PassTime& pass) {
        return pass.name.find(part) != std::string::npos;
    }));
}

bool hasPass(const render::FrameResult& frame, std::string_view name) {
    const auto& passes = frame.statistics.passes;
    return std::any_of(passes.begin(), passes.end(), [&](const gpu::PassTime& pass) {
        return pass.name == name;
    });
}

std::string describeMotionBlur(const render::FrameResult& result) {
    const core::Decision* decision =
        render::findDecision(result.statistics.explanations, "motion blur");
    return decision ? core::describe(*decision) : "not requested";
}

} // namespace shutter::test
