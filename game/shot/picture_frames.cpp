// SPDX-License-Identifier: MIT
// The frames of a picture, and the effects of each.
#include "engine/core/check.h"
#include "game/shot/picture_drawer.h"
#include "shaders/common/instant_motion_shared.h"

#include <cmath>
#include <utility>

namespace shutter::game {

namespace {

bool usesTaa(const PictureRequest& request) {
    return request.antiAliasing == AntiAliasing::Taa && !isSampledAnyway(*request.method.method);
}

bool isBox(const PictureRequest& request) {
    return request.antiAliasing == AntiAliasing::Box && !isSampledAnyway(*request.method.method);
}

/// Frames that no one shows make the picture, whose mean it is.
bool averagesSamples(const PictureRequest& request) {
    return request.method.method->family == MethodFamily::Accumulate || isBox(request);
}

/// Several sharp or blurred frames make the picture, whose mean it is.
bool isAverage(const PictureRequest& request) {
    return averagesSamples(request) || !request.exposureParts.empty();
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

} // namespace

render::Effect* PictureDrawer::prepareEffect(const PictureRequest& request, const Part& part) {
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
        finishUntil(0); // a batch's counters are read before the next one
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

render::Effect* PictureDrawer::prepareLensFilter(const PictureRequest& request) {
    if (!request.filtersLens)
        return nullptr;
    Slot& slot = mSlots[request.slot];
    if (!slot.depthOfField)
        slot.depthOfField = std::make_unique<depth_of_field::DepthOfField>(
            mDevice, mRenderer.scene().textureLayout()
        );
    depth_of_field::DepthOfFieldSettings settings{
        request.method.method->lensFilter, request.method.lensTaps};
    if (settings.filter->tracesRays)
        settings.rays = request.method.samples;
    slot.depthOfField->configure(settings);
    return slot.depthOfField.get();
}

std::vector<render::Effect*>
PictureDrawer::prepareBlurs(const PictureRequest& request, const Part& part) {
    std::vector<render::Effect*> effects{prepareLensFilter(request), prepareEffect(request, part)};
    if (request.method.method->filtersBlurred)
        std::swap(effects.front(), effects.back());
    std::erase(effects, nullptr);
    return effects;
}

render::Effect* PictureDrawer::prepareTaa(const PictureRequest& request) {
    if (isSampledAnyway(*request.method.method) || isBox(request))
        return nullptr;
    Slot& slot = mSlots[request.slot];
    if (!slot.taa)
        slot.taa = std::make_unique<taa::Taa>(mDevice);
    slot.taa->setEnabled(usesTaa(request));
    return slot.taa.get();
}

std::vector<render::Effect*>
PictureDrawer::prepareEffects(const PictureRequest& request, const Part& part) {
    std::vector<render::Effect*> effects = prepareBlurs(request, part);
    // Its pictures follow one another from frame to frame.
    if (part.isLastOfExposure)
        effects.insert(effects.begin(), prepareTaa(request));
    if (isAverage(request)) {
        Slot& slot = mSlots[request.slot];
        if (!slot.accumulate)
            slot.accumulate = std::make_unique<accumulate::Accumulate>(mDevice);
        slot.accumulate->setFrame(
            {.isFirst = part.done == 0 && part.isFirstOfExposure,
             .isLast = part.done + 1 == part.total && part.isLastOfExposure,
             .weight = part.exposure ? part.exposure->share : 1.0,
             .total = double(part.total)}
        );
        effects.push_back(slot.accumulate.get());
    }
    std::erase(effects, nullptr);
    return effects;
}

core::Status PictureDrawer::submitFrame(
    const scene::World& world,
    const render::FrameRequest& frame,
    const std::vector<render::Effect*>& effects,
    const Label& label
) {
    finishUntil(mRenderer.framesInFlight() - 1);
    SHUTTER_TRY(mRenderer.submitFrame(world, frame, mFeatures.listWith(effects)));
    mLabels.push_back(label);
    return {};
}

core::Status PictureDrawer::submitPart(
    const scene::World& world, const PictureRequest& request, const Part& part
) {
    if (isBox(request) && request.drawsFramesBefore && usesFrameBefore(request.method)) {
        PictureRequest placed = request;
        placed.frame.view = placeInPixel(request, part);
        SHUTTER_TRY(submitFrameBefore(world, placed, 1));
    }
    if (request.exposureParts.empty())
        return submitOwnFrame(world, request, part);
    for (const extract::ExposurePart& exposure : request.exposureParts) {
        Part own = part;
        own.exposure = &exposure;
        own.isFirstOfExposure = &exposure == &request.exposureParts.front();
        own.isLastOfExposure = &exposure == &request.exposureParts.back();
        own.isShown = part.isShown && own.isLastOfExposure;
        SHUTTER_TRY(submitOwnFrame(world, request, own));
    }
    return {};
}

core::Status PictureDrawer::submitOwnFrame(
    const scene::World& world, const PictureRequest& request, const Part& part
) {
    const MethodFamily family = request.method.method->family;
    const bool isLast = part.done + part.count == part.total && part.isLastOfExposure;
    const bool hasMore = averagesSamples(request) && !request.frame.intermediates.empty();
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
    if (!isLast || averagesSamples(request))
        frame.intermediates.clear();
    frame.isFollowed = part.isLastOfExposure;
    std::vector<render::Effect*> effects = prepareEffects(request, part);
    if (part.isShown)
        effects.insert(effects.end(), request.ending.begin(), request.ending.end());
    Label label{
        .slot = request.slot,
        .isFirst = part.done == request.raysBefore && part.isFirstOfExposure,
        .isShown = part.isShown,
        .isLast = isLast && !hasMore};
    label.exposureParts = request.exposureParts.size();
    return submitFrame(world, frame, effects, label);
}

extract::ViewRequest PictureDrawer::placeInPixel(const PictureRequest& request, const Part& part) {
    extract::ViewRequest view = request.frame.view;
    if (part.exposure)
        view.exposure = part.exposure->exposure;
    if (isBox(request)) {
        static_assert(kBoxFrames % shader::kLensSets == 0, "each place of the lens counts alike");
        view.lensTurn = part.done;
        return accumulate::makeSubpixel(view, part.done, part.total, request.seed);
    }
    if (!usesTaa(request) || !part.isLastOfExposure)
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
    before.view.exposure = scene::computeExposureBefore(view.exposure, age);
    const auto parts = planExposure(world, request.method, before.view);
    if (!parts.empty())
        before.view.exposure = parts.back().exposure;
    if (usesTaa(request))
        before.view = taa::makeJittered(before.view, scene::numberFrame(view.exposure) - age);
    before.wantColor = before.wantPicture = false;
    before.wantTrace = request.frame.wantTrace;
    std::vector<render::Effect*> effects{prepareTaa(request)};
    // In each frame: what the method draws itself must not be accumulated as static.
    if (usesFrameBefore(request.method))
        for (render::Effect* effect : prepareBlurs(request, {}))
            effects.push_back(effect);
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
    if (!averagesSamples(request) || request.frame.intermediates.empty())
        return {};
    render::FrameRequest raster = request.frame;
    if (!request.exposureParts.empty())
        raster.view.exposure = request.exposureParts.back().exposure;
    raster.isFollowed = false;
    raster.wantColor = raster.wantDisplay = raster.showsDisplay = raster.wantDump = false;
    raster.shownIntermediates.clear();
    const std::vector<render::Effect*> effects = prepareBlurs(request, {});
    Label label{
        .slot = request.slot,
        .isFirst = false,
        .isShown = false,
        .isLast = true,
        .isIntermediates = true};
    label.exposureParts = request.exposureParts.size();
    return submitFrame(world, raster, effects, label);
}

} // namespace shutter::game
