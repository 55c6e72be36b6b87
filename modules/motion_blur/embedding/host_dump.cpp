// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_dump.h"

#include "spirv/motion_blur/dump_ids.comp.h"
#include "spirv/motion_blur/dump_image.comp.h"
#include "spirv/motion_blur/dump_picture.comp.h"
#include "spirv/motion_blur/dump_reveal.comp.h"

#include "engine/core/whole_file.h"
#include "engine/core/words.h"
#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/embedding/host_blended.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/common/shutter_response_shared.h"
#include "shaders/motion_blur/dump_shared.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <deque>
#include <exception>
#include <span>
#include <system_error>
#include <utility>

namespace shutter::motion_blur {

namespace {

using core::makeError;
using graph::Access;
using nlohmann::ordered_json;

/// Error: names the file and why.
core::Status writeDumpFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    const core::Status written = core::writeWholeFile(path, bytes);
    return written ? written : makeError("'{}': {}", path.string(), written.error().message);
}

// Push constants, as the shaders declare them.
struct DumpImagePush {
    glm::uvec2 sizePx;
    glm::uvec2 target;
    uint32_t texels; ///< the picture's: the serial
};

struct RevealPush {
    glm::uvec2 sizePx;
    glm::uvec2 color;
    glm::uvec2 motionDepth;
    glm::uvec2 entityId;
};

gpu::ComputePipelineDesc describeDump(
    const char* name,
    std::span<const uint32_t> spirv,
    std::vector<VkDescriptorType> bindings,
    uint32_t pushBytes
) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.bindings = std::move(bindings);
    desc.interface.pushConstantBytes = pushBytes;
    return desc;
}

const char* nameTexels(uint32_t texels) {
    switch (texels) {
    case shader::kDumpHalf4:
        return "half4";
    case shader::kDumpFloat1:
        return "float1";
    case shader::kDumpFloat2:
        return "float2";
    case shader::kDumpFloat4:
        return "float4";
    default:
        return "uint1";
    }
}

uint32_t bytesOf(uint32_t texels) {
    return texels == shader::kDumpHalf4 ? 8 : texels == shader::kDumpUint1 ? 4 : 4 * texels;
}

uint32_t chooseTexels(const HostImage& image) {
    const bool isHalf =
        image.format == VK_FORMAT_UNDEFINED || image.format == VK_FORMAT_R16G16B16A16_SFLOAT;
    return isHalf ? shader::kDumpHalf4 : shader::kDumpFloat4;
}

/// Names an image of the host's drawing in a part of the exposure.
std::string nameDrawn(uint32_t part, bool isOpacity) {
    return fmt::format("drawn{}{}", isOpacity ? "Opacity" : "Color", part);
}

/// Waits for the host's commands, which wrote the images by shaders.
void recordBarrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void dispatch(VkCommandBuffer commands, const glm::uvec2& sizePx) {
    const glm::uvec2 groups = (sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
    vkCmdDispatch(commands, groups.x, groups.y, 1);
}

} // namespace

/// An image's texels in the slot's buffer.
struct HostDump::Plane {
    std::string name;
    uint32_t texels = 0;
    VkExtent2D extent{0, 0};
    VkDeviceSize offset = 0;
    VkDeviceSize bytes = 0;
};

struct HostDump::Slot {
    gpu::Buffer buffer;
    graph::BufferHandle handle;      ///< of the recording under way
    std::deque<Plane> planes;        ///< a deque: passes refer to them
    std::deque<gpu::Image> revealed; ///< views of the images of the reveal
    VkDeviceSize bytes = 0;
    ordered_json manifest;
    std::vector<std::byte> response;
    std::filesystem::path folder;
    uint32_t number = 0;
    uint32_t serial = 0;
    bool isPending = false;
};

/// An image that the host gave, to be read.
struct HostDump::Input {
    const char* name;
    const HostImage* given;
    graph::ImageHandle image;
    uint32_t texels;
};

