// SPDX-License-Identifier: MIT
// A frame of an EmbeddedMotionBlur as a graph: the host's images, what prepares them, the effect,
// and what delivers its picture.
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "modules/motion_blur/embedding/embedded_parts.h"
#include "modules/motion_blur/embedding/host_dump.h"
#include "modules/motion_blur/embedding/host_overlay.h"
#include "shaders/render/scene_shared.h"

#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

/// Where shaders find the table for this frame.
template <class Table>
VkDeviceAddress
writeTable(gpu::Device& device, gpu::Buffer& buffer, const char* name, const Table& table) {
    if (!buffer)
        buffer = gpu::Buffer(
            device, name, sizeof(table), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Stream
        );
    buffer.writeBytes(&table, sizeof(table), 0);
    return buffer.address();
}

/// Ids beside depth are in the stencil.
graph::ImageHandle viewIds(graph::ImageHandle image, const HostImage& given) {
    constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    return gpu::aspectOf(given.format) == kBoth ? graph::stencilOf(image) : image;
}

} // namespace

graph::ImageHandle EmbeddedMotionBlur::Frame::import(
    gpu::Device& device, const char* name, const HostImage& given, const HostImageRule& rule
) {
    if (!given.image)
        return {};
    const VkExtent2D extent = extentOf(given, pictureOf(inputs));
    gpu::ImageDesc desc{extent.width, extent.height, formatOf(given, rule)};
    // Only what shaders do counts here: it is what views are for. An image of nothing has none.
    desc.usage = rule.usage & (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    if (isImagined)
        desc.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    desc.layer = given.layer;
    const gpu::Image& image =
        slot.images.emplace_back(gpu::Image::adopt(device, name, given.image, desc));
    return graph.importImage(name, image, given.before, given.after);
}

InstantMotions EmbeddedMotionBlur::describeInstants(Frame& frame, View& view) {
    const HostInputs& inputs = frame.inputs;
    const bool keeps = frame.settings.history;
    std::optional<LentRaster> lent = prepareLast(frame);
    if (!keeps)
        view.forget();
    else if (lent)
        view.history.forget();
    std::vector<HostMover> movers;
    HostMotion motion = countedMotion(inputs, movers);
    motion.response = frame.response();
    const HostRaster* last = motion.followsLast && view.last ? &*view.last : nullptr;
    HostInstants made = computeHostInstants(motion, describeFrame(inputs, frame.settings), last);
    InstantMotions motions;
    const WrittenLayers written = writeInstantLayers(
        *mDevice, made.layers, {inputs.width, inputs.height}, frame.slot.instants
    );
    motions.table = written.table;
    motions.mayHide = frame.hasAll || written.mayHide;
    motions.hasLens = seesThroughLens(inputs, frame.settings);
    motions.instantCount = countInstants(frame.settings, motions.hasLens);
    motions.hasLast = made.layers.last.has_value();
    const bool hasAll = frame.hasAll && inputs.entityId.image;
    motions.deforms[size_t(LayerIndex::Raster)] = hasAll || made.layers.raster.deforms;
    motions.deforms[size_t(LayerIndex::Last)] = motions.hasLast &&
                                                frame.images.lastDeformed.isValid() &&
                                                (hasAll || made.layers.last->deforms);
    motions.drawWays = prepareWays(frame);
    motions.mayCrowd = hasAll || mayCrowdTiles(made.layers);
    if (!keeps)
        return motions;
    if (lent)
        motions.lent = lent;
    else
        motions.history = &view.history;
    view.last = std::move(made.raster);
    return motions;
}

graph::ImageHandle EmbeddedMotionBlur::prepareMotion(Frame& frame) const {
    const HostInputs& inputs = frame.inputs;
    gpu::Device& device = *mDevice;
    if (inputs.motionDepth.image) {
        frame.images.motionDepth =
            frame.import(device, "motion and depth", inputs.motionDepth, kMotionRule);
        return frame.wantsCameraMotion() ? prepareCameraMotion(frame, frame.images.motionDepth)
                                         : frame.images.motionDepth;
    }
    const HostConvention& convention = inputs.convention;
    ImportedInputs& images = frame.images;
    images.vectors = frame.import(device, "motion vectors", convention.vectors.image, kVectorsRule);
    images.depth = frame.import(device, "depth", convention.depth.image, kDepthRule);
    images.blurScale =
        frame.import(device, "blur scale", convention.scales.perPixel, kBlurScaleRule);
    if (inputs.isOff) // the convention was not checked
        return {};
    if (frame.wantsCameraMotion())
        return prepareCameraMotion(frame, images.depth);
    const VkExtent2D picture = pictureOf(inputs);
    const shader::PrepareTable table = makePrepareTable(convention, picture);
    const VkDeviceAddress address = writeTable(device, frame.slot.convention, "convention", table);
    return mPreparation.addMotionDepth(
        frame.graph, images.vectors, images.depth, images.blurScale, address, picture
    );
}

graph::ImageHandle
EmbeddedMotionBlur::prepareCameraMotion(Frame& frame, graph::ImageHandle depth) const {
    const HostInputs& inputs = frame.inputs;
    const VkExtent2D picture = pictureOf(inputs);
    const bool isPacked = inputs.motionDepth.image != VK_NULL_HANDLE;
    HostConvention convention = inputs.convention;
    if (isPacked) {
        convention = describeMotionDepth(inputs.motionDepth, inputs.convention);
        convention.scales = inputs.convention.scales;
        convention.scales.perPixel = {};
    }
    convention.vectors = {};
    shader::PrepareTable table = makePrepareTable(convention, picture);
    if (isPacked)
        table.flags |= shader::kPrepareDepthIsThird;
    const VkDeviceAddress address =
        writeTable(*mDevice, frame.slot.convention, "convention", table);
    return mPreparation.addMotionDepth(
        frame.graph, {}, depth, frame.images.blurScale, address, picture
    );
}

graph::ImageHandle EmbeddedMotionBlur::showInputs(
    Frame& frame, const MotionBlurInputs& effectInputs, graph::ImageHandle picture
) const {
    MotionBlurInputs given = effectInputs;
    given.entityId = frame.images.entityId.isValid() ? effectInputs.entityId : graph::ImageHandle();
    const shader::OverlayTable table = makeOverlayTable(frame.inputs, given);
    const VkDeviceAddress address = writeTable(*mDevice, frame.slot.overlay, "overlay", table);
    return mOverlay->add(frame.graph, given, picture, address);
}

std::optional<LentRaster> EmbeddedMotionBlur::prepareLast(Frame& frame) const {
    const HostInputs& inputs = frame.inputs;
    const HostLastFrame& last = inputs.last;
    if (!last.color.image || !last.motionDepth.image)
        return std::nullopt; // checked by methods that look it up
    const VkExtent2D picture = pictureOf(inputs);
    LentRaster lent;
    lent.color = frame.import(*mDevice, "last colour", last.color, kLastColorRule);
    if (!isNativeColor(last.color, inputs.transfer, picture))
        lent.color =
            mPreparation.addColor(frame.graph, lent.color, last.color, inputs.transfer, picture);
    lent.motionDepth =
        frame.import(*mDevice, "last motion and depth", last.motionDepth, kLastMotionRule);
    lent.entityId = viewIds(
        frame.import(*mDevice, "last entity id", last.entityId, kLastIdRule), last.entityId
    );
    if (!lent.entityId.isValid())
        lent.entityId = mPreparation.addWorldIds(frame.graph, lent.motionDepth, picture);
    else if (!isNativeImage(last.entityId, kHostIdFormat, picture) || inputs.noEntity != shader::kNoEntity)
        lent.entityId = mPreparation.addIds(
            frame.graph, lent.entityId, last.entityId, inputs.noEntity, picture
        );
    return lent;
}

DrawWays EmbeddedMotionBlur::prepareWays(const Frame& frame) const {
    const HostInputs& inputs = frame.inputs;
    if (!frame.images.deformed.isValid())
        return {};
    return [this, &inputs, &images = frame.images](
               graph::Graph& graph, LayerIndex layer, graph::ImageHandle, uint32_t
           ) {
        const VkExtent2D picture = pictureOf(inputs);
        if (layer == LayerIndex::Raster)
            return mPreparation.addWays(
                graph, images.deformed, inputs.deformedMotion, float(inputs.rasterTime), picture
            );
        return mPreparation.addWays(
            graph,
            images.lastDeformed,
            inputs.lastDeformedMotion,
            float(timeOfFrameBefore(inputs)),
            picture
        );
    };
}

VkDeviceAddress EmbeddedMotionBlur::giveResponse(Frame& frame) const {
    if (frame.inputs.responsePoints.empty())
        return frame.inputs.response;
    frame.responseTable = math::makeResponseTable(frame.inputs.responsePoints);
    if (!frame.responseTable)
        return 0; // a box
    return writeTable(*mDevice, frame.slot.response, "shutter response", *frame.responseTable);
}

MotionBlurInputs EmbeddedMotionBlur::prepare(Frame& frame) const {
    const HostInputs& inputs = frame.inputs;
    const VkExtent2D picture = pictureOf(inputs);
    graph::Graph& graph = frame.graph;
    gpu::Device& device = *mDevice;
    MotionBlurInputs effectInputs;
    effectInputs.slot = frame.number;
    effectInputs.wantsCounters = frame.wantsCounters;
    effectInputs.rasterTime = inputs.rasterTime;
    effectInputs.response = gpu::splitAddress(giveResponse(frame));
    effectInputs.frameNumber = inputs.frameNumber;
    frame.images.color = frame.import(device, "color", inputs.color, colorRule(inputs));
    frame.output = frame.import(device, "output", inputs.output, outputRule(inputs));
    const bool isNative = isNativeColor(inputs.color, inputs.transfer, picture);
    // A host's alpha has any meaning, and the lens's filter reads radii there.
    const bool isRead = isNative && (inputs.isOff || !seesThroughLens(inputs, frame.settings));
    effectInputs.color = isRead
                             ? frame.images.color
                             : mPreparation.addColor(
                                   graph, frame.images.color, inputs.color, inputs.transfer, picture
                               );
    if (!isIdentity(decodingOf(inputs.transfer, inputs.color.format)))
        frame.images.light = effectInputs.color;
    effectInputs.colorIsWritable = !isRead || !inputs.output.image;
    if (inputs.output.image && isNativeColor(inputs.output, inputs.transfer, picture))
        effectInputs.target = frame.output;
    else if (!inputs.output.image && isNative)
        effectInputs.target = frame.images.color;
    // Those the method does not read are imported as well: they go over to their next use.
    effectInputs.motionDepth = prepareMotion(frame);
    effectInputs.motionIsCameras = frame.wantsCameraMotion();
    effectInputs.normal = frame.images.normal =
        frame.import(device, "normal", inputs.normal, kNormalRule);
    if (effectInputs.normal.isValid() && !isNativeImage(inputs.normal, kHostColorFormat, picture))
        effectInputs.normal =
            mPreparation.addNormal(graph, effectInputs.normal, inputs.normal, picture);
    frame.images.deformed =
        frame.import(device, "deformed motion", inputs.deformedMotion, kDeformedRule);
    frame.images.lastDeformed =
        frame.import(device, "last deformed motion", inputs.lastDeformedMotion, kLastDeformedRule);
    frame.images.blended = frame.import(device, "blended", inputs.blended, kBlendedRule);
    const bool areShared = sharesDepth(inputs) && frame.images.depth.isValid();
    effectInputs.entityId = frame.images.entityId = viewIds(
        areShared ? frame.images.depth
                  : frame.import(device, "entity id", inputs.entityId, kIdRule),
        inputs.entityId
    );
    if (effectInputs.entityId.isValid() &&
        (!isNativeImage(inputs.entityId, kHostIdFormat, picture) ||
         inputs.noEntity != shader::kNoEntity))
        effectInputs.entityId = mPreparation.addIds(
            graph, effectInputs.entityId, inputs.entityId, inputs.noEntity, picture
        );
    if (!effectInputs.entityId.isValid() && frame.settings.method->readsInstantMotions &&
        !inputs.isOff)
        effectInputs.entityId = mPreparation.addWorldIds(graph, effectInputs.motionDepth, picture);
    if (hasViewModel(inputs) && effectInputs.entityId.isValid() && !inputs.isOff)
        effectInputs.entityId = mPreparation.addViewModel(
            graph,
            effectInputs.entityId,
            frame.images.depth,
            frame.slot.convention.address(),
            isOneWorld(inputs) ? 1 : inputs.motion.rowCount,
            picture
        );
    return effectInputs;
}

graph::ImageHandle EmbeddedMotionBlur::addBlended(
    Frame& frame, graph::ImageHandle picture, graph::BufferHandle surfaces
) {
    const HostInputs& inputs = frame.inputs;
    if (frame.drawn) {
        const auto parts = addHostBlended(frame.graph, inputs.drawn, *frame.drawn, surfaces);
        if (frame.isDumped)
            mDump->addDrawn(frame.graph, frame.number, parts);
        picture = mComposite.add(
            frame.graph,
            picture,
            [&](uint32_t part) { return parts[part]; },
            frame.drawn->rectangle,
            surfaces
        );
    }
    if (!frame.images.blended.isValid())
        return picture;
    const VkExtent2D size = pictureOf(inputs);
    graph::ImageHandle blended = frame.images.blended;
    if (!isWhole(inputs.blended, size))
        blended = mPreparation.addNormal(frame.graph, blended, inputs.blended, size);
    shader::InstantSurfaces whole{};
    whole.sizePx = {size.width, size.height};
    whole.instantCount = whole.partCount = 1;
    return mComposite.add(
        frame.graph,
        picture,
        [&](uint32_t) -> BlendedSums {
            return {blended, {}, 1.0f};
        },
        whole,
        {}
    );
}

void EmbeddedMotionBlur::deliver(Frame& frame, graph::ImageHandle picture) const {
    const HostInputs& inputs = frame.inputs;
    const bool inPlace = !inputs.output.image;
    const HostImage& given = inPlace ? inputs.color : inputs.output;
    if (inputs.isOff && inPlace && !inputs.blended.image && !inputs.drawn.record)
        picture = frame.images.color; // nothing is written
    else if ((inputs.isOff && !inPlace) || !isNativeColor(given, inputs.transfer, pictureOf(inputs)))
        picture = mPreparation.addDelivery(
            frame.graph,
            picture,
            inPlace ? frame.images.color : frame.output,
            given.format == VK_FORMAT_UNDEFINED ? kHostColorFormat : given.format,
            inputs.transfer,
            given.area.offset
        );
    frame.graph.markOutput(picture);
}

void EmbeddedMotionBlur::declare(Frame& frame, View& view) {
    const HostInputs& inputs = frame.inputs;
    const Method& method = *frame.settings.method;
    MotionBlurInputs effectInputs = prepare(frame);
    if (inputs.drawn.record)
        frame.drawn = describeDrawn(inputs, frame.settings, frame.response());
    if (frame.drawn && findsSurfaces(inputs, frame.settings))
        effectInputs.surfaces = {frame.drawn->rectangle};
    if (inputs.isOff) {
        view.forget();
        (void)prepareLast(frame);
        if ((frame.images.blended.isValid() || frame.drawn) && !effectInputs.colorIsWritable)
            effectInputs.color = mPreparation.addColor(
                frame.graph, effectInputs.color, inputs.color, inputs.transfer, pictureOf(inputs)
            );
        deliver(frame, addBlended(frame, effectInputs.color, {}));
        return;
    }
    if (frame.isHosts && mChecker)
        mChecker->add(frame.graph, frame.number, inputs, frame.images, frame.settings);
    frame.isDumped = frame.isHosts && mDump && mDump->wantsFrame();
    if (frame.isDumped && mDump->startsView(inputs.motion.view))
        view.forget();
    if (frame.isDumped) {
        mDump->add(
            frame.graph, frame.number, inputs, frame.images, frame.settings, frame.response()
        );
        frame.dumpedReveal = mDump->wrapReveal(inputs, frame.number, *frame.slot.frame);
    }
    if (method.rays == RayNeed::Query)
        effectInputs.samples = &inputs.samples;
    if (method.rays == RayNeed::Any && inputs.reveal.record) {
        effectInputs.reveal = frame.isDumped ? &frame.dumpedReveal : &inputs.reveal;
    } else if (method.rays == RayNeed::Any || (method.readsCamera && !effectInputs.motionIsCameras)) {
        graph::RayScene rays{.frameConstants = inputs.rays.frameConstants};
        if (method.rays == RayNeed::Any && inputs.rays.tlas) {
            rays.tlasBuffer = frame.graph.importBuffer("TLAS", inputs.rays.tlasBuffer, 0);
            rays.tlas = inputs.rays.tlas;
            rays.textures = inputs.rays.scene;
            rays.hasBlended = inputs.rays.hasBlended;
        }
        effectInputs.rays = rays;
    }
    if (method.readsInstantMotions) {
        effectInputs.instantMotions = describeInstants(frame, view);
    } else {
        view.forget();
        (void)prepareLast(frame);
    }
    const MotionBlurOutputs made = mEffect.add(frame.graph, effectInputs, frame.settings);
    if (inputs.observe)
        inputs.observe(frame.graph, effectInputs, made);
    const graph::ImageHandle picture = addBlended(
        frame, made.color, made.surfaces.empty() ? graph::BufferHandle{} : made.surfaces.front()
    );
    if (frame.isDumped)
        mDump->addPicture(frame.graph, frame.number, picture);
    deliver(frame, inputs.showsInputs ? showInputs(frame, effectInputs, picture) : picture);
}

core::Status EmbeddedMotionBlur::record(Frame& frame, View& view, VkCommandBuffer commands) {
    frame.slot.images.clear();
    declare(frame, view);
    frame.slot.frame->beginIn(commands);
    frame.slot.pool.keepFor(frame.inputs.width, frame.inputs.height);
    const auto plan = graph::execute(frame.graph, *frame.slot.frame, frame.slot.pool);
    if (!plan)
        return plan.error();
    return {};
}

} // namespace shutter::motion_blur
