// SPDX-License-Identifier: MIT
#include "modules/debug_view/debug_view.h"

#include "spirv/debug_view/debug_view.comp.h"

#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "shaders/debug_view/debug_view_shared.h"

#include <algorithm>
#include <array>
#include <vector>

namespace shutter::debug_view {

namespace {

struct View {
    ViewInfo info;
    uint32_t kind;
    const char* values;             ///< intermediate of floats; null: none
    const char* ids = nullptr;      ///< of mesh ids; null: none
    const char* otherIds = nullptr; ///< of mesh ids; null: none
};

constexpr float kLongestPx = 40.0f;
constexpr float kHeatMax = 400.0f;

constexpr Channel kMotion[] = {{0, "motion.x"}, {1, "motion.y"}};
constexpr Channel kDepth[] = {{2, "Z"}};
constexpr Channel kNormal[] = {{0, "N.x"}, {1, "N.y"}, {2, "N.z"}};
constexpr Channel kMeshId[] = {{0, "mesh_id"}}; // -1: nothing
constexpr Channel kVariance[] = {{0, "variance"}};
constexpr Channel kEdge[] = {{0, "candidate"}, {1, "measure"}, {2, "edge"}};
constexpr Channel kMask[] = {{0, "mask"}};
constexpr Channel kColor[] = {{0, "R"}, {1, "G"}, {2, "B"}};
constexpr Channel kCost[] = {{0, "cost"}};

View showMotion(const char* name, const char* description) {
    return {{name, description, kMotion}, shader::kShowMotion, name};
}

View showColor(const char* name, const char* description) {
    return {{name, description, kColor}, shader::kShowColor, name};
}

const std::vector<View>& views() {
    using namespace shader;
    static const std::vector<View> kViews = {
        showMotion(
            "motion", "motion over the exposure: hue is the direction, full brightness 40 px"
        ),
        {{"depth", "distance: white 10 cm, black 10 km, logarithmic", kDepth}, kShowDepth, "depth"},
        {{"normal", "surface normals as the ray mask reads them", kNormal}, kShowNormal, "normal"},
        {{"mesh_id", "rows of the entity table, a colour each", kMeshId},
         kShowIds,
         nullptr,
         "mesh_id"},
        showColor("particles", "particles alone, before black"),
        showColor("last", "the last frame's raster, for this one's lookups"),
        showColor("second", "the raster at the other end of the exposure"),
        showMotion("tile_max", "longest motion of each tile, coloured as motion"),
        showMotion("tiles", "dominant motion of each tile's neighbourhood, coloured as motion"),
        {{"variance", "Guertin's variance of directions in the neighbourhood, white 1", kVariance},
         kShowGrey,
         "variance"},
        {{"edge", "red: candidates of the ray mask; green: edge measure; blue: edges", kEdge},
         kShowMasks,
         "edge"},
        {{"mask", "pixels whose background rays fetch", kMask}, kShowGrey, "mask"},
        showColor("reveal", "what rays found behind; outside the mask the raster"),
        showMotion("reveal_motion", "its motion, coloured as motion"),
        {{"unresolved",
          "grey: masked; white: of these, where no other object was found behind",
          {}},
         kShowUnresolved,
         "mask",
         "mesh_id",
         "reveal_id"},
        showColor("noisy", "rays of the denoised method, unfiltered"),
        {{"cost",
          "fetches per pixel: black 0, blue, red, yellow, white 400; a ray counts 300",
          kCost},
         kShowHeat,
         "cost"},
        showColor("error", "standard error of the truth's mean"),
    };
    return kViews;
}

const View* findOwn(std::string_view name) {
    const auto found = std::find_if(views().begin(), views().end(), [&](const View& view) {
        return name == view.info.name;
    });
    return found == views().end() ? nullptr : &*found;
}

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "debug view";
    desc.spirv = debug_view_debug_view_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::DebugViewParams);
    return desc;
}

} // namespace

std::span<const ViewInfo> listViews() {
    static const std::vector<ViewInfo> kInfos = [] {
        std::vector<ViewInfo> infos;
        for (const View& view : views())
            infos.push_back(view.info);
        return infos;
    }();
    return kInfos;
}

const ViewInfo* findView(std::string_view name) {
    const View* view = findOwn(name);
    return view ? &view->info : nullptr;
}

std::set<std::string> listSources(std::string_view name) {
    std::set<std::string> sources;
    if (const View* view = findOwn(name))
        for (const char* source : {view->values, view->ids, view->otherIds})
            if (source)
                sources.insert(source);
    return sources;
}

DebugView::DebugView(gpu::Device& device)
    : mSampler(device.nearestSampler()), mPipeline(device, describePipeline()) {}

render::Needs DebugView::decide(const render::DecideContext&) const {
    if (mView.empty())
        return {.run = {false, "no intermediate is to be shown"}};
    return {.run = {true, "an intermediate is shown: " + mView}};
}

void DebugView::declare(render::PictureContext& context) {
    const View* view = findOwn(mView);
    const auto& made = context.intermediates.images();
    const std::set<std::string> sources = listSources(mView);
    const bool hasAll = std::all_of(sources.begin(), sources.end(), [&](const std::string& name) {
        return made.contains(name);
    });
    mIsMissing = !view || !hasAll;
    if (mIsMissing) {
        context.explainer.decide(
            render::ExplainedKind::Pass, "debug view", {false, "no effect made " + mView}
        );
        return;
    }

    struct Data {
        std::array<graph::ImageHandle, 3> sources;
        graph::ImageHandle display;
    };

    shader::DebugViewParams params{};
    params.sizePx = {context.facts.width, context.facts.height};
    params.kind = view->kind;
    params.longestPx = kLongestPx;
    params.heatMax = kHeatMax;
    const auto find = [&](const char* name, graph::ImageHandle none) {
        return name ? made.at(name) : none;
    };
    const std::array from{
        find(view->values, context.gbuffer.motionDepth),
        find(view->ids, context.gbuffer.entityId),
        find(view->otherIds, context.gbuffer.entityId)};
    const Data& pass = context.graph.addPass<Data>(
        "debug view",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            for (size_t i = 0; i < from.size(); ++i)
                data.sources[i] = builder.read(from[i], graph::Access::SampledCompute);
            const auto display = context.graph.createImage(
                "debug view", {params.sizePx.x, params.sizePx.y, VK_FORMAT_R8G8B8A8_UNORM}
            );
            data.display = builder.write(display, graph::Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& recording) {
            gpu::BindingList bindings;
            for (const graph::ImageHandle source : data.sources)
                bindings.sampled(recording.resources.view(source), mSampler);
            bindings.storage(recording.resources.image(data.display));
            recording.frame.bind(mPipeline, bindings, &params, sizeof(params));
            vkCmdDispatch(
                recording.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
            );
        }
    );
    context.display = pass.display;
}

} // namespace shutter::debug_view
