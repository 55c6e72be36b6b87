// SPDX-License-Identifier: MIT
#include "engine/render/renderer.h"

#include "engine/core/check.h"
#include "engine/graph/dump.h"
#include "engine/graph/execute.h"
#include "engine/render/backdrop.h"
#include "engine/render/motion_cap.h"
#include "engine/render/ray_masks.h"
#include "engine/scene/shutter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

namespace shutter::render {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

VkDeviceSize alignTable(VkDeviceSize bytes) {
    return (bytes + 255) / 256 * 256;
}

ViewFacts stateFacts(const FrameRequest& request, bool moves, const gpu::Device& device) {
    ViewFacts facts;
    facts.width = request.view.width;
    facts.height = request.view.height;
    facts.moves = moves;
    if (!request.view.instant)
        facts.exposureSeconds = request.view.exposure.close - request.view.exposure.open;
    facts.rasterShare = request.view.exposure.rasterShare;
    facts.deviceHasRays = device.hasRays();
    facts.deviceHasRayQuery = device.hasRayQuery();
    facts.displayWanted = request.wantDisplay;
    return facts;
}

/// What all effects together want: the first that wants it, or the last that says why not.
void join(Decision& all, const std::string& effect, const Decision& own) {
    if (!all.run && !own.reason.empty())
        all = {own.run, effect + ": " + own.reason};
}

void explainSurfaces(const ExtractedFrame& frame, Explainer& explainer) {
    const SurfaceDemand surfaces = decideSurfaces(frame);
    explainer.decide(ExplainedKind::Work, "bent meshes", surfaces.bending);
    explainer.decide(ExplainedKind::Work, "alpha mask", surfaces.alphaMask);
    explainer.decide(ExplainedKind::Work, "blending", surfaces.blending);
}

} // namespace

Renderer::Renderer(gpu::Device& device, const scene::Assets& assets)
    : mDevice(device), mScene(device, assets), mGBufferPass(device, mScene), mFrame(device),
      mPool(device), mReadback(device), mEntityTable(device), mDeformation(device),
      mTopLevels(device), mMovingScene(device) {}

Renderer::RunningEffects Renderer::askEffects(
    std::span<PostEffect* const> effects, const ViewFacts& facts, Explainer& explainer
) {
    RunningEffects running;
    running.rays = running.movingRays = {false, "no effect that runs traces any"};
    for (PostEffect* effect : effects) {
        Decision decision = effect->ask(facts);
        const Decision rays = effect->askRays(facts);
        const Decision movingRays = effect->askMovingRays(facts);
        if (decision.run && (rays.run || movingRays.run) && !facts.deviceHasRays)
            decision = {false, "it needs rays, which the device cannot trace"};
        if (decision.run && movingRays.run && !facts.deviceHasRayQuery)
            decision = {false, "it needs ray queries, which the device lacks"};
        explainer.decide(ExplainedKind::Effect, effect->name(), decision);
        if (!decision.run)
            continue;
        running.effects.push_back({effect});
        running.mayTrace = running.mayTrace || !rays.reason.empty();
        join(running.rays, effect->name(), rays);
        join(running.movingRays, effect->name(), movingRays);
    }
    return running;
}

Renderer::TableAddresses Renderer::uploadTables(
    ExtractedFrame& frame, const ViewRequest& view, std::span<const shader::Geometry> bent
) {
    const std::span<const shader::Geometry> own = mScene.geometryRows();
    const VkDeviceSize lightsAt = alignTable(sizeof(shader::FrameConstants));
    const VkDeviceSize lightBytes = frame.lights.size() * sizeof(shader::LightRow);
    const VkDeviceSize responseAt = lightsAt + alignTable(lightBytes);
    const VkDeviceSize geometriesAt = responseAt + alignTable(sizeof(shader::ResponseTable));
    const VkDeviceSize total =
        bent.empty() ? geometriesAt
                     : geometriesAt + (own.size() + bent.size()) * sizeof(shader::Geometry);
    const auto response = scene::computeResponseTable(view.exposure.shutter.response);
    if (mTables.bytes() < total)
        mTables = gpu::Buffer(
            mDevice,
            "frame tables",
            total + total / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Upload
        );
    frame.constants.entities = splitAddress(mEntityTable.rows());
    frame.constants.entityMotions = splitAddress(mEntityTable.motions());
    frame.constants.lights = splitAddress(mTables.address() + lightsAt);
    frame.constants.geometries =
        splitAddress(bent.empty() ? mScene.geometryTable() : mTables.address() + geometriesAt);
    frame.constants.materials = splitAddress(mScene.materialTable());
    mTables.writeBytes(&frame.constants, sizeof(frame.constants), 0);
    mTables.write(std::span<const shader::LightRow>(frame.lights), lightsAt);
    if (response)
        mTables.writeBytes(&*response, sizeof(*response), responseAt);
    if (!bent.empty()) {
        mTables.write(own, geometriesAt);
        mTables.write(bent, geometriesAt + own.size_bytes());
    }
    return {mTables.address(), response ? mTables.address() + responseAt : 0};
}

