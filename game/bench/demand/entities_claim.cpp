// SPDX-License-Identifier: MIT
#include "assets/generator/mesh_shapes.h"
#include "game/bench/demand/figures.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::demand {

namespace {

constexpr double kWorkRatio = 1.5;
constexpr int kMovers = 10;
constexpr int kMostEntities = 10'000;
constexpr double kExposureSeconds = 1.0 / 60.0;
constexpr double kStepSeconds = 1.0 / 240.0;
constexpr uint32_t kMoreRounds = 4; ///< of so cheap a figure

/// Boxes in a square grid that is as large however many they are, in one plane.
struct Grid {
    int count = 0;

    [[nodiscard]] int side() const { return static_cast<int>(std::ceil(std::sqrt(double(count)))); }

    [[nodiscard]] double cell() const { return 3.6 / side(); }

    /// Of a box, metres.
    [[nodiscard]] math::dvec3 place(int index) const {
        const double half = 0.5 * (side() - 1);
        return {cell() * (index % side() - half), cell() * (index / side() - half), -5.0};
    }

    [[nodiscard]] generator::Shape shape() const {
        return stability::makeBox(0.6 * cell(), 0.6 * cell(), 0.02);
    }
};

/// The first boxes move, the others stand still: entities of one mesh, or all in one mesh of one
/// entity. Either way the picture is the same.
std::unique_ptr<Stage> makeBoxes(int count, bool merged) {
    stability::SceneDraft draft;
    const Grid grid{count};
    const auto material = draft.addLitWaves();
    auto& registry = draft.shot.world.registry;
    scene::AssetIndex mesh = scene::kNone;
    for (int i = 0; i < kMovers; ++i) {
        const math::dvec3 velocity(0.3 * std::cos(double(i)), 0.3 * std::sin(double(i)), 0.0);
        const stability::Stand stand{
            .position = grid.place(i) + math::dvec3(0, 0, 0.3), .velocity = velocity};
        if (i == 0) {
            const ecs::Entity first = draft.add(grid.shape(), material, stand);
            mesh = registry.get<scene::MeshInstance>(first).mesh;
            continue;
        }
        const ecs::Entity mover = registry.create();
        registry.add(mover, scene::MeshInstance{mesh});
        draft.place(mover, stand);
    }
    generator::Shape all;
    for (int i = kMovers; i < count; ++i) {
        if (merged) {
            generator::append(
                all, grid.shape(), glm::translate(glm::mat4(1.0f), glm::vec3(grid.place(i)))
            );
            continue;
        }
        const ecs::Entity box = registry.create();
        registry.add(box, scene::MeshInstance{mesh});
        draft.place(box, {.position = grid.place(i)});
    }
    if (merged)
        draft.add(all, material, stability::Stand{});
    draft.addSun(glm::normalize(math::dvec3(-0.4, -0.7, -0.6)), 3.0f);
    return makeStage(draft, kExposureSeconds);
}

/// What a frame does because there are entities: extraction, entity table and top levels on the CPU
/// (all that it does until the frame is submitted, where the renderer does not tell these apart),
/// and the GPU's builds of acceleration structures.
double entityWork(const render::FrameStatistics& frame) {
    double onCpu = 0.0;
    bool isTold = false;
    for (const char* name : {"extraction ms", "entity table ms", "top level ms"})
        if (const auto found = frame.measures.find(name); found != frame.measures.end()) {
            onCpu += found->second;
            isTold = true;
        }
    const double onGpu =
        sumPasses(frame, [](std::string_view pass) { return pass.starts_with("build"); });
    return (isTold ? onCpu : frame.cpuMilliseconds) + onGpu;
}

core::Result<Findings> measureEntities(gpu::Device& device, const DemandOptions& options) {
    struct Variant {
        int count;
        bool merged;
    };

    constexpr Variant kVariants[] = {
        {kMostEntities, true}, {100, false}, {1000, false}, {kMostEntities, false}};
    const char* method = device.hasRays() ? "hybrid" : "gather";
    std::vector<std::unique_ptr<Stage>> stages;
    Subjects subjects;
    for (const Variant& variant : kVariants) {
        stages.push_back(makeBoxes(variant.count, variant.merged));
        auto subject =
            Subject::create(device, *stages.back(), method, options.width, options.height);
        if (!subject)
            return subject.error();
        subject.value()->setStep(kStepSeconds);
        subjects.push_back(std::move(subject).value());
    }
    auto frames = takeTurns(subjects, options.rounds * kMoreRounds);
    if (!frames)
        return frames.error();
    const Frames& merged = frames.value().front();
    const Frames& all = frames.value().back();
    Findings findings;
    findings.checks.push_back(checkMedian(
        fmt::format("{} entities, {} of which move", kMostEntities, kMovers),
        compare(all, merged, entityWork, entityWork),
        kWorkRatio,
        "of the merged scene's",
        all.size(),
        fmt::format(
            "{:.4g} against {:.4g} ms",
            summarize(all, entityWork).median,
            summarize(merged, entityWork).median
        )
    ));
    Curve curve{
        "entities", "Work for entities", "entities in the picture", "", "CPU and builds", "ms", {}};
    for (size_t i = 0; i < std::size(kVariants); ++i) {
        const bool isMerged = kVariants[i].merged;
        const int count = isMerged ? kMovers + 1 : kVariants[i].count;
        curve.points.push_back(
            {double(count),
             summarize(frames.value()[i], entityWork),
             isMerged ? fmt::format("{} and all others merged", kMovers) : fmt::format("{}", count)}
        );
    }
    findings.curves.push_back(std::move(curve));
    return findings;
}

} // namespace

Claim makeEntitiesClaim() {
    return {
        "Entities",
        "What stands still is not looked at",
        "Ten movers among boxes that stand still before a camera that stands still, as entities of "
        "their own against one merged mesh: extraction, tables and acceleration structures of a "
        "frame whose time goes on.",
        measureEntities};
}

} // namespace shutter::demand
