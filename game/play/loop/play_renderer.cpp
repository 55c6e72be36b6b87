// SPDX-License-Identifier: MIT
#include "game/play/loop/play_renderer.h"

#include "engine/math/statistics.h"
#include "engine/scene/lens.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace shutter::game {

namespace {

constexpr uint32_t kFramesInFlight = 2;

} // namespace

PlayRenderer::PlayRenderer(gpu::Device& device, const scene::Assets& assets)
    : mRenderer(device, assets, kFramesInFlight), mEffects(device), mLeftView(device),
      mRightView(device), mKept(device), mWindow(device), mDrawer(device, mRenderer) {}

void PlayRenderer::OtherTimes::add(const render::FrameStatistics& statistics) {
    double sum = 0.0;
    for (const render::PassTime& pass : statistics.passes)
        sum += pass.gpuMilliseconds;
    const auto blur = statistics.measures.find("blur ms");
    if (blur != statistics.measures.end())
        sum -= blur->second;
    if (std::isfinite(sum))
        milliseconds[count++ % milliseconds.size()] = std::max(sum, 0.0);
}

double PlayRenderer::OtherTimes::find() const {
    const std::span known(milliseconds.data(), std::min(count, milliseconds.size()));
    return known.empty() ? 0.0 : math::computeQuartiles({known.begin(), known.end()}).median;
}

void PlayRenderer::takeFinished() {
    while (std::optional<FinishedPicture> finished = mDrawer.takeFinished()) {
        mOtherTimes[finished->slot].add(finished->result.statistics);
        mShown[finished->slot] = std::move(finished->result.statistics);
        if (finished->result.display.width > 0)
            mPictures.push_back(std::move(finished->result.display));
    }
}

void PlayRenderer::finishAll() {
    mDrawer.finishUntil(0);
    takeFinished();
}

void PlayRenderer::makeRoom(const PlaySettings& settings) {
    // Methods and settings that draw many frames require to be the only ones in flight.
    const bool isAlone = settings.split || std::isfinite(settings.shutter.maxBlurPercent);
    mDrawer.finishUntil(isAlone ? 0 : mRenderer.framesInFlight() - 1);
    takeFinished();
}

const render::FrameStatistics* PlayRenderer::statistics(PlaySide side) const {
    const auto& shown = mShown[static_cast<size_t>(side)];
    return shown ? &*shown : nullptr;
}

std::optional<image::Image> PlayRenderer::takePicture() {
    if (mPictures.empty())
        return std::nullopt;
    image::Image picture = std::move(mPictures.front());
    mPictures.pop_front();
    return picture;
}

core::Result<PictureRequest> PlayRenderer::makeRequest(
    const scene::World& world,
    PlaySide side,
    const render::FrameRequest& frame,
    motion_blur::UntilReady untilReady,
    const PlaySettings& settings
) {
    const auto method = findMethod(side == PlaySide::Left ? settings.leftMethod : settings.method);
    if (!method)
        return method.error();
    PictureRequest request;
    request.drawsFramesBefore = false; // a window draws frames in their order
    request.frame = frame;
    request.frame.view.usesLens =
        method.value()->hasLens && scene::hasLens(world, frame.view.camera);
    request.slot = static_cast<uint32_t>(side);
    request.untilReady = untilReady;
    request.method.method = method.value();
    request.method.budget = computeBudget(settings, mOtherTimes[static_cast<size_t>(side)].find());
    request.antiAliasing = settings.picture.antiAliasing;
    request.features = settings.picture.features;
    if (method.value()->family == MethodFamily::MotionBlur)
        request.method.motionBlur = makeBlurSettings(settings, *method.value());
    else
        request.method.samples =
            method.value()->family == MethodFamily::Truth ? settings.rays : settings.instants;
    return request;
}

core::Status PlayRenderer::draw(
    const scene::World& world, const PlayPicture& picture, const PlaySettings& settings
) {
    render::FrameRequest frame;
    frame.view = picture.view;
    frame.wantColor = false;
    frame.showsDisplay = true;
    frame.wantReasons = frame.wantCounters = picture.wantReasons;
    if (!settings.view.empty())
        frame.shownIntermediates = debug_view::listSources(settings.view);
    mEffects.configure(settings.picture);
    frame.wantBrightest = mEffects.needsBrightest();
    // Both sides of a split share the view, so one measurement serves.
    const auto cap = mDrawer.measureCap(world, frame.view);
    if (!cap)
        return cap.error();
    app::WindowTarget window = picture.window;
    if (settings.split) {
        auto left = makeRequest(world, PlaySide::Left, frame, picture.untilReady, settings);
        if (!left)
            return left.error();
        mLeftView.setView(settings.view);
        left.value().cap = cap.value();
        left.value().ending = mEffects.listWith({&mLeftView, &mKept});
        SHUTTER_TRY(mDrawer.submit(world, left.value()));
        window.left = mKept.image();
        window.dividerShare = settings.dividerShare;
    }
    frame.wantDisplay = picture.readBack;
    auto right = makeRequest(world, PlaySide::Right, frame, picture.untilReady, settings);
    if (!right)
        return right.error();
    if (picture.moreRays) {
        right.value().raysBefore = picture.moreRays->before;
        right.value().method.samples = picture.moreRays->added;
    }
    mRightView.setView(settings.view);
    mWindow.setTarget(window);
    right.value().cap = cap.value();
    right.value().ending = mEffects.listWith({&mRightView, &mWindow});
    core::Status drawn = mDrawer.submit(world, right.value());
    takeFinished();
    return drawn;
}

} // namespace shutter::game
