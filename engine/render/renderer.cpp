// SPDX-License-Identifier: MIT
#include "engine/render/renderer.h"

#include "engine/core/check.h"
#include "engine/core/words.h"
#include "engine/extract/defocus.h"
#include "engine/extract/demand.h"
#include "engine/extract/frame_view.h"
#include "engine/extract/instance_masks.h"
#include "engine/extract/raster_record.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/compile.h"
#include "engine/graph/execute.h"
#include "engine/math/lens_tables.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace shutter::render {

namespace {

using Clock = std::chrono::steady_clock;

double nowMilliseconds() {
    return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count();
}

ViewFacts stateFacts(const FrameRequest& request, bool moves, const gpu::Device& device) {
    ViewFacts facts;
    facts.width = request.view.width;
    facts.height = request.view.height;
    facts.moves = moves;
    if (!request.view.instant)
        facts.exposureSeconds = request.view.exposure.close - request.view.exposure.open;
    facts.usesLens = request.view.usesLens;
    facts.rasterTime = request.view.exposure.rasterTime;
    facts.deviceHasRays = device.hasRays();
    facts.deviceHasRayQuery = device.hasRayQuery();
    facts.pictureWanted = request.wantPicture;
    facts.isFollowed = request.isFollowed;
    facts.countersWanted = request.wantCounters;
    facts.displayWanted = request.wantDisplay || request.showsDisplay;
    facts.lastBrightest = request.lastBrightest;
    facts.brightestWanted = request.wantBrightest;
    return facts;
}

core::Decision
decideEnvironment(const extract::ExtractedFrame& frame, const gpu_scene::GpuScene& scene) {
    if ((frame.constants.flags & shader::kFrameEnvironment) != 0)
        return {true, "it is seen where nothing is and lights surfaces"};
    return {false, scene.layout().hasEnvironment ? "the view leaves it out" : "the scene has none"};
}

void explainSurfaces(const extract::ExtractedFrame& frame, Explainer& explainer) {
    const extract::SurfaceDemand surfaces = extract::decideSurfaces(frame);
    explainer.decide(ExplainedKind::Work, "deformed meshes", surfaces.deformation);
    explainer.decide(ExplainedKind::Work, "alpha mask", surfaces.alphaMask);
    explainer.decide(ExplainedKind::Work, "blending", surfaces.blending);
}

/// Sample positions in the pixel that edges of overlays have where the picture below is
/// anti-aliased.
constexpr uint32_t kEdgeSamples = 4;

/// Name of the intermediate GBuffer::normal.
constexpr const char* kNormals = "normal";

/// Reason of the passes that do so.
constexpr const char* kReadBack = "its picture is read back";

} // namespace

Renderer::Renderer(gpu::Device& device, const scene::Assets& assets, uint32_t framesInFlight)
    : mDevice(device), mScene(device, assets), mGBufferPass(device, mScene), mPool(device),
      mDeformation(device, framesInFlight), mFrameTlas(device, framesInFlight),
      mTimedScene(device, framesInFlight), mSecondRaster(device, framesInFlight),
      mLastRaster(device, framesInFlight) {
    SHUTTER_CHECK(
        framesInFlight >= 1 && framesInFlight <= gpu::kMaxFramesInFlight,
        "{} frames in flight",
        framesInFlight
    );
    for (uint32_t i = 0; i < framesInFlight; ++i)
        mSlots.push_back(std::make_unique<Slot>(device));
}

Renderer::~Renderer() = default;

VkDeviceAddress Renderer::declareTlas(
    graph::Graph& graph,
    const rays::MaskedFrame& frame,
    const gpu_scene::DeformedMeshes& shapes,
    graph::RayScene& rays
) {
    const double start = nowMilliseconds();
    mScene.buildAllBlas();
    const rays::TlasHandles levels =
        mFrameTlas.use(mNextSlot).declare(graph, frame, mScene, shapes);
    rays.tlasBuffer = levels.buffer;
    rays.movingTlasBuffer = levels.movingBuffer;
    rays.deformedBlasBuffer = levels.deformedBuffer;
    rays.deformedBuffer = shapes.buffer;
    rays.tlas = levels.level;
    mTlasMilliseconds = nowMilliseconds() - start;
    return levels.movingTlas;
}

