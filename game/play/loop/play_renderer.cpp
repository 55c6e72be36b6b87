// SPDX-License-Identifier: MIT
#include "game/play/loop/play_renderer.h"

#include "engine/core/log.h"
#include "engine/render/frame_statistics.h"

#include <cmath>
#include <utility>

namespace shutter::game {

namespace {

constexpr uint32_t kFramesInFlight = 2;

} // namespace

PlayRenderer::PlayRenderer(gpu::Device& device, const scene::Assets& assets)
    : mDevice(device), mRenderer(device, assets, kFramesInFlight), mTonemap(device, {}),
      mLeftView(device), mRightView(device), mKept(device), mWindow(device) {}

PlayRenderer::~PlayRenderer() {
    try {
        finishAll();
    } catch (const gpu::DeviceError& error) { // of a device that was lost before
        core::logWarning("{}", error.what());
    }
}

void PlayRenderer::finishOldest() {
    const Label label = mLabels.front();
    mLabels.pop_front();
    render::FrameResult result = mRenderer.finishFrame();
    SideEffects& side = effectsOf(label.side);
    if (label.isFirst)
        side.sum = {};
    render::addStatistics(side.sum, result.statistics);
    if (label.isLast)
        side.shown = side.sum;
    if (label.readBack)
        mPictures.push_back(std::move(result.display));
}

void PlayRenderer::finishAll() {
    while (mRenderer.unfinishedCount() > 0)
        finishOldest();
}

void PlayRenderer::makeRoom(const PlaySettings& settings) {
    // Methods and looks that draw many frames count on being alone.
    const bool isAlone = settings.split || std::isfinite(settings.shutter.maxBlurPercent);
    while (mRenderer.unfinishedCount() > (isAlone ? 0 : mRenderer.framesInFlight() - 1))
        finishOldest();
}

const render::FrameStatistics* PlayRenderer::statistics(PlaySide side) const {
    const auto& shown = mSides[static_cast<size_t>(side)].shown;
    return shown ? &*shown : nullptr;
}

std::optional<image::Image> PlayRenderer::takePicture() {
    if (mPictures.empty())
        return std::nullopt;
    image::Image picture = std::move(mPictures.front());
    mPictures.pop_front();
    return picture;
}

core::Status PlayRenderer::submit(
    const scene::World& world,
    const render::FrameRequest& request,
    const std::vector<render::PostEffect*>& effects,
    const Label& label
) {
    while (mRenderer.unfinishedCount() == mRenderer.framesInFlight())
        finishOldest();
    if (core::Status submitted = mRenderer.submitFrame(world, request, effects); !submitted)
        return submitted;
    mLabels.push_back(label);
    return {};
}

core::Status PlayRenderer::draw(
    const scene::World& world, const PlayPicture& picture, const PlaySettings& settings
) {
    render::FrameRequest request;
    request.view = picture.view;
    request.wantColor = false;
    request.showsDisplay = true;
    request.wantReasons = picture.wantReasons;
    if (!settings.view.empty())
        request.shownIntermediates = debug_view::listSources(settings.view);
    if (std::isfinite(settings.shutter.maxBlurPercent)) {
        finishAll();
        auto cap = mRenderer.measureMotionCap(world, request.view);
        if (!cap)
            return cap.error();
        request.view.exposure.cap = std::move(cap).value();
    }
    app::WindowTarget window = picture.window;
    if (settings.split) {
        auto left = findMethod(settings.leftMethod);
        if (!left)
            return left.error();
        SidePicture side{PlaySide::Left, left.value(), request, {&mTonemap}};
        mLeftView.setView(settings.view);
        side.ending.push_back(&mLeftView);
        side.ending.push_back(&mKept);
        if (core::Status drawn = drawSide(world, side, settings); !drawn)
            return drawn;
        window.left = mKept.image();
        window.dividerShare = settings.dividerShare;
    }
    auto right = findMethod(settings.method);
    if (!right)
        return right.error();
    request.semaphores = picture.semaphores;
    request.wantDisplay = picture.readBack;
    SidePicture side{PlaySide::Right, right.value(), request, {&mTonemap}};
    mRightView.setView(settings.view);
    mWindow.setTarget(window);
    side.ending.push_back(&mRightView);
    side.ending.push_back(&mWindow);
    return drawSide(world, side, settings);
}

core::Status PlayRenderer::drawSide(
    const scene::World& world, SidePicture& picture, const PlaySettings& settings
) {
    SideEffects& own = effectsOf(picture.side);
    switch (picture.method->family) {
    case MethodFamily::Accumulate:
        return drawInstants(world, picture, settings);
    case MethodFamily::Truth:
        return drawRays(world, picture, settings);
    case MethodFamily::MotionBlur: {
        const motion_blur::MotionBlurSettings blur = makeBlurSettings(settings, *picture.method);
        if (!own.blur)
            own.blur = std::make_unique<motion_blur::MotionBlurPlugin>(
                mDevice, mRenderer.scene(), blur, settings.budget
            );
        own.blur->configure(blur, settings.budget);
        picture.ending.insert(picture.ending.begin(), own.blur.get());
        break;
    }
    case MethodFamily::Sharp:
        break;
    }
    return submit(
        world,
        picture.request,
        picture.ending,
        {picture.side, true, true, picture.request.wantDisplay}
    );
}

core::Status PlayRenderer::submitPart(
    const scene::World& world,
    const SidePicture& picture,
    render::FrameRequest request,
    size_t index,
    size_t count
) {
    const bool last = index + 1 == count;
    if (!last) {
        request.showsDisplay = request.wantDisplay = false;
        request.semaphores = {};
        request.shownIntermediates.clear();
    }
    return submit(
        world,
        request,
        last ? picture.ending : std::vector{picture.ending.front()},
        {picture.side, index == 0, last, request.wantDisplay}
    );
}

core::Status PlayRenderer::drawInstants(
    const scene::World& world, SidePicture& picture, const PlaySettings& settings
) {
    SideEffects& own = effectsOf(picture.side);
    if (!own.accumulate)
        own.accumulate = std::make_unique<accumulate::Accumulate>(mDevice);
    picture.ending.insert(picture.ending.begin(), own.accumulate.get());
    const uint32_t count = settings.instants;
    for (uint32_t i = 0; i < count; ++i) {
        render::FrameRequest instant = picture.request;
        instant.view = accumulate::makeInstant(
            picture.request.view, i, count, accumulate::PixelModel::Centre, 0
        );
        own.accumulate->setInstant(i, count);
        if (core::Status drawn = submitPart(world, picture, instant, i, count); !drawn)
            return drawn;
    }
    return {};
}

core::Status PlayRenderer::drawRays(
    const scene::World& world, SidePicture& picture, const PlaySettings& settings
) {
    SideEffects& own = effectsOf(picture.side);
    if (!own.truth)
        own.truth = std::make_unique<truth::Truth>(
            mDevice, mRenderer.scene(), truth::TruthSettings{truth::PixelModel::Centre, 0}
        );
    picture.ending.insert(picture.ending.begin(), own.truth.get());
    const extract::ViewRequest& view = picture.request.view;
    const auto batches = truth::planBatches(uint64_t(view.width) * view.height, settings.rays, {});
    uint32_t done = 0;
    for (size_t i = 0; i < batches.size(); ++i) {
        finishAll(); // what it counts of a batch is read before the next
        own.truth->setBatch(done, batches[i]);
        done += batches[i];
        core::Status drawn = submitPart(world, picture, picture.request, i, batches.size());
        if (!drawn)
            return drawn;
    }
    finishAll();
    return {};
}

} // namespace shutter::game