std::vector<HostDump::Input>
HostDump::listInputs(const HostInputs& inputs, const ImportedInputs& images) {
    const HostConvention& convention = inputs.convention;
    static const HostImage kLight; // of the picture's size
    const bool isLight = images.light.isValid();
    std::vector<Input> list{
        {"color",
         isLight ? &kLight : &inputs.color,
         isLight ? images.light : images.color,
         chooseTexels(isLight ? kLight : inputs.color)},
        {"motionDepth", &inputs.motionDepth, images.motionDepth, shader::kDumpFloat4},
        {"vectors", &convention.vectors.image, images.vectors, shader::kDumpFloat2},
        {"depth", &convention.depth.image, images.depth, shader::kDumpFloat1},
        {"blurScale", &convention.scales.perPixel, images.blurScale, shader::kDumpFloat1},
        {"normal", &inputs.normal, images.normal, chooseTexels(inputs.normal)},
        {"entityId", &inputs.entityId, images.entityId, shader::kDumpUint1},
        {"deformedMotion",
         &inputs.deformedMotion,
         images.deformed,
         chooseTexels(inputs.deformedMotion)},
        {"lastDeformedMotion",
         &inputs.lastDeformedMotion,
         images.lastDeformed,
         chooseTexels(inputs.lastDeformedMotion)},
        {"blended", &inputs.blended, images.blended, chooseTexels(inputs.blended)}};
    std::erase_if(list, [](const Input& input) { return !input.image.isValid(); });
    return list;
}

HostDump::HostDump(gpu::Device& device, uint32_t frames, HostMessage message)
    : mDevice(device), mMessage(std::move(message)),
      mImage(
          device,
          describeDump("dump image", motion_blur_dump_image_comp, {kSampled}, sizeof(DumpImagePush))
      ),
      mIds(
          device,
          describeDump("dump ids", motion_blur_dump_ids_comp, {kSampled}, sizeof(DumpImagePush))
      ),
      mPicture(
          device,
          describeDump(
              "dump picture", motion_blur_dump_picture_comp, {kStorage}, sizeof(DumpImagePush)
          )
      ),
      mReveal(
          device,
          describeDump(
              "dump reveal",
              motion_blur_dump_reveal_comp,
              {kStorage, kStorage, kStorage},
              sizeof(RevealPush)
          )
      ),
      mHasView(frames, true) {
    for (uint32_t i = 0; i < frames; ++i)
        mSlots.push_back(std::make_unique<Slot>());
}

HostDump::~HostDump() = default;

core::Status HostDump::start(const std::filesystem::path& folder, uint32_t frameCount) {
    if (mLeft > 0)
        return makeError(
            "motion blur dump: {} of the last dump {} to come",
            core::countOf(mLeft, "recording"),
            mLeft == 1 ? "is" : "are"
        );
    if (frameCount == 0 || frameCount > 9999)
        return makeError("motion blur dump: frames is {}, it must be 1 to 9999", frameCount);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return makeError("motion blur dump: '{}': {}", folder.string(), error.message());
    if (std::filesystem::exists(folder / "frame_0000.json", error))
        return makeError("motion blur dump: '{}' holds a dump already", folder.string());
    mFolder = folder;
    mLeft = frameCount;
    mNext = 0;
    mHasView.assign(mSlots.size(), false);
    return {};
}

bool HostDump::startsView(uint32_t view) const {
    return mLeft > 0 && !mHasView[view];
}

HostDump::Plane&
HostDump::addPlane(Slot& slot, const char* name, uint32_t texels, VkExtent2D extent) const {
    Plane& plane = slot.planes.emplace_back();
    plane.name = name;
    plane.texels = texels;
    plane.extent = extent;
    plane.offset = slot.bytes;
    plane.bytes = VkDeviceSize(extent.width) * extent.height * bytesOf(texels);
    slot.bytes += plane.bytes;
    return plane;
}

void HostDump::add(
    graph::Graph& graph,
    uint32_t frame,
    const HostInputs& inputs,
    const ImportedInputs& images,
    const MotionBlurSettings& settings,
    const shader::ResponseTable* response
) {
    Slot& slot = *mSlots[frame];
    slot.planes.clear();
    slot.revealed.clear();
    slot.bytes = 0;
    slot.response.clear();
    slot.folder = mFolder;
    slot.number = mNext++;
    slot.serial = ++mSerial;
    slot.isPending = true;
    --mLeft;
    mHasView[inputs.motion.view] = true;

    slot.manifest =
        describeInputs(inputs, settings, images.motionDepth.isValid(), response != nullptr);
    slot.manifest["device"] = mDevice.info().name;
    slot.manifest["driver"] = mDevice.info().driver;
    if (response) {
        const auto bytes = std::as_bytes(std::span(response, 1));
        slot.response.assign(bytes.begin(), bytes.end());
    }

    const std::vector<Input> list = listInputs(inputs, images);
    addPlanes(slot, inputs, settings, list);
    slot.buffer =
        gpu::Buffer(mDevice, "dump", slot.bytes + sizeof(uint32_t), 0, gpu::MemoryUse::Readback);
    slot.handle = graph.importBuffer("dump", slot.buffer.handle(), slot.buffer.bytes());
    for (size_t i = 0; i < list.size(); ++i)
        addImagePass(graph, slot, list[i].image, slot.planes[i]);
}