OverlayExtract
Renderer::describeOverlays(const ExtractContext& context, const FrameNeeds& needs) const {
    OverlayExtract source{
        .world = context.world,
        .layout = mScene.layout(),
        .view = context.view,
        .frameView = mExtractor.view(),
        .frame = context.frame,
        .takenRows = context.takenRows,
        .isOverExposure = needs.exposure.run,
        .jitterPx = context.colorJitterPx,
        .limits = needs.limits,
        .slot = context.slot};
    source.limits.surfaceBytes = mDevice.limits().maxStorageBufferRange;
    if (context.view.jitterPx != context.colorJitterPx)
        source.limits.leastInstants = kEdgeSamples;
    return source;
}

OverlayContext Renderer::makeOverlayContext(
    const FrameParts& parts, const DeclaredScene& scene, const math::dvec2& jitterPx
) const {
    return {
        .graph = parts.graph,
        .view = parts.request.view,
        .frame = parts.frame,
        .shapes = scene.shapes,
        .motionDepth = scene.gbuffer.motionDepth,
        .shading = scene.rays.shading,
        .frameConstants = scene.tables.constants,
        .response = scene.tables.response,
        .jitterPx = jitterPx,
        .slot = mNextSlot};
}

core::Status Renderer::extractForEffects(
    ExtractContext& context, const FrameNeeds& needs, std::span<ShadingFeature* const> shading
) {
    const extract::SceneLayout& layout = mScene.layout();
    const std::vector<ecs::Entity> hidden = extract::listEntities(context.frame, needs.taken.rows);
    // Nothing gathers the samples of static surfaces in these.
    extract::ViewRequest view = extract::withoutStaticSamples(context.view);
    view.samplesEdges = needs.samplesEdges; // as this frame is drawn
    if (needs.secondRaster.run)
        SHUTTER_TRY(mSecondRaster.use(context.slot)
                        .extract(
                            context.world,
                            layout,
                            makeViewOfOtherEnd(view),
                            {shading, hidden, RasterKind::Second, context.slot}
                        ));
    if (needs.lastRaster.run) {
        const auto before = extract::makeViewBefore(context.world, view, context.motion);
        SHUTTER_CHECK(before.has_value(), "no frame before shows what this one does");
        SHUTTER_TRY(mLastRaster.use(context.slot)
                        .extract(
                            context.world,
                            layout,
                            *before,
                            {shading, hidden, RasterKind::Last, context.slot}
                        ));
    }
    for (const RunningEffect& one : needs.running) {
        context.secondRaster.reset();
        context.lastRaster.reset();
        if (one.readsSecondRaster)
            context.secondRaster = mSecondRaster.use(context.slot).extracted();
        if (one.readsLastRaster)
            context.lastRaster = mLastRaster.use(context.slot).extracted();
        one.effect->extract(context);
    }
    return {};
}

void Renderer::publishGBuffer(const GBuffer& gbuffer, Intermediates& intermediates) const {
    intermediates.publish("motion", gbuffer.motionDepth);
    intermediates.publish("depth", gbuffer.motionDepth);
    intermediates.publish(kNormals, gbuffer.normal);
    intermediates.publish("mesh_id", gbuffer.entityId);
}

core::Result<FrameResult> Renderer::renderFrame(
    const scene::World& world, const FrameRequest& request, const FeatureSet& features
) {
    SHUTTER_CHECK(mPending.empty(), "{} frames are unfinished", mPending.size());
    SHUTTER_TRY(submitFrame(world, request, features));
    return finishFrame();
}

core::Result<Renderer::OwnFrame>
Renderer::extractOwn(const scene::World& world, const extract::ViewRequest& view, bool hasEffects) {
    const auto extractAs = [&](bool isDefocused) -> core::Result<OwnFrame> {
        OwnFrame own{isDefocused ? extract::withoutStaticSamples(view) : view};
        auto extracted = mExtractor.update(world, mScene.layout(), own.view);
        if (!extracted)
            return extracted.error();
        own.frame = extracted.value();
        // Only effects need it, and none for a picture of one instant.
        own.isDefocused = hasEffects && !view.instant &&
                          extract::isDefocused(
                              world, view, mExtractor.view().motion(), *own.frame, mScene.layout()
                          );
        return own;
    };
    // It is known after the extraction, from the bounds of what is drawn.
    const bool guess = mWasDefocused;
    auto own = extractAs(guess);
    if (!own)
        return own;
    mWasDefocused = own.value().isDefocused;
    if (mWasDefocused != guess && view.jittered == extract::Jittered::Static)
        own = extractAs(mWasDefocused);
    return own;
}

