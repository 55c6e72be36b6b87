// SPDX-License-Identifier: MIT
#include "game/shot/picture_drawer.h"

#include "engine/core/check.h"
#include "engine/core/log.h"
#include "engine/scene/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace shutter::game {

namespace {

/// With fewer rays, a mover hit by few of them would be missed.
constexpr uint32_t kMinRaysToStop = 16;

} // namespace

MethodOptions
makeMethod(const MethodInfo& method, const motion_blur::MotionBlurSettings& settings) {
    MethodOptions options;
    options.method = &method;
    options.samples = method.defaultSamples;
    if (!method.blur)
        return options;
    options.motionBlur = settings;
    options.motionBlur.method = method.blur;
    options.motionBlur = motion_blur::complete(options.motionBlur);
    options.samples = options.motionBlur.sampleCount;
    return options;
}

bool isSampledAnyway(const MethodInfo& method) {
    switch (method.family) {
    case MethodFamily::Sharp:
        return false;
    case MethodFamily::MotionBlur:
        return !method.blur->readsRaster;
    case MethodFamily::Accumulate:
    case MethodFamily::Truth:
        break;
    }
    return true;
}

std::set<std::string> listIntermediates(const MethodInfo& method) {
    std::set<std::string> names = {"motion", "depth", "normal", "mesh_id"};
    names.insert(method.aovs.begin(), method.aovs.end());
    return names;
}

PictureRequest makePicture(
    const Shot& shot, const ShotOptions& options, const MethodOptions& method, double seconds
) {
    PictureRequest picture;
    picture.frame.view = makeView(shot, options, seconds);
    const bool seesLens =
        options.usesLens && method.method->hasLens && scene::hasLens(shot.world, shot.camera);
    // A filter needs a pinhole's picture.
    picture.filtersLens = seesLens && method.method->lensFilter != nullptr;
    picture.frame.view.usesLens = seesLens && !picture.filtersLens;
    picture.method = method;
    picture.features = options.picture.features;
    picture.pixel = options.pixel;
    picture.seed = options.seed;
    picture.antiAliasing = options.picture.antiAliasing;
    return picture;
}

PictureDrawer::PictureDrawer(gpu::Device& device, render::Renderer& renderer)
    : mDevice(device), mRenderer(renderer), mMeasures(device, renderer),
      mFeatures(device, renderer.scene()) {}

PictureDrawer::~PictureDrawer() {
    try {
        finishUntil(0);
    } catch (const gpu::DeviceError& error) {
        // The pending error, if any, already reports the lost device.
        if (std::uncaught_exceptions() == 0)
            core::logWarning("{}", error.what());
    }
}

uint32_t PictureDrawer::countSteps(const MethodOptions& method, AntiAliasing antiAliasing) {
    const MethodFamily family = method.method->family;
    if (method.maxStepPx)
        return 1;
    if (family == MethodFamily::Accumulate || family == MethodFamily::Truth)
        return method.samples;
    return antiAliasing == AntiAliasing::Box && !isSampledAnyway(*method.method) ? kBoxFrames : 1;
}

std::vector<uint32_t>
PictureDrawer::planParts(const PictureRequest& request, const std::vector<uint32_t>& stops) const {
    const uint32_t total = countSteps(request.method, request.antiAliasing);
    if (request.method.method->family != MethodFamily::Truth)
        return std::vector<uint32_t>(total, 1);
    if (request.raysPerFrame == 0) {
        const extract::ViewRequest& view = request.frame.view;
        return truth::planBatches(uint64_t(view.width) * view.height, total, stops);
    }
    std::vector<uint32_t> counts(total / request.raysPerFrame, request.raysPerFrame);
    if (const uint32_t rest = total % request.raysPerFrame; rest > 0)
        counts.push_back(rest);
    return counts;
}

core::Status PictureDrawer::submit(const scene::World& world, const PictureRequest& wanted) {
    const auto prepared = prepare(world, wanted);
    if (!prepared)
        return prepared.error();
    const PictureRequest& request = prepared.value();
    SHUTTER_TRY(submitFramesBefore(world, request));
    Part part{
        .done = request.raysBefore,
        .total = request.raysBefore + countSteps(request.method, request.antiAliasing)};
    std::vector<uint32_t> counts = planParts(request, {});
    if (counts.empty())
        counts = {0}; // the mean of those before is shown once more
    for (const uint32_t count : counts) {
        part.count = count;
        part.isShown = part.done + count == part.total;
        SHUTTER_TRY(submitPart(world, request, part));
        part.done += count;
    }
    return submitIntermediates(world, request);
}