void Renderer::declareTopLevels(
    graph::Graph& graph, ExtractedFrame& frame, const DeformedShapes& shapes, RayScene& rays
) {
    mScene.buildBottomLevels();
    const TopLevelHandles levels = mTopLevels->declare(graph, frame, mScene, shapes);
    rays.topLevelBuffer = levels.buffer;
    rays.movingLevelBuffer = levels.movingBuffer;
    rays.shapeLevelsBuffer = levels.shapesBuffer;
    rays.shapesBuffer = shapes.buffer;
    rays.topLevel = levels.level;
    frame.constants.movingLevel = splitAddress(levels.movingLevel);
}

void Renderer::publishGBuffer(const GBuffer& gbuffer, Intermediates& intermediates) const {
    intermediates.publish("motion", gbuffer.motionDepth);
    intermediates.publish("depth", gbuffer.motionDepth);
    intermediates.publish("normal", gbuffer.normal);
    intermediates.publish("mesh_id", gbuffer.meshId);
}

core::Result<FrameResult> Renderer::renderFrame(
    const scene::World& world, const FrameRequest& request, std::span<PostEffect* const> effects
) {
    const Clock::time_point start = Clock::now();
    auto extracted = mExtractor.update(world, mScene.layout(), request.view);
    if (!extracted)
        return extracted.error();
    ExtractedFrame& frame = *extracted.value();
    ViewFacts facts = stateFacts(request, frame.moves, mDevice);
    if (facts.moves && facts.exposureSeconds > 0.0)
        facts.reveal = decideReveal(frame, mScene.layout());
    FrameResult result;
    FrameStatistics& statistics = result.statistics;
    statistics.measures["extraction ms"] = millisecondsSince(start);
    Explainer explainer;
    RunningEffects running = askEffects(effects, facts, explainer);
    if (request.wantReasons) {
        explainSurfaces(frame, explainer);
        explainer.decide(ExplainedKind::Work, "rays at the raster instant", running.rays);
        explainer.decide(ExplainedKind::Work, "rays at any time", running.movingRays);
    }

    std::optional<MovingTables> moving;
    if (running.movingRays.run) {
        auto computed = computeMovingTables(world, mScene.layout(), request.view, frame);
        if (!computed)
            return computed.error();
        moving = std::move(computed).value();
    }

    mFrame.begin();
    mReadback.reset();
    graph::Graph graph;
    const Tickets tickets =
        declareFrame(graph, request, facts, frame, moving ? &*moving : nullptr, running, explainer);
    statistics.measures["entity table ms"] = mTableMilliseconds;
    statistics.measures["top level ms"] = mTopLevelMilliseconds;
    statistics.counters["entity rows written"] = mWritten.rows;
    statistics.counters["entity motions written"] = mWritten.motions;
    auto plan = graph::execute(graph, mFrame, mPool);
    if (!plan) {
        mTopLevels.emplace(mDevice); // what was to be built was not
        return plan.error();
    }
    mFrame.submit();
    result.statistics.cpuMilliseconds = millisecondsSince(start);
    result.statistics.passes = mFrame.waitForTimes();
    result.statistics.wallMilliseconds = millisecondsSince(start);
    result.statistics.transientBytes = mPool.heldBytes();
    result.statistics.explanations = explainer.finish(graph, plan.value(), request.wantReasons);
    showTimes(effects, running, plan.value(), statistics.passes);
    for (const RunningEffect& one : running.effects) {
        one.effect->collect(statistics.counters);
        one.effect->measure(statistics.measures);
    }
    if (!effects.empty()) // a look that measures something is no frame
        releaseIdle(frame, running);
    if (request.wantDump)
        result.dump = graph::dump(graph, plan.value());
    if (tickets.color)
        result.color = mReadback.take(*tickets.color);
    if (tickets.display)
        result.display = mReadback.take(*tickets.display);
    for (const auto& [name, ticket] : tickets.intermediates)
        result.intermediates[name] = mReadback.take(ticket);
    return result;
}

void Renderer::showTimes(
    std::span<PostEffect* const> effects,
    const RunningEffects& running,
    const graph::Plan& plan,
    std::span<const gpu::PassTime> times
) {
    SHUTTER_CHECK_EQ(plan.passes.size(), times.size());
    for (PostEffect* effect : effects) {
        const auto runs = std::find_if(
            running.effects.begin(),
            running.effects.end(),
            [&](const RunningEffect& one) { return one.effect == effect; }
        );
        std::vector<gpu::PassTime> own;
        for (size_t i = 0; runs != running.effects.end() && i < times.size(); ++i)
            if (plan.passes[i].pass >= runs->firstPass && plan.passes[i].pass < runs->endPass)
                own.push_back(times[i]);
        effect->observe(own);
    }
}