core::Status Renderer::submitFrame(
    const scene::World& world, const FrameRequest& asked, const FeatureSet& features
) {
    const std::span<Effect* const> effects = features.effects;
    SHUTTER_CHECK(mPending.size() < mSlots.size(), "{} frames are unfinished", mPending.size());
    PendingFrame pending;
    pending.slot = mNextSlot;
    pending.startMilliseconds = nowMilliseconds();
    Slot& slot = *mSlots[mNextSlot];
    auto own = extractOwn(world, asked.view, !effects.empty());
    if (!own)
        return own.error();
    const extract::ExtractedFrame& frame = *own.value().frame;
    FrameRequest request = asked;
    request.view = own.value().view;
    ViewFacts facts = stateFacts(request, frame.moves, mDevice);
    facts.isDefocused = own.value().isDefocused;
    if (facts.moves && facts.exposureSeconds > 0.0)
        facts.reveal = extract::decideReveal(frame, mScene.layout());
    FrameStatistics& statistics = pending.result.statistics;
    statistics.measures["extraction ms"] = nowMilliseconds() - pending.startMilliseconds;
    Explainer explainer;
    ExtractContext context{
        .world = world,
        .view = request.view,
        .motion = mExtractor.view().motion(),
        .frame = frame,
        .facts = facts,
        .slot = pending.slot,
        .colorJitterPx = request.view.jitterPx};
    const FrameNeeds needs = joinNeeds(
        {facts, world, mScene.layout(), request.view, context.motion, frame, features.overlays},
        effects,
        explainer
    );
    context.takenRows = needs.taken.rows;
    math::vec2 confusion(0.0f);
    if (needs.samplesEdges && facts.isDefocused)
        confusion = math::confusionOf(extract::describeLens(
            context.motion,
            world.registry.get<scene::Camera>(request.view.camera),
            request.view,
            facts.rasterTime
        ));
    if (request.wantReasons) {
        explainSurfaces(frame, explainer);
        explainer.decide(ExplainedKind::Work, "rays at the raster instant", needs.rays);
        explainer.decide(ExplainedKind::Work, "rays at any time", needs.timedRays);
        explainer.decide(ExplainedKind::Work, "second raster", needs.secondRaster);
        explainer.decide(ExplainedKind::Work, "last raster", needs.lastRaster);
        explainer.decide(ExplainedKind::Work, "blended layer", needs.layer);
    }

    std::optional<extract::TimedTables> moving;
    if (needs.timedRays.run) {
        auto computed = extract::computeTimedTables(world, mScene.layout(), request.view, frame);
        if (!computed)
            return computed.error();
        moving = std::move(computed).value();
    }

    const auto shading = extractShading(
        features.shading,
        {world, mScene.layout(), request.view, mExtractor.view(), frame, RasterKind::Own, mNextSlot}
    );
    if (!shading)
        return shading.error();
    context.hasShading = !shading.value().running.empty();
    context.shadingRevision = shading.value().revision;
    if (request.wantReasons) {
        explainer.decide(ExplainedKind::Work, "environment", decideEnvironment(frame, mScene));
        for (const Explanation& one : shading.value().explanations)
            explainer.decide(one.kind, one.subject, one.decision);
    }
    std::vector<Overlay*> others(features.overlays.begin(), features.overlays.end());
    for (const Overlay* taker : needs.taken.takers)
        std::erase(others, taker);
    FrameOverlays inRaster;
    FrameOverlays over;
    if (!needs.exposure.run)
        SHUTTER_TRY(inRaster.extract(others, describeOverlays(context, needs), false));
    context.rasterHasOverlays = !inRaster.empty();
    SHUTTER_TRY(extractForEffects(context, needs, features.shading));
    // Only now is the jitter of the effects' colour known: an effect may have removed the raster's.
    if (moving)
        moving->jitterPx = math::vec2(context.colorJitterPx);
    // Pictures with overlays are nobody's history.
    if (request.wantPicture) {
        const OverlayExtract source = describeOverlays(context, needs);
        SHUTTER_TRY(over.extract(needs.taken.takers, source, true));
        if (needs.exposure.run)
            SHUTTER_TRY(over.extract(others, source, false));
        over.count(statistics.counters);
    }
    if (request.wantReasons)
        for (const FrameOverlays* overlays : {&inRaster, &over})
            for (const Explanation& one : overlays->explanations())
                explainer.decide(one.kind, one.subject, one.decision);
    slot.frame.begin();
    slot.readback.reset();
    graph::Graph graph;
    pending.tickets = declareFrame(
        {slot,
         graph,
         request,
         facts,
         frame,
         shading.value(),
         moving ? &*moving : nullptr,
         inRaster,
         over,
         context.colorJitterPx,
         needs,
         confusion,
         explainer}
    );
    const auto fail = [&](const core::Error& error) {
        mFrameTlas.drop(pending.slot);
        mTimedScene.drop(pending.slot);
        return error;
    };
    if (request.wantTrace) {
        const core::Status traced =
            explainer.declareOwned(graph, PassOwner::Display, kReadBack, [&] {
                return pending.trace.declare(graph, slot.readback, mPool.requirementFunction());
            });
        if (!traced)
            return fail(traced.error());
    }
    statistics.measures["entity table ms"] = mTableMilliseconds;
    statistics.measures["TLAS ms"] = mTlasMilliseconds;
    statistics.counters["entity rows written"] = mWritten.rows;
    statistics.counters["entity motions written"] = mWritten.motions;
    mPool.keepFor(request.view.width, request.view.height);
    auto plan = graph::execute(graph, slot.frame, mPool);
    if (!plan)
        return fail(plan.error());
    slot.frame.submit(pending.tickets.semaphores);
    statistics.cpuMilliseconds = nowMilliseconds() - pending.startMilliseconds;
    statistics.transientBytes = mPool.heldBytes();
    statistics.explanations = explainer.finish(graph, plan.value(), request.wantReasons);
    for (Effect* effect : effects)
        pending.effects.push_back({effect});
    for (const EffectPasses& passes : pending.tickets.effects) {
        const auto found = std::find(effects.begin(), effects.end(), passes.effect);
        PendingEffect& one = pending.effects[size_t(found - effects.begin())];
        one.ran = true;
        for (size_t k = 0; k < plan.value().passes.size(); ++k)
            if (plan.value().passes[k].pass >= passes.first &&
                plan.value().passes[k].pass < passes.end)
                one.times.push_back(k);
    }
    pending.owners = explainer.listOwners(plan.value());
    if (request.wantDump)
        pending.result.dump = graph::dump(graph, plan.value());
    if (!effects.empty() && !request.measuresMotion) {
        releaseIdle(needs);
        for (ShadingFeature* feature : features.shading)
            feature->endFrame();
    }
    mPending.push_back(std::move(pending));
    mNextSlot = (mNextSlot + 1) % framesInFlight();
    return {};
}

