// SPDX-License-Identifier: MIT
#include "game/shot/picture_drawer.h"

#include "engine/core/check.h"
#include "engine/core/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace shutter::game {

namespace {

bool usesTaa(const PictureRequest& request) {
    return request.antiAliasing == AntiAliasing::Taa && !isSampledAnyway(*request.method.method);
}

bool isBox(const PictureRequest& request) {
    return request.antiAliasing == AntiAliasing::Box && !isSampledAnyway(*request.method.method);
}

/// Several sharp or blurred frames make the picture, whose mean it is.
bool isAverage(const PictureRequest& request) {
    return request.method.method->family == MethodFamily::Accumulate || isBox(request);
}

bool usesFrameBefore(const MethodOptions& method) {
    const motion_blur::MotionBlurSettings& settings = method.motionBlur;
    return method.method->family == MethodFamily::MotionBlur &&
           settings.method->readsInstantMotions && settings.history;
}

/// Whether `drawn` shows the frame before `view`'s.
bool isFrameBefore(const extract::ViewRequest& drawn, const extract::ViewRequest& view) {
    const double age = view.exposure.raster - drawn.exposure.raster;
    const double frame = view.exposure.frameSeconds;
    return drawn.camera == view.camera && drawn.width == view.width &&
           drawn.height == view.height && std::abs(age - frame) <= 1.0e-3 * frame;
}

/// With fewer rays a mover that few of them met yet looks like none.
constexpr uint32_t kLeastRaysToStop = 16;

} // namespace

MethodOptions
makeMethod(const MethodInfo& method, const motion_blur::MotionBlurSettings& settings) {
    MethodOptions options;
    options.method = &method;
    options.samples = method.defaultSamples;
    options.motionBlur = settings;
    if (!method.blur)
        return options;
    options.motionBlur.method = method.blur;
    options.motionBlur.sampleCount = options.samples;
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
    picture.method = method;
    picture.pixel = options.pixel;
    picture.seed = options.seed;
    picture.antiAliasing = options.antiAliasing;
    return picture;
}

PictureDrawer::PictureDrawer(gpu::Device& device, render::Renderer& renderer)
    : mDevice(device), mRenderer(renderer) {}

