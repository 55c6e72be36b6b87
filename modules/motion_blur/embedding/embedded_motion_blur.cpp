// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/embedded_motion_blur.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "engine/graph/transient_pool.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "modules/motion_blur/instant_motions.h"
#include "shaders/render/scene_shared.h"

#include <array>
#include <deque>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

namespace shutter::motion_blur {

namespace {

using core::makeError;

constexpr uint32_t kMostFrames = 64;
constexpr uint32_t kMostPixels = 32768; ///< a side: lists hold x | y << 16 and a flag

constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kMotionFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kIdFormat = VK_FORMAT_R32_UINT;
constexpr std::array kColorFormats{
    kColorFormat, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_B10G11R11_UFLOAT_PACK32};
constexpr std::array kMotionFormats{kMotionFormat};
constexpr std::array kNormalFormats{kColorFormat, VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr std::array kIdFormats{kIdFormat, VK_FORMAT_R16_UINT, VK_FORMAT_R8_UINT};

/// The part of the image that is used is one that the effect may read, or write, itself.
bool isOwn(const HostImage& image, VkFormat format, VkExtent2D picture) {
    return (image.format == VK_FORMAT_UNDEFINED || image.format == format) &&
           isWhole(image, picture);
}

VkExtent2D pictureOf(const HostInputs& inputs) {
    return {inputs.width, inputs.height};
}

HostImageRule colorRule(const HostInputs& inputs) {
    HostImageRule rule{.name = "color", .formats = kColorFormats};
    if (isOwn(inputs.color, kColorFormat, pictureOf(inputs)))
        rule.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if (!inputs.output.image)
        rule.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    return rule;
}

HostImageRule outputRule(const HostInputs& inputs) {
    HostImageRule rule{
        .name = "output",
        .formats = kColorFormats,
        .usage = VK_IMAGE_USAGE_STORAGE_BIT,
        .isWritten = true};
    if (isOwn(inputs.output, kColorFormat, pictureOf(inputs)))
        rule.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return rule;
}

const HostImageRule kMotionRule{.name = "motionDepth", .formats = kMotionFormats};
const HostImageRule kNormalRule{.name = "normal", .formats = kNormalFormats};
const HostImageRule kIdRule{.name = "entityId", .formats = kIdFormats, .hasPictureSize = false};

/// motionDepth is read as it is.
core::Status checkMotionDepth(const HostInputs& inputs) {
    const VkExtent2D picture = pictureOf(inputs);
    SHUTTER_TRY(checkImage(inputs.motionDepth, kMotionRule, picture));
    if (!isWhole(inputs.motionDepth, picture))
        return makeError("motion blur: motionDepth is part of a larger image; give it as "
                         "convention.vectors and convention.depth, which may be");
    return {};
}

/// Each given image is another one.
core::Status checkDistinct(const HostInputs& inputs) {
    struct Named {
        const char* name;
        VkImage image;
    };

    const HostConvention& convention = inputs.convention;
    const bool isMade = !inputs.motionDepth.image;
    const std::array<Named, 5> images{
        {{"color", inputs.color.image},
         {isMade ? "convention.vectors.image" : "motionDepth",
          isMade ? convention.vectors.image.image : inputs.motionDepth.image},
         {"normal", inputs.normal.image},
         {"entityId", inputs.entityId.image},
         {"output", inputs.output.image}}};
    for (size_t i = 0; i < images.size(); ++i)
        for (size_t j = i + 1; j < images.size(); ++j)
            if (images[i].image && images[i].image == images[j].image)
                return makeError(
                    "motion blur: {}.image is {}.image{}",
                    images[j].name,
                    images[i].name,
                    images[j].image == inputs.output.image
                        ? "; to blur in place, leave output.image null"
                        : ""
                );
    return {};
}

HostMotionFrame describeFrame(const HostInputs& inputs, const MotionBlurSettings& settings) {
    return {
        {inputs.width, inputs.height},
        inputs.rasterTime,
        inputs.response != 0,
        countInstants(settings)};
}

} // namespace

/// What one frame in flight holds.
struct EmbeddedMotionBlur::Slot {
    explicit Slot(gpu::Device& device) : frame(gpu::Frame::createForHost(device)), pool(device) {}