void Renderer::releaseIdle(const FrameNeeds& needs) {
    mDeformation.endFrame();
    mFrameTlas.endFrame();
    mTimedScene.endFrame();
    mSecondRaster.endFrame();
    mLastRaster.endFrame();
    // Building bottom levels takes longer than a frame: an effect that may trace keeps them.
    mScene.releaseIdleBlas(needs.mayTrace || needs.timedRays.run);
}

FrameResult Renderer::finishFrame() {
    SHUTTER_CHECK(!mPending.empty(), "no frame is unfinished");
    PendingFrame pending = std::move(mPending.front());
    mPending.pop_front();
    Slot& slot = *mSlots[pending.slot];
    FrameResult result = std::move(pending.result);
    FrameStatistics& statistics = result.statistics;
    for (gpu::PassTime& time : slot.frame.waitForTimes()) {
        const PassOwner owner = pending.owners.at(statistics.passes.size());
        statistics.passes.push_back({std::move(time), owner});
    }
    statistics.wallMilliseconds = nowMilliseconds() - pending.startMilliseconds;
    for (const PendingEffect& one : pending.effects) {
        std::vector<gpu::PassTime> own;
        for (const size_t index : one.times)
            own.push_back(statistics.passes.at(index));
        FinishedFrame finished{
            pending.slot,
            one.ran,
            own,
            statistics.counters,
            statistics.measures,
            statistics.explanations};
        one.effect->finish(finished);
    }
    const Tickets& tickets = pending.tickets;
    if (tickets.color)
        result.color = slot.readback.take(*tickets.color);
    if (tickets.display)
        result.display = slot.readback.take(*tickets.display);
    for (const auto& [name, ticket] : tickets.intermediates)
        result.intermediates[name] = slot.readback.take(ticket);
    result.trace = pending.trace.take(slot.readback);
    return result;
}

