// SPDX-License-Identifier: MIT
#include "game/shot/method_renderer.h"

#include "engine/render/frame_statistics.h"

#include <algorithm>
#include <array>

namespace shutter::game {

namespace {

core::Status checkSize(const gpu::Device& device, const RenderOptions& options) {
    const uint32_t longest = device.limits().maxImageDimension2D;
    if (options.width > longest || options.height > longest)
        return core::makeError(
            "--size {}x{}: {} draws at most {} pixels a side",
            options.width,
            options.height,
            device.info().name,
            longest
        );
    const uint64_t bytesPerPixel =
        options.method->blur ? options.method->blur->listBytesPerPixel : 0;
    const uint64_t listBytes = uint64_t(options.width) * options.height * bytesPerPixel + 16;
    if (listBytes > device.limits().maxStorageBufferRange)
        return core::makeError(
            "--size {}x{}: method {} needs a buffer of {} MiB, {} has at most {}",
            options.width,
            options.height,
            options.method->name,
            listBytes >> 20,
            device.info().name,
            device.limits().maxStorageBufferRange >> 20
        );
    return {};
}

core::Status checkRays(const gpu::Device& device, const MethodInfo& method) {
    if (canRun(method, device))
        return {};
    if (device.hasRays())
        return core::makeError(
            "--method {} nests ray queries (VK_KHR_ray_query), which {} lacks or --rays hides; "
            "hybrid and accumulate do without",
            method.name,
            device.info().name
        );
    return core::makeError(
        "--method {} needs ray tracing (VK_KHR_ray_query or, for hybrid, "
        "VK_KHR_ray_tracing_pipeline), which {} lacks or --rays hides; gather does without",
        method.name,
        device.info().name
    );
}

truth::PixelModel pixelModel(const RenderOptions& options) {
    return options.pixel == accumulate::PixelModel::Box ? truth::PixelModel::Box
                                                        : truth::PixelModel::Centre;
}

/// With fewer rays a mover that few of them met yet looks like none.
constexpr uint32_t kLeastRaysToStop = 16;

} // namespace

core::Result<std::unique_ptr<MethodRenderer>> MethodRenderer::create(
    gpu::Device& device, render::Renderer& renderer, const Shot& shot, const RenderOptions& options
) {
    if (core::Status traced = checkRays(device, *options.method); !traced)
        return traced.error();
    if (core::Status fits = checkSize(device, options); !fits)
        return fits.error();
    return std::unique_ptr<MethodRenderer>(new MethodRenderer(device, renderer, shot, options));
}

MethodRenderer::MethodRenderer(
    gpu::Device& device, render::Renderer& renderer, const Shot& shot, const RenderOptions& options
)
    : mShot(shot), mOptions(options), mRenderer(renderer), mTonemap(device, options.tonemap) {
    if (options.method->family == MethodFamily::MotionBlur)
        mMotionBlur = std::make_unique<motion_blur::MotionBlurPlugin>(
            device, mRenderer.scene(), options.motionBlur, options.budget
        );
    if (options.method->family == MethodFamily::Accumulate)
        mAccumulate = std::make_unique<accumulate::Accumulate>(device);
    if (options.method->family == MethodFamily::Truth)
        mTruth = std::make_unique<truth::Truth>(
            device, mRenderer.scene(), truth::TruthSettings{pixelModel(options), options.seed}
        );
}

uint32_t MethodRenderer::stepsPerPicture() const {
    return mAccumulate || mTruth ? mOptions.samples : 1;
}

core::Result<render::FrameResult> MethodRenderer::renderPicture(
    double seconds, const std::function<void()>& onStep, const Checkpoints& checkpoints
) {
    render::FrameRequest request;
    request.view = makeView(mShot, mOptions, seconds);
    auto cap = mRenderer.measureMotionCap(mShot.world, request.view);
    if (!cap)
        return cap.error();
    request.view.exposure.cap = std::move(cap).value();
    request.intermediates = mOptions.aovs;
    request.wantColor = !mOptions.displayOut;
    request.wantDisplay = mOptions.displayOut;
    request.wantDump = mOptions.dumpGraph;
    request.wantReasons = mOptions.explain;
    if (mAccumulate)
        return renderAccumulated(request, onStep);
    if (mTruth)
        return renderTruth(request, onStep, checkpoints);
    std::vector<render::PostEffect*> effects;
    if (mMotionBlur)
        effects.push_back(mMotionBlur.get());
    effects.push_back(&mTonemap);
    auto result = mRenderer.renderFrame(mShot.world, request, effects);
    onStep();
    return result;
}

core::Result<render::FrameResult> MethodRenderer::renderAccumulated(
    const render::FrameRequest& request, const std::function<void()>& onStep
) {
    const std::array<render::PostEffect*, 2> effects{mAccumulate.get(), &mTonemap};
    const uint32_t count = mOptions.samples;
    render::FrameStatistics total;
    for (uint32_t i = 0; i < count; ++i) {
        const bool last = i + 1 == count;
        render::FrameRequest instant = request;
        instant.view =
            accumulate::makeInstant(request.view, i, count, mOptions.pixel, mOptions.seed);
        instant.wantColor = last && request.wantColor;
        instant.wantDisplay = last && request.wantDisplay;
        // Intermediates are the raster instant's, not an average: drawn below.
        instant.intermediates.clear();
        mAccumulate->setInstant(i, count);
        auto result = mRenderer.renderFrame(mShot.world, instant, effects);
        if (!result)
            return result;
        render::addStatistics(total, result.value().statistics);
        onStep();
        if (!last)
            continue;
        result.value().statistics = std::move(total);
        if (!request.intermediates.empty()) {
            render::FrameRequest raster = request;
            raster.wantColor = raster.wantDisplay = false;
            auto views = mRenderer.renderFrame(mShot.world, raster, {});
            if (!views)
                return views;
            result.value().intermediates = std::move(views.value().intermediates);
        }
        return result;
    }
    return core::makeError("--samples 0: accumulate needs at least one instant");
}

bool MethodRenderer::isGoodEnough(uint32_t rays) const {
    const std::optional<double> error = mTruth->standardError();
    return mOptions.error && error && rays >= kLeastRaysToStop && *error <= *mOptions.error;
}

core::Result<render::FrameResult> MethodRenderer::renderTruth(
    const render::FrameRequest& request,
    const std::function<void()>& onStep,
    const Checkpoints& checkpoints
) {
    const std::array<render::PostEffect*, 2> effects{mTruth.get(), &mTonemap};
    const uint32_t rays = mOptions.samples;
    const auto isStop = [&](uint32_t count) {
        const auto& stops = checkpoints.rays;
        return std::find(stops.begin(), stops.end(), count) != stops.end();
    };
    render::FrameStatistics total;
    uint32_t done = 0;
    // One frame; what is wanted of it is read back only where it will be used.
    const auto draw = [&](uint32_t count, bool show, bool last) {
        render::FrameRequest batch = request;
        batch.view.lodBias += truth::computeLodBias(pixelModel(mOptions), rays);
        batch.wantColor = show && request.wantColor;
        batch.wantDisplay = show && request.wantDisplay;
        if (!last)
            batch.intermediates.clear();
        mTruth->setBatch(done, count);
        auto result = mRenderer.renderFrame(mShot.world, batch, effects);
        if (!result)
            return result;
        done += count;
        render::addStatistics(total, result.value().statistics);
        result.value().statistics = total;
        return result;
    };
    const uint64_t pixels = uint64_t(request.view.width) * request.view.height;
    for (const uint32_t count : truth::planBatches(pixels, rays, checkpoints.rays)) {
        const bool stop = isStop(done + count);
        auto result = draw(count, stop || done + count == rays, done + count == rays);
        if (!result)
            return result;
        for (uint32_t i = 0; i < count; ++i)
            onStep();
        if (stop)
            checkpoints.onPicture(done, result.value());
        if (done == rays)
            return result;
        if (isGoodEnough(done))
            break;
    }
    for (uint32_t i = done; i < rays; ++i)
        onStep();
    return draw(0, true, true); // the mean so far once more, now to be shown
}

} // namespace shutter::game
