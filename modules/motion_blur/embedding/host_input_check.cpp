// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_input_check.h"

#include "engine/core/words.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/embedding/host_blended.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "shaders/common/shutter_response_shared.h"
#include "shaders/motion_blur/host_samples_shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::motion_blur {

namespace {

using core::makeError;

constexpr uint32_t kMaxPixels = 32768; ///< a side: lists hold x | y << 16 and a flag

constexpr std::array kColorFormats{
    kHostColorFormat,
    VK_FORMAT_R32G32B32A32_SFLOAT,
    VK_FORMAT_B10G11R11_UFLOAT_PACK32,
    VK_FORMAT_R8G8B8A8_UNORM,
    VK_FORMAT_B8G8R8A8_UNORM,
    VK_FORMAT_A2B10G10R10_UNORM_PACK32,
    VK_FORMAT_A2R10G10B10_UNORM_PACK32,
    VK_FORMAT_R16G16B16A16_UNORM,
    VK_FORMAT_R8G8B8A8_SRGB,
    VK_FORMAT_B8G8R8A8_SRGB};
constexpr std::array kMotionFormats{kHostMotionFormat};
constexpr std::array kNormalFormats{kHostColorFormat, VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr std::array kIdFormats{
    kHostIdFormat,
    VK_FORMAT_R16_UINT,
    VK_FORMAT_R8_UINT,
    VK_FORMAT_D24_UNORM_S8_UINT,
    VK_FORMAT_D32_SFLOAT_S8_UINT,
    VK_FORMAT_D16_UNORM_S8_UINT,
    VK_FORMAT_S8_UINT};

core::Status check(
    const HostImage& image, const HostImageRule& rule, VkExtent2D picture, const HostAbilities& host
) {
    SHUTTER_TRY(checkImage(image, rule, picture));
    return checkDevice(host.images, image, rule, picture);
}

/// An image of motion and depth is read as it is.
core::Status checkMotionDepth(
    const HostImage& image, const HostImageRule& rule, VkExtent2D picture, const HostAbilities& host
) {
    SHUTTER_TRY(checkImage(image, rule, picture));
    if (!isWhole(image, picture))
        return makeError(
            "motion blur: {} is part of a larger image; give it as vectors and "
            "depth, which may be",
            rule.name
        );
    return checkDevice(host.images, image, rule, picture);
}

/// Each given image is another one, or another layer.
core::Status checkDistinct(const HostInputs& inputs) {
    struct Named {
        const char* name;
        const HostImage& image;
    };

    const bool isMade = !inputs.motionDepth.image;
    const std::array<Named, 11> images{
        {{"color", inputs.color},
         {isMade ? "vectors" : "motionDepth",
          isMade ? inputs.convention.vectors.image : inputs.motionDepth},
         {"normal", inputs.normal},
         {"entityId", inputs.entityId},
         {"lastColor", inputs.last.color},
         {"lastMotionDepth", inputs.last.motionDepth},
         {"lastEntityId", inputs.last.entityId},
         {"deformedMotion", inputs.deformedMotion},
         {"lastDeformedMotion", inputs.lastDeformedMotion},
         {"blended", inputs.blended},
         {"output", inputs.output}}};
    for (size_t i = 0; i < images.size(); ++i)
        for (size_t j = i + 1; j < images.size(); ++j) {
            const HostImage& one = images[i].image;
            const HostImage& other = images[j].image;
            if (!one.image || one.image != other.image || one.layer != other.layer)
                continue;
            return makeError(
                "motion blur: {}.image is {}.image{}",
                images[j].name,
                images[i].name,
                other.image == inputs.output.image ? "; to blur in place, leave output.image null"
                                                   : ""
            );
        }
    return {};
}

core::Status checkMadeMotion(const HostInputs& inputs, const HostAbilities& host) {
    const HostConvention& convention = inputs.convention;
    const bool hasVectors = convention.vectors.image.image != VK_NULL_HANDLE;
    if (!hasVectors && !convention.depth.image.image)
        return makeError("motion blur: motionDepth.image is null, and so are vectors.image and "
                         "depth.image");
    const VkExtent2D picture = pictureOf(inputs);
    SHUTTER_TRY(checkConvention(convention, picture));
    if (hasVectors)
        SHUTTER_TRY(checkDevice(host.images, convention.vectors.image, kVectorsRule, picture));
    SHUTTER_TRY(checkDevice(host.images, convention.depth.image, kDepthRule, picture));
    if (!convention.scales.perPixel.image)
        return {};
    return checkDevice(host.images, convention.scales.perPixel, kBlurScaleRule, picture);
}

core::Status checkReveal(
    const HostInputs& inputs, const MotionBlurSettings& settings, const HostAbilities& host
) {
    const Method& method = *settings.method;
    if (!host.hasRays && !inputs.reveal.record)
        return makeError(
            "motion blur: the method {} needs rays: recordReveal is null", method.name
        );
    if (inputs.reveal.record && settings.rayShare < 1.0f)
        return makeError(
            "motion blur: rayShare is {}, but recordReveal answers each pixel; it must be 1",
            settings.rayShare
        );
    return {};
}

core::Status checkSamples(
    const HostInputs& inputs, const MotionBlurSettings& settings, const HostAbilities& host
) {
    if (!inputs.samples.record)
        return makeError(
            "motion blur: the method {} needs rays with times of their own: recordSamples is "
            "null",
            settings.method->name
        );
    if (!(settings.raysPerPixel <= kMaxHostSamplesPerPixel))
        return makeError(
            "motion blur: raysPerPixel is {}, but recordSamples answers from a list; it must be 0 "
            "to {}",
            settings.raysPerPixel,
            kMaxHostSamplesPerPixel
        );
    const double bytes = double(settings.raysPerPixel) * inputs.width * inputs.height * 16.0;
    if (bytes > double(host.mostBufferBytes))
        return makeError(
            "motion blur: raysPerPixel is {}, whose answers take {} bytes at {} x {}; the device "
            "has buffers of {}",
            settings.raysPerPixel,
            bytes,
            inputs.width,
            inputs.height,
            host.mostBufferBytes
        );
    return {};
}

core::Status checkDeformed(const HostInputs& inputs, const HostAbilities& host) {
    const VkExtent2D picture = pictureOf(inputs);
    if (inputs.deformedMotion.image)
        SHUTTER_TRY(check(inputs.deformedMotion, kDeformedRule, picture, host));
    if (!inputs.lastDeformedMotion.image)
        return {};
    if (!inputs.deformedMotion.image)
        return makeError(
            "motion blur: deformedMotion.image is null, but lastDeformedMotion.image is not"
        );
    return check(inputs.lastDeformedMotion, kLastDeformedRule, picture, host);
}

core::Status checkLast(const HostInputs& inputs, const HostAbilities& host) {
    const HostLastFrame& last = inputs.last;
    if (!last.color.image && !last.motionDepth.image && !last.entityId.image)
        return {};
    const VkExtent2D picture = pictureOf(inputs);
    SHUTTER_TRY(check(last.color, kLastColorRule, picture, host));
    SHUTTER_TRY(checkMotionDepth(last.motionDepth, kLastMotionRule, picture, host));
    if (!last.entityId.image && isOneWorld(inputs))
        return {};
    return check(last.entityId, kLastIdRule, picture, host);
}

core::Status checkTables(const HostInputs& inputs, const Method& method) {
    if (inputs.rays.frameConstants == 0)
        return makeError(
            "motion blur: rays.frameConstants is 0, which the method {} needs", method.name
        );
    if (inputs.rays.tlas && (!inputs.rays.tlasBuffer || !inputs.rays.scene))
        return makeError(
            "motion blur: rays.{} is null", inputs.rays.tlasBuffer ? "scene" : "tlasBuffer"
        );
    return {};
}

/// Camera motion requires frame constants or cameras.
core::Status checkCamera(const HostInputs& inputs, const Method& method) {
    if (inputs.rays.frameConstants != 0)
        return {};
    if (!inputs.convention.cameras.areGiven)
        return makeError(
            "motion blur: cameras are not given, which the method {} needs", method.name
        );
    return checkScales(inputs.convention.scales, pictureOf(inputs));
}

/// Movers without matrices require motion vectors.
core::Status checkMoversAreKnown(const HostInputs& inputs) {
    if (inputs.motionDepth.image || inputs.convention.vectors.image.image)
        return {};
    const auto& movers = inputs.motion.movers;
    for (size_t i = 0; i < movers.size(); ++i)
        if (movers[i].worldFromObject.empty())
            return makeError(
                "motion blur: movers[{}] has no worldFromObject, and "
                "vectors.image is null: without vectors each mover needs matrices",
                i
            );
    return {};
}

/// Motion is blurred as the host scales it, or the field is refused.
core::Status checkScalesCount(const HostInputs& inputs, const Method& method) {
    const HostScales& scales = inputs.convention.scales;
    const bool isPacked = inputs.motionDepth.image != VK_NULL_HANDLE;
    if (scales.perPixel.image && (isPacked || method.readsInstantMotions))
        return makeError(
            "motion blur: blurScale.image is given, which {}",
            isPacked
                ? "does not count with motionDepth; scale that"
                : fmt::format(
                      "the method {} cannot honour; for a weapon or cockpit give viewModelRows",
                      method.name
                  )
        );
    for (const auto& [name, scale] :
         {std::pair{"cameraScale", scales.camera}, std::pair{"objectScale", scales.object}}) {
        if (scale == 1.0f)
            continue;
        const char* reason = nullptr;
        if (isPacked && !method.readsCamera)
            reason = "motionDepth is given; scale that";
        else if (method.rays == RayNeed::Query)
            reason = "recordSamples answers for the motion as it is";
        else if (method.readsInstantMotions && inputs.deformedMotion.image)
            reason = "deformedMotion holds the motion as it is";
        if (reason)
            return makeError("motion blur: {} is {}, it must be 1: {}", name, scale, reason);
    }
    return {};
}

/// Movers require ids that mark their pixels.
core::Status checkIds(const HostInputs& inputs, const Method& method, const HostAbilities& host) {
    if (method.readsInstantMotions && isOneWorld(inputs))
        return {};
    if (method.readsInstantMotions && !inputs.entityId.image &&
        !inputs.motion.viewModelRows.empty())
        return makeError(
            "motion blur: entityId.image is null, although viewModelRows has {}: ids mark their "
            "pixels",
            core::countOf(inputs.motion.viewModelRows.size(), "row")
        );
    if (method.readsInstantMotions && !inputs.entityId.image)
        return makeError(
            "motion blur: entityId.image is null, although movers has {}: ids mark their "
            "pixels",
            core::countOf(inputs.motion.movers.size(), "row")
        );
    SHUTTER_TRY(check(inputs.entityId, kIdRule, pictureOf(inputs), host));
    const VkFormat format = formatOf(inputs.entityId, kIdRule);
    const uint32_t most = format == VK_FORMAT_R32_UINT   ? 0xFFFFFFFFu
                          : format == VK_FORMAT_R16_UINT ? 0xFFFFu
                                                         : 0xFFu;
    if (inputs.noEntity > most)
        return makeError(
            "motion blur: noEntity is {}, but entityId holds values up to {}", inputs.noEntity, most
        );
    return {};
}

core::Status checkMethod(
    const HostInputs& inputs, const MotionBlurSettings& settings, const HostAbilities& host
) {
    const Method& method = *settings.method;
    const VkExtent2D picture = pictureOf(inputs);
    if (!method.readsRaster)
        return makeError(
            "motion blur: the method {} reads no raster image; it is not for hosts that have one",
            method.name
        );
    if (inputs.motion.lens.isOpen() && !seesThroughLens(inputs, settings))
        return makeError(
            "motion blur: lens.radius is {}, but the method {} has no lens; it must be 0, or the "
            "method resolved or adaptive, with keys",
            inputs.motion.lens.radius,
            method.name
        );
    SHUTTER_TRY(checkScalesCount(inputs, method));
    if (inputs.convention.viewModel.isGiven() && inputs.motionDepth.image)
        return makeError(
            "motion blur: viewModel.depthMax is {}, but motionDepth is given; it names "
            "pixels by the values of depth",
            inputs.convention.viewModel.depthMax
        );
    if (hasViewModel(inputs) && inputs.last.color.image)
        return makeError(
            "motion blur: viewModel.depthMax is {}, but lastColor is given, whose pixels "
            "have no such depth; name it by viewModelRows",
            inputs.convention.viewModel.depthMax
        );
    if (method.rays == RayNeed::Query)
        SHUTTER_TRY(checkSamples(inputs, settings, host));
    if (method.rays == RayNeed::Any)
        SHUTTER_TRY(checkReveal(inputs, settings, host));
    if (method.readsNormal)
        SHUTTER_TRY(check(inputs.normal, kNormalRule, picture, host));
    if (method.readsEntityId)
        SHUTTER_TRY(checkIds(inputs, method, host));
    if (method.readsInstantMotions && settings.secondRaster)
        return makeError(
            "motion blur: secondRaster is true, but hosts have one raster; it must be false"
        );
    if (method.readsInstantMotions) {
        std::vector<HostMover> movers;
        SHUTTER_TRY(checkMotion(countedMotion(inputs, movers), describeFrame(inputs, settings)));
        SHUTTER_TRY(checkMoversAreKnown(inputs));
        SHUTTER_TRY(checkLast(inputs, host));
        SHUTTER_TRY(checkDeformed(inputs, host));
    }
    if (method.readsCamera)
        return checkCamera(inputs, method);
    const bool readsTables = method.rays == RayNeed::Any && !inputs.reveal.record;
    return readsTables ? checkTables(inputs, method) : core::Status();
}

core::Status checkResponsePoints(const HostInputs& inputs) {
    const auto points = inputs.responsePoints;
    if (points.empty())
        return {};
    if (!points.data())
        return makeError("motion blur: responsePoints is null, its length {}", points.size());
    if (inputs.response != 0)
        return makeError("motion blur: response is not 0, although there are responsePoints");
    if (points.size() < 2 || points.size() > shader::kMaxResponseKnots)
        return makeError(
            "motion blur: responsePoints holds {}, it must be 2 to {}",
            points.size(),
            shader::kMaxResponseKnots
        );
    bool takesLight = false;
    for (size_t i = 0; i < points.size(); ++i) {
        const auto [s, sensitivity] = points[i];
        // Shaders have floats, in which times must differ as well.
        const bool rises = i == 0 ? s == 0.0 : float(s) > float(points[i - 1].s);
        if (!rises || !(s <= 1.0) || (i + 1 == points.size() && s != 1.0))
            return makeError(
                "motion blur: responsePoints[{}].time is {}, times must rise from 0 to 1", i, s
            );
        if (!(sensitivity >= 0.0 && std::isfinite(sensitivity)))
            return makeError(
                "motion blur: responsePoints[{}].sensitivity is {}, it must be finite and 0 or "
                "more",
                i,
                sensitivity
            );
        takesLight = takesLight || sensitivity > 0.0;
    }
    if (!takesLight)
        return makeError("motion blur: all responsePoints have sensitivity 0: no light is taken");
    return {};
}

/// An image of depth and ids has one use before and one after.
core::Status checkSharedDepth(const HostInputs& inputs) {
    if (!sharesDepth(inputs))
        return {};
    const HostImage& depth = inputs.convention.depth.image;
    const HostImage& ids = inputs.entityId;
    const VkExtent2D extent = extentOf(ids, pictureOf(inputs));
    const VkExtent2D whole = extentOf(depth, pictureOf(inputs));
    const auto isSame = [](const graph::OutsideUse& a, const graph::OutsideUse& b) {
        return a.layout == b.layout && a.stages == b.stages && a.access == b.access;
    };
    const bool hasStencil = (gpu::aspectOf(ids.format) & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
    if (hasStencil && ids.format == depth.format && extent.width == whole.width &&
        extent.height == whole.height && isSame(ids.before, depth.before) &&
        isSame(ids.after, depth.after))
        return {};
    return makeError("motion blur: entityId.image is depth.image: format, extent, before and "
                     "after must be those of depth, which has a stencil");
}

core::Status checkImages(const HostInputs& inputs, const HostAbilities& host) {
    const VkExtent2D picture = pictureOf(inputs);
    SHUTTER_TRY(checkTransfer(inputs.transfer));
    SHUTTER_TRY(checkDistinct(inputs)); // the same image twice may be too small for one of them
    SHUTTER_TRY(checkSharedDepth(inputs));
    SHUTTER_TRY(check(inputs.color, colorRule(inputs), picture, host));
    if (inputs.output.image)
        SHUTTER_TRY(check(inputs.output, outputRule(inputs), picture, host));
    if (inputs.blended.image)
        SHUTTER_TRY(check(inputs.blended, kBlendedRule, picture, host));
    if (inputs.motionDepth.image)
        SHUTTER_TRY(checkMotionDepth(inputs.motionDepth, kMotionRule, picture, host));
    if (inputs.motionDepth.image && !inputs.isOff) // the checker and dumps read the cameras
        SHUTTER_TRY(checkHostCameras(countedCameras(inputs.convention), picture));
    else if (!inputs.isOff)
        SHUTTER_TRY(checkMadeMotion(inputs, host));
    return {};
}

VkImageUsageFlags usageToDeliver(const HostImage& image) {
    return packingOf(image.format) ? VK_IMAGE_USAGE_TRANSFER_DST_BIT : VK_IMAGE_USAGE_STORAGE_BIT;
}

/// Keys other than the raster's belong to another place.
void keepRasterKey(HostMotion& motion, double rasterTime, std::vector<HostMover>& movers) {
    const auto keys = motion.keys;
    if (!keys.data())
        return; // which is refused
    const auto raster = std::find_if(keys.begin(), keys.end(), [&](const HostCameraKey& key) {
        return isRasterKey(key, rasterTime);
    });
    if (raster == keys.end())
        return; // the same
    const size_t index = size_t(raster - keys.begin());
    motion.keys = keys.subspan(index, 1);
    std::span<const double>& focus = motion.lens.focusDistances;
    if (focus.data() && focus.size() == keys.size())
        focus = focus.subspan(index, 1);
    if (motion.viewFromObject.data() && motion.viewFromObject.size() == keys.size())
        motion.viewFromObject = motion.viewFromObject.subspan(index, 1);
    motion.followsLast = false;
    if (!motion.movers.data())
        return;
    movers.assign(motion.movers.begin(), motion.movers.end());
    for (HostMover& mover : movers)
        if (mover.worldFromObject.data() && mover.worldFromObject.size() == keys.size())
            mover.worldFromObject = mover.worldFromObject.subspan(index, 1);
    motion.movers = movers;
}

} // namespace

const HostImageRule kMotionRule{.name = "motionDepth", .formats = kMotionFormats};
const HostImageRule kNormalRule{.name = "normal", .formats = kNormalFormats};
const HostImageRule kIdRule{.name = "entityId", .formats = kIdFormats, .hasPictureSize = false};
const HostImageRule kLastColorRule{.name = "lastColor", .formats = kColorFormats};
const HostImageRule kLastMotionRule{.name = "lastMotionDepth", .formats = kMotionFormats};
const HostImageRule kLastIdRule{
    .name = "lastEntityId", .formats = kIdFormats, .hasPictureSize = false};
const HostImageRule kDeformedRule{.name = "deformedMotion", .formats = kNormalFormats};
const HostImageRule kLastDeformedRule{.name = "lastDeformedMotion", .formats = kNormalFormats};
const HostImageRule kBlendedRule{.name = "blended", .formats = kNormalFormats};

VkExtent2D pictureOf(const HostInputs& inputs) {
    return {inputs.width, inputs.height};
}

bool isOneWorld(const HostInputs& inputs) {
    return !inputs.entityId.image && inputs.motion.movers.empty() &&
           inputs.motion.viewModelRows.empty();
}

HostMotion countedMotion(const HostInputs& inputs, std::vector<HostMover>& movers) {
    HostMotion motion = inputs.motion;
    if (isOneWorld(inputs)) {
        motion.rowCount = 1;
        motion.rowIds = {};
    }
    if (inputs.motionDepth.image)
        return motion;
    motion.cameraScale = inputs.convention.scales.camera;
    motion.objectScale = inputs.convention.scales.object;
    const HostViewModel& model = inputs.convention.viewModel;
    motion.hasViewModel = model.isGiven();
    motion.viewModelProjection = model.clipFromView;
    motion.viewFromObject = model.isGiven() ? model.viewFromObject : std::span<const glm::dmat4>();
    if (inputs.convention.scales.isCut)
        keepRasterKey(motion, inputs.rasterTime, movers);
    return motion;
}

bool hasViewModel(const HostInputs& inputs) {
    return !inputs.motionDepth.image && inputs.convention.viewModel.isGiven();
}

bool sharesDepth(const HostInputs& inputs) {
    const HostImage& depth = inputs.convention.depth.image;
    return !inputs.motionDepth.image && inputs.entityId.image &&
           inputs.entityId.image == depth.image && inputs.entityId.layer == depth.layer;
}

double timeOfFrameBefore(const HostInputs& inputs) {
    const HostScales& scales = inputs.convention.scales;
    const double share = scales.exposureShare > 1.0e-4f ? scales.exposureShare : 1.0e-4; // or NaN
    return inputs.rasterTime - scales.displayedPerRendered / share;
}

bool isNativeImage(const HostImage& image, VkFormat format, VkExtent2D picture) {
    return (image.format == VK_FORMAT_UNDEFINED || image.format == format) && image.layer == 0 &&
           isWhole(image, picture);
}

bool isNativeColor(const HostImage& image, const HostTransfer& transfer, VkExtent2D picture) {
    return isNativeImage(image, kHostColorFormat, picture) &&
           isIdentity(decodingOf(transfer, kHostColorFormat));
}

HostImageRule colorRule(const HostInputs& inputs) {
    HostImageRule rule{.name = "color", .formats = kColorFormats};
    if (isNativeImage(inputs.color, kHostColorFormat, pictureOf(inputs)))
        rule.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if (!inputs.output.image)
        rule.usage |= usageToDeliver(inputs.color);
    return rule;
}

HostImageRule outputRule(const HostInputs& inputs) {
    HostImageRule rule{
        .name = "output",
        .formats = kColorFormats,
        .usage = usageToDeliver(inputs.output),
        .isWritten = true};
    if (isNativeImage(inputs.output, kHostColorFormat, pictureOf(inputs)))
        rule.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return rule;
}

bool seesThroughLens(const HostInputs& inputs, const MotionBlurSettings& settings) {
    return inputs.motion.lens.isOpen() && settings.method->readsLens &&
           settings.method->readsInstantMotions;
}

HostMotionFrame describeFrame(const HostInputs& inputs, const MotionBlurSettings& settings) {
    const bool hasLens = seesThroughLens(inputs, settings);
    return {
        {inputs.width, inputs.height},
        inputs.rasterTime,
        inputs.response != 0,
        hasLens ? settings.sampleCount : countInstants(settings),
        inputs.lastDeformedMotion.image != VK_NULL_HANDLE};
}

core::Status checkInputs(
    const HostInputs& inputs, const MotionBlurSettings& settings, const HostAbilities& host
) {
    const uint32_t most = std::min(kMaxPixels, host.images.mostPixels);
    if (inputs.width < 1 || inputs.width > most || inputs.height < 1 || inputs.height > most)
        return makeError(
            "motion blur: the size is {} x {}, both must be 1 to {}{}",
            inputs.width,
            inputs.height,
            most,
            most < kMaxPixels ? ", the device's maxImageDimension2D" : ""
        );
    if (!(inputs.rasterTime >= 0.0 && inputs.rasterTime <= 1.0))
        return makeError("motion blur: rasterTime is {}, it must be 0 to 1", inputs.rasterTime);
    SHUTTER_TRY(checkResponsePoints(inputs));
    SHUTTER_TRY(checkImages(inputs, host));
    if (inputs.motion.view >= host.framesInFlight)
        return makeError(
            "motion blur: view is {}, framesInFlight {}", inputs.motion.view, host.framesInFlight
        );
    SHUTTER_TRY(validate(inputs.budget));
    if (!inputs.budget.isUnlimited() && !host.measures)
        return makeError(
            "motion blur: budgetMilliseconds is {}, which needs ShutterBlurDevice::measures",
            inputs.budget.milliseconds
        );
    SHUTTER_TRY(validate(settings));
    SHUTTER_TRY(checkDrawn(inputs, settings, host.mostBufferBytes));
    return inputs.isOff ? core::Status() : checkMethod(inputs, settings, host);
}

} // namespace shutter::motion_blur