Renderer::DeclaredScene Renderer::declareScene(const FrameParts& parts) {
    graph::Graph& graph = parts.graph;
    const FrameRequest& request = parts.request;
    const extract::ExtractedFrame& frame = parts.frame;
    const FrameNeeds& needs = parts.needs;
    const auto declareOwned = [&](PassOwner owner, const std::string& reason, const auto& declare) {
        return parts.explainer.declareOwned(parts.graph, owner, reason, declare);
    };
    DeclaredScene scene;
    if (!frame.deformed.empty())
        scene.shapes = declareOwned(PassOwner::Scene, "a skin, morph target or wave is drawn", [&] {
            return mDeformation.use(mNextSlot).declare(graph, frame, mScene);
        });
    std::vector<shader::Geometry> deformed = scene.shapes.rows;
    const size_t firstDeformedGeometry = mScene.geometryRows().size() + deformed.size();
    if (parts.moving) {
        mScene.buildAllBlas(); // instances of deformed meshes need their masks
        const std::vector<shader::Geometry>& keyed =
            mTimedScene.use(mNextSlot).prepareDeformed(*parts.moving, mScene);
        deformed.insert(deformed.end(), keyed.begin(), keyed.end());
    }
    mTlasMilliseconds = 0.0;
    std::vector<extract::RowMask> masks;
    VkDeviceAddress movingTlas = 0;
    if (needs.rays.run) {
        masks = extract::assignInstanceMasks(frame, mScene.layout());
        movingTlas = declareOwned(PassOwner::Rays, needs.rays.reason, [&] {
            return declareTlas(graph, {frame, masks}, scene.shapes, scene.rays);
        });
    }
    std::span<const extract::ExtraRow> extra;
    if (parts.moving != nullptr)
        extra = parts.moving->extra;
    const double start = nowMilliseconds();
    mWritten = parts.slot.tables.entities().update(frame, needs.rays.run ? &masks : nullptr, extra);
    mTableMilliseconds = nowMilliseconds() - start;
    scene.tables = parts.slot.tables.upload(
        frame,
        request.view,
        mScene,
        {.taken = needs.taken.rows,
         .deformed = deformed,
         .slots = parts.shading.slots,
         .movingTlas = movingTlas}
    );
    graph::RayScene& rays = scene.rays;
    rays.frameConstants = scene.tables.constants;
    rays.textures = mScene.textureSet();
    rays.hasBlended = !frame.blended.empty();
    if (parts.moving) {
        scene.timedRays = declareOwned(PassOwner::Rays, needs.timedRays.reason, [&] {
            return mTimedScene.use(mNextSlot).declare(
                graph,
                *parts.moving,
                frame,
                mScene,
                static_cast<uint32_t>(firstDeformedGeometry),
                rays.frameConstants
            );
        });
        scene.timedRays.deformedBuffer = scene.shapes.buffer;
    }
    for (const RasterShading::Running& one : parts.shading.running)
        rays.shading.push_back(declareOwned(PassOwner::Scene, one.passReason, [&] {
            return one.feature->declare(
                {graph, frame, scene.shapes.buffer, rays.frameConstants, RasterKind::Own, mNextSlot}
            );
        }));
    std::vector<graph::BufferHandle> reads = rays.shading;
    reads.push_back(scene.shapes.buffer);
    const bool readsNormals = needs.readsNormals || request.intermediates.contains(kNormals) ||
                              request.shownIntermediates.contains(kNormals);
    declareOwned(PassOwner::Scene, "the picture is drawn", [&] {
        scene.gbuffer = mGBufferPass.declare(
            graph,
            "G-buffer",
            {frame,
             mScene,
             needs.taken.rows,
             reads,
             rays.frameConstants,
             listSlots(parts.shading.slots),
             needs.samplesEdges,
             needs.readsEdges,
             readsNormals,
             parts.confusion}
        );
        OverlayContext context = makeOverlayContext(parts, scene, request.view.jitterPx);
        context.color = scene.gbuffer.color;
        scene.gbuffer.color = parts.inRaster.declare(context, false, {}, parts.explainer);
    });
    return scene;
}