PictureDrawer::~PictureDrawer() {
    try {
        finishUntil(0);
    } catch (const gpu::DeviceError& error) {
        // The error on its way, if any, says already that the device was lost.
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

render::PostEffect* PictureDrawer::prepareEffect(const PictureRequest& request, const Part& part) {
    Slot& slot = mSlots[request.slot];
    switch (request.method.method->family) {
    case MethodFamily::Sharp:
        return nullptr;
    case MethodFamily::MotionBlur:
        if (!slot.motionBlur)
            slot.motionBlur = std::make_unique<motion_blur::MotionBlurPlugin>(
                mDevice, mRenderer.scene(), request.method.motionBlur, request.method.budget
            );
        slot.motionBlur->configure(
            request.method.motionBlur, request.method.budget, request.untilReady
        );
        return slot.motionBlur.get();
    case MethodFamily::Accumulate:
        return nullptr; // the mean is all it is
    case MethodFamily::Truth: {
        const truth::TruthSettings settings{request.pixel, request.seed};
        finishUntil(0); // what a batch counted is read before the next one
        if (!slot.truth || slot.truthSettings != settings)
            slot.truth = std::make_unique<truth::Truth>(mDevice, mRenderer.scene(), settings);
        slot.truthSettings = settings;
        slot.truth->setBatch(part.done, part.count);
        return slot.truth.get();
    }
    }
    SHUTTER_CHECK(false, "{} is of no family", request.method.method->name);
    return nullptr;
}

render::PostEffect* PictureDrawer::prepareTaa(const PictureRequest& request) {
    if (isSampledAnyway(*request.method.method) || isBox(request))
        return nullptr;
    Slot& slot = mSlots[request.slot];
    if (!slot.taa)
        slot.taa = std::make_unique<taa::Taa>(mDevice);
    slot.taa->setEnabled(usesTaa(request));
    return slot.taa.get();
}

std::vector<render::PostEffect*>
PictureDrawer::prepareEffects(const PictureRequest& request, const Part& part) {
    std::vector<render::PostEffect*> effects{prepareTaa(request), prepareEffect(request, part)};
    if (isAverage(request)) {
        Slot& slot = mSlots[request.slot];
        if (!slot.accumulate)
            slot.accumulate = std::make_unique<accumulate::Accumulate>(mDevice);
        slot.accumulate->setInstant(part.done, part.total);
        effects.push_back(slot.accumulate.get());
    }
    std::erase(effects, nullptr);
    return effects;
}

core::Status PictureDrawer::submitFrame(
    const scene::World& world,
    const render::FrameRequest& frame,
    const std::vector<render::PostEffect*>& effects,
    const Label& label
) {
    finishUntil(mRenderer.framesInFlight() - 1);
    SHUTTER_TRY(mRenderer.submitFrame(world, frame, effects));
    mLabels.push_back(label);
    return {};
}

core::Status PictureDrawer::submitPart(
    const scene::World& world, const PictureRequest& request, const Part& part
) {
    const MethodFamily family = request.method.method->family;
    const bool isLast = part.done + part.count == part.total;
    const bool hasMore = isAverage(request) && !request.frame.intermediates.empty();
    render::FrameRequest frame = request.frame;
    if (family == MethodFamily::Accumulate)
        frame.view = accumulate::makeInstant(
            request.frame.view, part.done, part.total, request.pixel, request.seed
        );
    else
        frame.view = placeInPixel(request, part);
    if (family == MethodFamily::Truth)
        frame.view.lodBias += truth::computeLodBias(request.pixel, part.total);
    if (frame.wantBrightest)
        frame.lastBrightest = mSlots[request.slot].brightest;
    if (!part.isShown)
        frame.wantColor = frame.wantDisplay = frame.showsDisplay = false;
    if (!isLast) {
        frame.shownIntermediates.clear();
        frame.wantDump = false;
    }
    // An instant's intermediates are not the picture's: submitIntermediates().
    if (!isLast || isAverage(request))
        frame.intermediates.clear();
    if (isBox(request) && request.drawsFramesBefore && usesFrameBefore(request.method)) {
        PictureRequest placed = request;
        placed.frame.view = frame.view;
        SHUTTER_TRY(submitFrameBefore(world, placed, 1));
    }
    std::vector<render::PostEffect*> effects = prepareEffects(request, part);
    if (part.isShown)
        effects.insert(effects.end(), request.ending.begin(), request.ending.end());
    const bool isFirst = part.done == request.raysBefore;
    return submitFrame(
        world, frame, effects, {request.slot, isFirst, part.isShown, isLast && !hasMore}
    );
}

extract::ViewRequest PictureDrawer::placeInPixel(const PictureRequest& request, const Part& part) {
    const extract::ViewRequest& view = request.frame.view;
    if (isBox(request))
        return accumulate::makeSubpixel(view, part.done, part.total, request.seed);
    if (!usesTaa(request))
        return view;
    const int64_t number = request.drawsFramesBefore ? scene::numberFrame(view.exposure)
                                                     : mSlots[request.slot].jitteredCount++;
    return taa::makeJittered(view, number);
}

core::Status
PictureDrawer::submitFramesBefore(const scene::World& world, const PictureRequest& request) {
    const std::optional<Drawn> drawn = std::exchange(mSlots[request.slot].drawn, std::nullopt);
    const extract::ViewRequest& view = request.frame.view;
    const bool hasTaa = usesTaa(request);
    const bool hasRaster = usesFrameBefore(request.method);
    if ((!hasTaa && !hasRaster) || isBox(request))
        return {};
    mSlots[request.slot].drawn = Drawn{view, hasTaa, hasRaster};
    const bool goesOn = drawn && drawn->hasTaa == hasTaa && drawn->hasRaster == hasRaster &&
                        isFrameBefore(drawn->view, view);
    if (!request.drawsFramesBefore || goesOn)
        return {};
    for (uint32_t age = hasTaa ? taa::kSettlingFrames : 1; age > 0; --age)
        SHUTTER_TRY(submitFrameBefore(world, request, age));
    return {};
}

core::Status PictureDrawer::submitFrameBefore(
    const scene::World& world, const PictureRequest& request, uint32_t age
) {
    const extract::ViewRequest& view = request.frame.view;
    render::FrameRequest before;
    before.view = view;
    before.view.exposure = scene::computeExposure(
        view.exposure.shutter,
        view.exposure.raster - age * view.exposure.frameSeconds,
        view.exposure.frameSeconds
    );
    if (usesTaa(request))
        before.view = taa::makeJittered(before.view, scene::numberFrame(view.exposure) - age);
    before.wantColor = before.wantPicture = false;
    before.wantTrace = request.frame.wantTrace;
    std::vector<render::PostEffect*> effects{prepareTaa(request)};
    if (age == 1 && usesFrameBefore(request.method))
        effects.push_back(prepareEffect(request, {}));
    std::erase(effects, nullptr);
    return submitFrame(
        world,
        before,
        effects,
        {.slot = request.slot, .isFirst = false, .isLast = false, .isBefore = true}
    );
}

core::Status
PictureDrawer::submitIntermediates(const scene::World& world, const PictureRequest& request) {
    if (!isAverage(request) || request.frame.intermediates.empty())
        return {};
    render::FrameRequest raster = request.frame;
    raster.wantColor = raster.wantDisplay = raster.showsDisplay = raster.wantDump = false;
    raster.shownIntermediates.clear();
    std::vector<render::PostEffect*> effects;
    if (render::PostEffect* own = prepareEffect(request, {}))
        effects.push_back(own);
    return submitFrame(world, raster, effects, {request.slot, false, false, true, true});
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
    return request.method.error && error && rays >= kLeastRaysToStop &&
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
    result.trace = std::exchange(mSlots[label.slot].trace, {});
    mSlots[label.slot].tracedFrames = 0;
    const render::Measures& measures = result.statistics.measures;
    const auto brightest = measures.find(render::kBrightest);
    mSlots[label.slot].brightest.reset();
    if (brightest != measures.end())
        mSlots[label.slot].brightest = float(brightest->second);
    mFinished.push_back({label.slot, std::move(result)});
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