/// A plane for each image of the list, for each that the host's reveal writes, and for the picture.
void HostDump::addPlanes(
    Slot& slot,
    const HostInputs& inputs,
    const MotionBlurSettings& settings,
    std::span<const Input> list
) const {
    const VkExtent2D picture{inputs.width, inputs.height};
    ordered_json& files = slot.manifest["images"] = ordered_json::object();
    const auto add =
        [&](const char* name, uint32_t texels, VkExtent2D extent, VkRect2D area, VkFormat format) {
            const Plane& plane = addPlane(slot, name, texels, extent);
            files[plane.name] = {
                {"file", fmt::format("frame_{:04}_{}.bin", slot.number, plane.name)},
                {"texels", nameTexels(plane.texels)},
                {"width", plane.extent.width},
                {"height", plane.extent.height},
                {"area", {area.offset.x, area.offset.y, area.extent.width, area.extent.height}},
                {"format", gpu::nameFormat(format)}};
        };
    const auto addWhole = [&](const char* name, uint32_t texels) {
        add(name, texels, picture, {{0, 0}, picture}, VK_FORMAT_UNDEFINED);
    };
    for (const Input& input : list)
        add(input.name,
            input.texels,
            extentOf(*input.given, picture),
            areaOf(*input.given, picture),
            input.given->format);
    if (settings.method->rays == RayNeed::Any && inputs.reveal.record) {
        addWhole("revealColor", shader::kDumpHalf4);
        addWhole("revealMotionDepth", shader::kDumpFloat4);
        addWhole("revealEntityId", shader::kDumpUint1);
    }
    if (inputs.drawn.record) {
        const shader::InstantSurfaces head = describeDrawn(inputs, settings, nullptr).rectangle;
        const VkExtent2D size{head.sizePx.x, head.sizePx.y};
        for (uint32_t part = 0; part < head.partCount; ++part)
            for (const bool isOpacity : {false, true})
                if (!isOpacity || !inputs.drawn.isOpacityInAlpha)
                    add(nameDrawn(part, isOpacity).c_str(),
                        shader::kDumpHalf4,
                        size,
                        {{0, 0}, size},
                        VK_FORMAT_UNDEFINED);
    }
    addWhole("picture", shader::kDumpHalf4);
}

void HostDump::addDrawn(
    graph::Graph& graph, uint32_t frame, const std::vector<BlendedSums>& parts
) {
    Slot& slot = *mSlots[frame];
    for (uint32_t part = 0; part < parts.size(); ++part)
        for (const bool isOpacity : {false, true})
            for (const Plane& plane : slot.planes)
                if (plane.name == nameDrawn(part, isOpacity))
                    addImagePass(
                        graph, slot, isOpacity ? parts[part].opacity : parts[part].color, plane
                    );
}

void HostDump::addImagePass(
    graph::Graph& graph, Slot& slot, graph::ImageHandle image, const Plane& plane
) const {
    struct Data {
        graph::ImageHandle image;
        graph::BufferHandle buffer;
    };

    const bool isPicture = plane.name == "picture";
    const gpu::LazyPipeline& pipeline = isPicture                            ? mPicture
                                        : plane.texels == shader::kDumpUint1 ? mIds
                                                                             : mImage;
    const DumpImagePush push{
        {plane.extent.width, plane.extent.height},
        gpu::splitAddress(slot.buffer.address() + plane.offset),
        isPicture ? slot.serial : plane.texels};
    slot.handle = graph
                      .addPass<Data>(
                          "dump " + plane.name,
                          graph::PassKind::Compute,
                          [&](graph::PassBuilder& builder, Data& data) {
                              data.image = builder.read(
                                  image, isPicture ? Access::StorageRead : Access::SampledCompute
                              );
                              data.buffer = builder.write(slot.handle, Access::StorageWrite);
                          },
                          [&pipeline, push, isPicture, sampler = mDevice.nearestSampler()](
                              const Data& data, graph::PassContext& context
                          ) {
                              gpu::BindingList bindings;
                              if (isPicture)
                                  bindings.storage(context.resources.image(data.image));
                              else
                                  bindings.sampled(context.resources.view(data.image), sampler);
                              context.frame.bind(pipeline.get(), bindings, &push, sizeof(push));
                              dispatch(context.commands, push.sizePx);
                          }
                      )
                      .buffer;
}