std::vector<Renderer::EffectPasses> Renderer::declareEffects(
    const FrameParts& parts, const DeclaredScene& scene, PictureContext& context
) {
    graph::Graph& graph = parts.graph;
    const FrameNeeds& needs = parts.needs;
    const auto declareOther = [&](PerSlot<OtherRaster>& rasters,
                                  const char* name,
                                  const Effect& reader,
                                  const core::Decision& decision) {
        return parts.explainer.declareOwned(graph, reader.owner(), decision.reason, [&] {
            return rasters.use(context.slot)
                .declare(graph, name, mScene, mGBufferPass, needs.readsEdges, parts.confusion);
        });
    };
    std::optional<OtherRasterView> second;
    std::optional<OtherRasterView> last;
    const auto declareOverlays = [&](bool areTakers) {
        OverlayContext over = makeOverlayContext(parts, scene, parts.overJitterPx);
        over.color = context.color;
        if (context.compositeParts)
            over.composite = &context.compositeParts;
        context.color = parts.over.declare(over, areTakers, context.surfaceWords, parts.explainer);
    };
    const auto declareOverEffects = [&](size_t effectsBefore) {
        if (needs.exposure.run && needs.overlaysAt == effectsBefore)
            parts.explainer.declareOwned(graph, PassOwner::Blur, needs.exposure.reason, [&] {
                declareOverlays(false);
            });
    };
    std::vector<EffectPasses> passes;
    declareOverEffects(0);
    for (const RunningEffect& one : needs.running) {
        // Not counted as the effect's own: the cost of an occasional frame does not predict later
        // frames, which the budget is for.
        if (one.readsLastRaster && !last)
            last = declareOther(mLastRaster, "last G-buffer", *one.effect, needs.lastRaster);
        EffectPasses& own = passes.emplace_back(EffectPasses{one.effect, graph.passes().size()});
        if (one.readsSecondRaster && !second)
            second =
                declareOther(mSecondRaster, "second G-buffer", *one.effect, needs.secondRaster);
        context.secondRaster = one.readsSecondRaster ? &*second : nullptr;
        context.lastRaster = one.readsLastRaster ? &*last : nullptr;
        context.surfaces = {};
        if (one.isBelowOverlays)
            context.surfaces = parts.over.surfaces();
        parts.explainer.declareOwned(graph, one.effect->owner(), one.effect->name() + " runs", [&] {
            one.effect->declare(context);
            SHUTTER_CHECK(
                !one.isBelowOverlays || context.surfaceWords.size() == context.surfaces.size(),
                "{} finds the surfaces that overlays read",
                one.effect->name()
            );
            if (one.isBelowOverlays)
                declareOverlays(true);
        });
        own.end = graph.passes().size();
        declareOverEffects(passes.size());
    }
    return passes;
}

Renderer::Tickets Renderer::declareFrame(const FrameParts& parts) {
    graph::Graph& graph = parts.graph;
    const FrameRequest& request = parts.request;
    const extract::ExtractedFrame& frame = parts.frame;
    const FrameNeeds& needs = parts.needs;
    const DeclaredScene scene = declareScene(parts);
    std::set<std::string> wanted = request.intermediates;
    wanted.insert(request.shownIntermediates.begin(), request.shownIntermediates.end());
    Intermediates intermediates(std::move(wanted));
    publishGBuffer(scene.gbuffer, intermediates);
    parts.inRaster.publishAlone(
        makeOverlayContext(parts, scene, request.view.jitterPx), intermediates, parts.explainer
    );
    parts.over.publishAlone(
        makeOverlayContext(parts, scene, parts.overJitterPx), intermediates, parts.explainer
    );
    PictureContext context{
        .graph = graph,
        .view = request.view,
        .frame = frame,
        .shapes = scene.shapes,
        .facts = parts.facts,
        .gbuffer = scene.gbuffer,
        .rays = needs.rays.run ? &scene.rays : nullptr,
        .timedRays = parts.moving ? &scene.timedRays : nullptr,
        .color = scene.gbuffer.color,
        .intermediates = intermediates,
        .takenRows = needs.taken.rows,
        .shading = scene.rays.shading,
        .response = scene.tables.response,
        .frameConstants = scene.tables.constants,
        .constantValues = &scene.tables.constantValues,
        .explainer = parts.explainer,
        .slot = mNextSlot};
    std::vector<EffectPasses> passes = declareEffects(parts, scene, context);
    return parts.explainer.declareOwned(graph, PassOwner::Display, kReadBack, [&] {
        Tickets tickets;
        tickets.effects = std::move(passes);
        tickets.semaphores = context.semaphores;
        for (const auto& [name, image] : intermediates.images())
            if (request.intermediates.contains(name))
                tickets.intermediates[name] = parts.slot.readback.add(graph, name, image);
        if (request.wantColor)
            tickets.color = parts.slot.readback.add(graph, "color", context.color);
        if (request.wantDisplay && context.display.isValid())
            tickets.display = parts.slot.readback.add(graph, "display", context.display);
        return tickets;
    });
}

} // namespace shutter::render