core::Result<render::FrameResult> PictureDrawer::draw(
    const scene::World& world,
    const PictureRequest& wanted,
    const std::function<void()>& onStep,
    const Checkpoints& checkpoints
) {
    SHUTTER_CHECK(mLabels.empty() && mFinished.empty(), "a picture was submitted and not taken");
    const auto prepared = prepare(world, wanted);
    if (!prepared)
        return prepared.error();
    const PictureRequest& request = prepared.value();
    const auto step = [&] {
        if (onStep)
            onStep();
    };
    if (request.method.method->family == MethodFamily::Truth)
        return drawTruth(world, request, step, checkpoints);
    SHUTTER_TRY(submitFramesBefore(world, request));
    finishUntil(0); // else its time would be counted with the frame's
    Part part{.total = countSteps(request.method, request.antiAliasing)};
    for (; part.done < part.total; ++part.done) {
        part.isShown = part.done + 1 == part.total;
        SHUTTER_TRY(submitPart(world, request, part));
        finishUntil(0);
        if (!request.instants || part.isShown)
            step();
    }
    SHUTTER_TRY(submitIntermediates(world, request));
    render::FrameResult result = takeOnly();
    if (request.instants) {
        result.statistics.counters["instants"] = request.instants->count;
        result.statistics.explanations.push_back(
            {render::ExplainedKind::Work,
             "instants",
             {true,
              fmt::format("{} of them: {}", request.instants->count, request.instants->reason)}}
        );
    }
    return result;
}

core::Result<render::FrameResult> PictureDrawer::drawTruth(
    const scene::World& world,
    const PictureRequest& request,
    const std::function<void()>& onStep,
    const Checkpoints& checkpoints
) {
    const auto isStop = [&](uint32_t count) {
        const auto& stops = checkpoints.rays;
        return std::find(stops.begin(), stops.end(), count) != stops.end();
    };
    Part part{.total = request.method.samples};
    for (const uint32_t count : planParts(request, checkpoints.rays)) {
        part.count = count;
        const uint32_t done = part.done + count;
        part.isShown = isStop(done) || done == part.total;
        SHUTTER_TRY(submitPart(world, request, part));
        finishUntil(0);
        part.done = done;
        for (uint32_t i = 0; i < count; ++i)
            onStep();
        if (isStop(done))
            checkpoints.onPicture(
                done, done == part.total ? mFinished.front().result : mSlots[request.slot].result
            );
        if (done == part.total)
            return takeOnly();
        if (isGoodEnough(request, done))
            break;
    }
    for (uint32_t i = part.done; i < part.total; ++i)
        onStep();
    // The mean so far once more, now to be shown.
    const Part shown{.done = part.done, .count = 0, .total = part.done};
    PictureRequest ended = request;
    ended.frame.view.lodBias += truth::computeLodBias(request.pixel, part.total) -
                                truth::computeLodBias(request.pixel, part.done);
    SHUTTER_TRY(submitPart(world, ended, shown));
    return takeOnly();
}

bool PictureDrawer::isGoodEnough(const PictureRequest& request, uint32_t rays) const {
    const std::optional<double> error = mSlots[request.slot].truth->standardError();
    return request.method.error && error && rays >= kMinRaysToStop &&
           *error <= *request.method.error;
}

void PictureDrawer::finishOldest() {
    const Label label = mLabels.front();
    mLabels.pop_front();
    render::FrameResult drawn = mRenderer.finishFrame();
    keepTrace(mSlots[label.slot], std::move(drawn.trace));
    if (label.isBefore)
        return;
    render::FrameResult& result = mSlots[label.slot].result;
    if (label.isFirst)
        result = {};
    if (label.isIntermediates) {
        result.intermediates = std::move(drawn.intermediates);
    } else {
        render::FrameStatistics total = std::move(result.statistics);
        if (label.isFirst)
            total = std::move(drawn.statistics);
        else
            render::addStatistics(total, drawn.statistics);
        if (label.isShown)
            result = std::move(drawn);
        result.statistics = std::move(total);
    }
    if (!label.isLast)
        return;
    explainParts(result.statistics, label.exposureParts);
    result.trace = std::exchange(mSlots[label.slot].trace, {});
    mSlots[label.slot].tracedFrames = 0;
    const render::Measures& measures = result.statistics.measures;
    const auto brightest = measures.find(render::kBrightest);
    mSlots[label.slot].brightest.reset();
    if (brightest != measures.end())
        mSlots[label.slot].brightest = float(brightest->second);
    mFinished.push_back({label.slot, std::move(result)});
}

void PictureDrawer::explainParts(render::FrameStatistics& statistics, size_t parts) {
    if (parts == 0)
        return;
    statistics.counters["exposure parts"] = parts;
    statistics.explanations.push_back(
        {render::ExplainedKind::Work,
         "exposure parts",
         {true, fmt::format("{} without what jumps in the picture", parts)}}
    );
}

void PictureDrawer::keepTrace(Slot& slot, std::vector<render::WrittenImage> written) {
    if (written.empty())
        return;
    for (render::WrittenImage& image : written) {
        image.frame = slot.tracedFrames;
        slot.trace.push_back(std::move(image));
    }
    ++slot.tracedFrames;
}

void PictureDrawer::finishUntil(size_t most) {
    while (mLabels.size() > most)
        finishOldest();
}

std::optional<FinishedPicture> PictureDrawer::takeFinished() {
    if (mFinished.empty())
        return std::nullopt;
    FinishedPicture finished = std::move(mFinished.front());
    mFinished.pop_front();
    return finished;
}

render::FrameResult PictureDrawer::takeOnly() {
    finishUntil(0);
    std::optional<FinishedPicture> finished = takeFinished();
    SHUTTER_CHECK(finished && mFinished.empty(), "one picture was drawn");
    return std::move(finished->result);
}

} // namespace shutter::game