void Renderer::releaseIdle(const ExtractedFrame& frame, const RunningEffects& running) {
    // Building bottom levels takes longer than a frame: an effect that may trace keeps them.
    const bool anyRays = running.mayTrace || running.movingRays.run;
    if (mBendingIdle.advance(!frame.deformed.empty()))
        mDeformation.emplace(mDevice);
    if (mRaysIdle.advance(running.rays.run))
        mTopLevels.emplace(mDevice);
    if (mMovingRaysIdle.advance(running.movingRays.run))
        mMovingScene.emplace(mDevice);
    if (mBottomLevelsIdle.advance(anyRays))
        mScene.releaseBottomLevels();
}

core::Result<scene::MotionCap>
Renderer::measureMotionCap(const scene::World& world, const ViewRequest& view) {
    // A turning mover's chord is not proportional to its angle: a second look finds the rest.
    constexpr int kLooks = 4;
    const double percent = view.exposure.shutter.maxBlurPercent;
    scene::MotionCap cap;
    if (!std::isfinite(percent) || !(view.exposure.open < view.exposure.close))
        return cap;
    FrameRequest look;
    look.view = view;
    look.view.exposure.cap = {};
    look.view.instant.reset();
    look.intermediates = {"motion", "mesh_id"};
    look.wantColor = false;
    const scene::ExposureMotion uncapped(world, view.camera, look.view.exposure);
    const double maxPx = std::max(percent, 0.0) / 100.0 * view.width;
    for (int i = 0; i < kLooks; ++i) {
        look.view.exposure.cap = cap;
        auto frame = extractFrame(world, mScene.layout(), look.view);
        if (!frame)
            return frame.error();
        auto seen = renderFrame(world, look, {});
        if (!seen)
            return seen.error();
        const auto& images = seen.value().intermediates;
        if (!tightenCap(
                cap, frame.value(), images.at("motion"), images.at("mesh_id"), uncapped, maxPx
            ))
            break;
    }
    return cap;
}

Renderer::Tickets Renderer::declareFrame(
    graph::Graph& graph,
    const FrameRequest& request,
    const ViewFacts& facts,
    ExtractedFrame& frame,
    const MovingTables* moving,
    RunningEffects& running,
    Explainer& explainer
) {
    explainer.beginPasses(graph, "a skin or morph target is drawn");
    const DeformedShapes shapes = mDeformation->declare(graph, frame, mScene);
    std::vector<shader::Geometry> bent = shapes.rows;
    const size_t firstShapeGeometry = mScene.geometryRows().size() + bent.size();
    if (moving) {
        mScene.buildBottomLevels(); // instances of bent meshes ask for their masks
        const std::vector<shader::Geometry>& keyed = mMovingScene->prepareShapes(*moving, mScene);
        bent.insert(bent.end(), keyed.begin(), keyed.end());
    }
    RayScene rays;
    explainer.beginPasses(graph, running.rays.reason);
    mTopLevelMilliseconds = 0.0;
    if (running.rays.run) {
        const Clock::time_point start = Clock::now();
        assignRayMasks(frame, mScene.layout());
        declareTopLevels(graph, frame, shapes, rays);
        mTopLevelMilliseconds = millisecondsSince(start);
    }
    const Clock::time_point start = Clock::now();
    mWritten = mEntityTable.update(frame);
    mTableMilliseconds = millisecondsSince(start);
    const TableAddresses tables = uploadTables(frame, request.view, bent);
    rays.frameConstants = tables.constants;
    rays.textures = mScene.textureSet();
    rays.hasBlended = !frame.blended.empty();
    explainer.beginPasses(graph, running.movingRays.reason);
    MovingRays movingRays;
    if (moving) {
        movingRays = mMovingScene->declare(
            graph,
            *moving,
            frame,
            mScene,
            static_cast<uint32_t>(firstShapeGeometry),
            rays.frameConstants
        );
        movingRays.shapesBuffer = shapes.buffer;
    }
    explainer.beginPasses(graph, "the picture is drawn");
    const GBuffer gbuffer =
        mGBufferPass.declare(graph, frame, mScene, shapes.buffer, rays.frameConstants);
    Intermediates intermediates(request.intermediates);
    publishGBuffer(gbuffer, intermediates);
    PostContext context{
        graph,
        facts,
        gbuffer,
        running.rays.run ? &rays : nullptr,
        moving ? &movingRays : nullptr,
        gbuffer.color,
        {},
        intermediates,
        tables.response,
        tables.constants,
        explainer};
    for (RunningEffect& one : running.effects) {
        explainer.beginPasses(graph, one.effect->name() + " runs");
        one.firstPass = graph.passes().size();
        one.effect->declare(context);
        one.endPass = graph.passes().size();
    }

    explainer.beginPasses(graph, "its picture is read back");
    Tickets tickets;
    for (const auto& [name, image] : intermediates.images())
        tickets.intermediates[name] = mReadback.add(graph, name, image);
    if (request.wantColor)
        tickets.color = mReadback.add(graph, "color", context.color);
    if (request.wantDisplay && context.display.isValid())
        tickets.display = mReadback.add(graph, "display", context.display);
    return tickets;
}

} // namespace shutter::render