    std::unique_ptr<gpu::Frame> frame;
    graph::TransientPool pool;
    /// Views of the host's images, made anew in each frame: a handle that is the last one's need
    /// not be the same image. A deque, since the graph points to them.
    std::deque<gpu::Image> images;
    gpu::Buffer instants;    ///< math::InstantLayers, for the methods that read them
    gpu::Buffer convention;  ///< shader::PrepareTable, where motion and depth are made
    uint64_t handedOver = 0; ///< timeline value of what was recorded last
};

/// What is kept from frame to frame.
struct EmbeddedMotionBlur::View {
    explicit View(gpu::Device& device) : history(device) {}

    std::optional<HostRaster> last; ///< of what `history` keeps; nothing: there is no frame before
    RasterHistory history;

    void forget() {
        last.reset();
        history.forget();
    }
};

/// A recording under way.
struct EmbeddedMotionBlur::Frame {
    Slot& slot;
    graph::Graph& graph;
    const HostInputs& inputs;

    /// Invalid where there is no image.
    [[nodiscard]] graph::ImageHandle import(
        gpu::Device& device, const char* name, const HostImage& given, const HostImageRule& rule
    ) {
        if (!given.image)
            return {};
        const VkExtent2D extent = extentOf(given, pictureOf(inputs));
        // Only what shaders do counts here: it is what views are for.
        const VkImageUsageFlags usage =
            rule.usage & (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
        const gpu::Image& image = slot.images.emplace_back(gpu::Image::adopt(
            device, name, given.image, {extent.width, extent.height, formatOf(given, rule), usage}
        ));
        return graph.importImage(name, image, given.before, given.after);
    }

    graph::ImageHandle color;  ///< the host's own
    graph::ImageHandle output; ///< the same; in place: invalid
};

core::Result<std::unique_ptr<EmbeddedMotionBlur>>
EmbeddedMotionBlur::create(const HostDevice& host, uint32_t headerVersion) {
    SHUTTER_TRY(checkVersion(headerVersion)); // first: another version's HostDevice is another
    if (!host.physical || !host.device)
        return makeError(
            "motion blur: HostDevice::{} is null", host.physical ? "device" : "physical"
        );
    if (host.framesInFlight < 1 || host.framesInFlight > kMostFrames)
        return makeError(
            "motion blur: framesInFlight is {}, it must be 1 to {}",
            host.framesInFlight,
            kMostFrames
        );
    if (host.rayTier != gpu::RayTier::None && !host.sceneLayout)
        return makeError("motion blur: sceneLayout is null, although rayTier asks for rays");
    const core::Status able = checkHostDevice(host.physical, host.queueFamily, host.rayTier);
    if (!able)
        return able.error();
    try {
        auto device = gpu::Device::adopt(
            {.physical = host.physical,
             .device = host.device,
             .rayTier = host.rayTier,
             .tracesIndirect = host.tracesIndirect,
             .hasDebugUtils = host.hasDebugUtils,
             .pipelineCache = host.pipelineCache}
        );
        if (!device)
            return device.error();
        return std::unique_ptr<EmbeddedMotionBlur>(
            new EmbeddedMotionBlur(std::move(device).value(), host)
        );
    } catch (const gpu::DeviceError& error) {
        return core::Error{error.what()};
    } catch (const std::bad_alloc&) {
        return makeError("motion blur: out of main memory");
    }
}

EmbeddedMotionBlur::EmbeddedMotionBlur(std::unique_ptr<gpu::Device> device, const HostDevice& host)
    : mDevice(std::move(device)), mHasRays(host.rayTier != gpu::RayTier::None),
      mEffect(*mDevice, mHasRays ? host.sceneLayout : VK_NULL_HANDLE), mPreparation(*mDevice) {
    for (uint32_t i = 0; i < host.framesInFlight; ++i) {
        mSlots.push_back(std::make_unique<Slot>(*mDevice));
        mViews.push_back(std::make_unique<View>(*mDevice));
    }
}

EmbeddedMotionBlur::~EmbeddedMotionBlur() = default;

core::Status EmbeddedMotionBlur::checkMethod(
    const HostInputs& inputs, const MotionBlurSettings& settings
) const {
    const Method& method = *settings.method;
    if (!method.readsRaster)
        return makeError(
            "motion blur: the method {} reads no raster image; it is not for hosts that have one",
            method.name
        );
    if (method.rays == RayNeed::Query)
        return makeError(
            "motion blur: the method {} needs timed rays, which hosts cannot give", method.name
        );
    const bool hasOwnReveal = method.rays == RayNeed::Any && inputs.reveal.record;
    if (method.rays != RayNeed::None && !mHasRays && !hasOwnReveal)
        return makeError(
            "motion blur: the method {} needs rays: reveal.record is empty, and "
            "HostDevice::rayTier "
            "was none",
            method.name
        );
    if (hasOwnReveal && settings.rayShare < 1.0f)
        return makeError(
            "motion blur: rayShare is {}, but reveal.record answers each pixel; it must be 1",
            settings.rayShare
        );
    if (method.readsNormal)
        SHUTTER_TRY(check(inputs.normal, kNormalRule, pictureOf(inputs)));
    if (method.readsEntityId)
        SHUTTER_TRY(check(inputs.entityId, kIdRule, pictureOf(inputs)));
    if (method.readsInstantMotions && settings.secondRaster)
        return makeError(
            "motion blur: secondRaster is true, but hosts have one raster; it must be false"
        );
    if (method.readsInstantMotions)
        SHUTTER_TRY(checkMotion(inputs.motion, describeFrame(inputs, settings)));
    if (hasOwnReveal || (method.rays == RayNeed::None && !method.readsCamera))
        return {};
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

core::Status EmbeddedMotionBlur::check(
    const HostImage& image, const HostImageRule& rule, VkExtent2D picture
) const {
    SHUTTER_TRY(checkImage(image, rule, picture));
    return checkSupport(mDevice->physical(), image, rule);
}

core::Status EmbeddedMotionBlur::checkMadeMotion(const HostInputs& inputs) const {
    const HostConvention& convention = inputs.convention;
    if (!convention.vectors.image.image)
        return makeError(
            "motion blur: motionDepth.image is null, and so is convention.vectors.image.image"
        );
    SHUTTER_TRY(checkConvention(convention, pictureOf(inputs)));
    SHUTTER_TRY(checkSupport(mDevice->physical(), convention.vectors.image, kVectorsRule));
    SHUTTER_TRY(checkSupport(mDevice->physical(), convention.depth.image, kDepthRule));
    if (!convention.scales.perPixel.image)
        return {};
    return checkSupport(mDevice->physical(), convention.scales.perPixel, kBlurScaleRule);
}

core::Status EmbeddedMotionBlur::check(
    VkCommandBuffer commands,
    uint32_t frame,
    const HostInputs& inputs,
    const MotionBlurSettings& settings
) const {
    if (!commands)
        return makeError("motion blur: the command buffer is null");
    if (frame >= mSlots.size())
        return makeError("motion blur: frame is {}, framesInFlight {}", frame, mSlots.size());
    if (inputs.width < 1 || inputs.width > kMostPixels || inputs.height < 1 ||
        inputs.height > kMostPixels)
        return makeError(
            "motion blur: the size is {} x {}, both must be 1 to {}",
            inputs.width,
            inputs.height,
            kMostPixels
        );
    if (!(inputs.rasterTime >= 0.0 && inputs.rasterTime <= 1.0))
        return makeError("motion blur: rasterTime is {}, it must be 0 to 1", inputs.rasterTime);
    SHUTTER_TRY(check(inputs.color, colorRule(inputs), pictureOf(inputs)));
    if (inputs.output.image)
        SHUTTER_TRY(check(inputs.output, outputRule(inputs), pictureOf(inputs)));
    if (inputs.motionDepth.image)
        SHUTTER_TRY(checkMotionDepth(inputs));
    else
        SHUTTER_TRY(checkMadeMotion(inputs));
    SHUTTER_TRY(checkDistinct(inputs));
    if (inputs.motion.view >= mViews.size())
        return makeError(
            "motion blur: motion.view is {}, framesInFlight {}", inputs.motion.view, mViews.size()
        );
    SHUTTER_TRY(validate(settings));
    return checkMethod(inputs, settings);
}

core::Status EmbeddedMotionBlur::record(
    VkCommandBuffer commands,
    uint32_t frame,
    const HostInputs& inputs,
    const MotionBlurSettings& settings
) {
    core::Status done = checkAndRecord(commands, frame, inputs, settings);
    // The view has no such frame, or not a whole one.
    if (!done && inputs.motion.view < mViews.size())
        mViews[inputs.motion.view]->last.reset();
    return done;
}

core::Status EmbeddedMotionBlur::checkAndRecord(
    VkCommandBuffer commands,
    uint32_t frame,
    const HostInputs& inputs,
    const MotionBlurSettings& settings
) {
    mHasLeftAPart = false;
    try {
        SHUTTER_TRY(check(commands, frame, inputs, settings));
        markDone(frame);
        mHasLeftAPart = true;
        core::Status done = recordInto(*mSlots[frame], commands, inputs, settings);
        mHasLeftAPart = !done;
        return done;
    } catch (const gpu::DeviceError& error) {
        return core::Error{error.what()};
    } catch (const std::bad_alloc&) {
        return makeError("motion blur: out of main memory");
    }
}

void EmbeddedMotionBlur::markDone(uint32_t frame) {
    SHUTTER_CHECK(frame < mSlots.size(), "frame {} of {}", frame, mSlots.size());
    mDevice->markDone(mSlots[frame]->handedOver);
}

void EmbeddedMotionBlur::closeView(uint32_t view) {
    SHUTTER_CHECK(view < mViews.size(), "view {} of {}", view, mViews.size());
    mViews[view]->forget();
}

InstantMotions EmbeddedMotionBlur::describeInstants(
    Slot& slot, View& view, const HostInputs& inputs, const MotionBlurSettings& settings
) {
    if (!settings.history)
        view.forget();
    const HostRaster* last = inputs.motion.followsLast && view.last ? &*view.last : nullptr;
    HostInstants made = computeHostInstants(inputs.motion, describeFrame(inputs, settings), last);
    InstantMotions motions;
    motions.table = writeInstantLayers(*mDevice, made.layers, slot.instants);
    motions.instantCount = countInstants(settings);
    motions.hasLast = made.layers.last.has_value();
    if (settings.history) {
        motions.history = &view.history;
        view.last = std::move(made.raster);
    }
    return motions;
}

MotionBlurInputs EmbeddedMotionBlur::prepare(Frame& frame) const {
    const HostInputs& inputs = frame.inputs;
    const VkExtent2D picture = pictureOf(inputs);
    graph::Graph& graph = frame.graph;
    gpu::Device& device = *mDevice;
    MotionBlurInputs own; // slot 0 in each frame: it is for counters
    own.wantsCounters = false;
    frame.color = frame.import(device, "color", inputs.color, colorRule(inputs));
    frame.output = frame.import(device, "output", inputs.output, outputRule(inputs));
    const bool isOwnColor = isOwn(inputs.color, kColorFormat, picture);
    own.color =
        isOwnColor ? frame.color : mPreparation.addColor(graph, frame.color, inputs.color, picture);
    own.colorIsWritable = !isOwnColor || !inputs.output.image;
    if (inputs.output.image && isOwn(inputs.output, kColorFormat, picture))
        own.target = frame.output;
    else if (!inputs.output.image && isOwnColor)
        own.target = frame.color;
    // Those the method does not read are imported as well: they go over to their next use.
    if (inputs.motionDepth.image) {
        own.motionDepth = frame.import(device, "motion and depth", inputs.motionDepth, kMotionRule);
    } else {
        const HostConvention& convention = inputs.convention;
        const auto vectors =
            frame.import(device, "motion vectors", convention.vectors.image, kVectorsRule);
        const auto depth = frame.import(device, "depth", convention.depth.image, kDepthRule);
        const auto scales =
            frame.import(device, "blur scale", convention.scales.perPixel, kBlurScaleRule);
        const shader::PrepareTable table = makePrepareTable(convention, picture);
        if (!frame.slot.convention)
            frame.slot.convention = gpu::Buffer(
                device,
                "convention",
                sizeof(table),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                gpu::MemoryUse::Stream
            );
        frame.slot.convention.writeBytes(&table, sizeof(table), 0);
        own.motionDepth = mPreparation.addMotionDepth(
            graph, vectors, depth, scales, frame.slot.convention.address(), picture
        );
    }
    own.normal = frame.import(device, "normal", inputs.normal, kNormalRule);
    if (own.normal.isValid() && !isOwn(inputs.normal, kColorFormat, picture))
        own.normal = mPreparation.addNormal(graph, own.normal, inputs.normal, picture);
    own.entityId = frame.import(device, "entity id", inputs.entityId, kIdRule);
    if (own.entityId.isValid() &&
        (!isOwn(inputs.entityId, kIdFormat, picture) || inputs.noEntity != shader::kNoEntity))
        own.entityId =
            mPreparation.addIds(graph, own.entityId, inputs.entityId, inputs.noEntity, picture);
    return own;
}

void EmbeddedMotionBlur::deliver(Frame& frame, graph::ImageHandle picture) const {
    const bool inPlace = !frame.inputs.output.image;
    const HostImage& given = inPlace ? frame.inputs.color : frame.inputs.output;
    if (!isOwn(given, kColorFormat, pictureOf(frame.inputs)))
        picture = mPreparation.addDelivery(
            frame.graph,
            picture,
            inPlace ? frame.color : frame.output,
            given.format == VK_FORMAT_UNDEFINED ? kColorFormat : given.format,
            given.area.offset
        );
    frame.graph.markOutput(picture);
}

core::Status EmbeddedMotionBlur::recordInto(
    Slot& slot,
    VkCommandBuffer commands,
    const HostInputs& inputs,
    const MotionBlurSettings& settings
) {
    slot.images.clear();
    graph::Graph graph;
    Frame frame{slot, graph, inputs};
    MotionBlurInputs own = prepare(frame);
    own.rasterTime = inputs.rasterTime;
    own.response = gpu::splitAddress(inputs.response);
    own.frameNumber = inputs.frameNumber;
    const Method& method = *settings.method;
    if (method.rays == RayNeed::Any && inputs.reveal.record) {
        own.reveal = &inputs.reveal;
    } else if (method.rays == RayNeed::Any || method.readsCamera) {
        graph::RayScene rays{.frameConstants = inputs.rays.frameConstants};
        if (method.rays == RayNeed::Any && inputs.rays.tlas) {
            rays.tlasBuffer = graph.importBuffer("TLAS", inputs.rays.tlasBuffer, 0);
            rays.tlas = inputs.rays.tlas;
            rays.textures = inputs.rays.scene;
            rays.hasBlended = inputs.rays.hasBlended;
        }
        own.rays = rays;
    }
    View& view = *mViews[inputs.motion.view];
    if (method.readsInstantMotions)
        own.instantMotions = describeInstants(slot, view, inputs, settings);
    else
        view.forget();
    deliver(frame, mEffect.add(graph, own, settings).color);

    slot.frame->beginIn(commands);
    slot.pool.keepFor(inputs.width, inputs.height);
    const auto plan = graph::execute(graph, *slot.frame, slot.pool);
    if (!plan)
        return plan.error();
    slot.handedOver = mDevice->handOver();
    return {};
}

} // namespace shutter::motion_blur