void HostDump::addPicture(graph::Graph& graph, uint32_t frame, graph::ImageHandle picture) {
    struct Data {};

    Slot& slot = *mSlots[frame];
    addImagePass(graph, slot, picture, slot.planes.back());
    graph.addPass<Data>(
        "read dump",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data&) {
            builder.read(slot.handle, Access::HostRead);
            builder.sideEffect();
        },
        [](const Data&, graph::PassContext&) {}
    );
}

HostReveal HostDump::wrapReveal(const HostInputs& inputs, uint32_t frame, gpu::Frame& recorder) {
    HostReveal wrapped;
    wrapped.byRayPipeline = inputs.reveal.byRayPipeline;
    wrapped.record = [this, &inputs, &recorder, slot = mSlots[frame].get()](const RevealTask& task
                     ) {
        inputs.reveal.record(task);
        const auto addressOf = [&](std::string_view name) {
            for (const Plane& plane : slot->planes)
                if (plane.name == name)
                    return gpu::splitAddress(slot->buffer.address() + plane.offset);
            return glm::uvec2(0u);
        };
        const auto adopt = [&](VkImage image, VkFormat format) -> const gpu::Image& {
            return slot->revealed.emplace_back(gpu::Image::adopt(
                mDevice,
                "revealed",
                image,
                {task.width, task.height, format, VK_IMAGE_USAGE_STORAGE_BIT}
            ));
        };
        const RevealPush push{
            {task.width, task.height},
            addressOf("revealColor"),
            addressOf("revealMotionDepth"),
            addressOf("revealEntityId")};
        gpu::BindingList bindings;
        bindings.storage(adopt(task.color.image, VK_FORMAT_R16G16B16A16_SFLOAT))
            .storage(adopt(task.motionDepth.image, VK_FORMAT_R32G32B32A32_SFLOAT))
            .storage(adopt(task.entityId.image, VK_FORMAT_R32_UINT));
        recordBarrier(task.commands);
        recorder.bind(mReveal.get(), bindings, &push, sizeof(push));
        dispatch(task.commands, {task.width, task.height});
    };
    return wrapped;
}

void HostDump::drop(uint32_t frame) {
    Slot& slot = *mSlots[frame];
    if (std::exchange(slot.isPending, false) && mMessage)
        mMessage(fmt::format(
            "motion blur dump: frame {} was not recorded, so the dump ends before it", slot.number
        ));
}

core::Status HostDump::write(const Slot& slot) const {
    const auto* texels = static_cast<const std::byte*>(slot.buffer.mapped());
    for (const Plane& plane : slot.planes)
        SHUTTER_TRY(writeDumpFile(
            slot.folder / fmt::format("frame_{:04}_{}.bin", slot.number, plane.name),
            {texels + plane.offset, size_t(plane.bytes)}
        ));
    if (!slot.response.empty())
        SHUTTER_TRY(writeDumpFile(
            slot.folder / fmt::format("frame_{:04}_response.bin", slot.number), slot.response
        ));
    // Written last, when the files that it names exist.
    const std::string text =
        slot.manifest.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
    return writeDumpFile(
        slot.folder / fmt::format("frame_{:04}.json", slot.number),
        std::as_bytes(std::span(text.data(), text.size()))
    );
}

void HostDump::finish(uint32_t frame) {
    Slot& slot = *mSlots[frame];
    if (!std::exchange(slot.isPending, false))
        return;
    uint32_t serial = 0;
    std::memcpy(
        &serial, static_cast<const std::byte*>(slot.buffer.mapped()) + slot.bytes, sizeof(serial)
    );
    core::Status done;
    try {
        done = serial == slot.serial
                   ? write(slot)
                   : core::Status(makeError("frame {} was never submitted", slot.number));
    } catch (const std::exception& error) {
        done = core::Error{error.what()};
    }
    slot.buffer = {};
    if (done)
        return;
    mLeft = 0; // what follows could not be replayed without it
    if (mMessage)
        mMessage("motion blur dump: " + done.error().message);
}

void HostDump::finishAll() {
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < mSlots.size(); ++i)
        order.push_back(i);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return mSlots[a]->number < mSlots[b]->number;
    });
    for (const uint32_t frame : order)
        finish(frame);
}

} // namespace shutter::motion_blur
