// SPDX-License-Identifier: MIT
// Rays that go on from a surface: how many hit it again, and how many miss the next one a
// millimetre behind.
#include "engine/gpu/memory.h"
#include "engine/gpu/vulkan.h"
#include "engine/render/effect.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/passes/ray_reveal.h"
#include "shaders/motion_blur/hybrid_shared.h"
#include "tests/stability/hard_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::stability {
namespace {

using math::dvec3;

constexpr uint32_t kSizePx = 360; ///< more than 100,000 rays
constexpr double kGap = 1e-3;     // metres between the two surfaces
constexpr double kYFov = 0.6;

/// The reveal of every pixel, as if the mask were full; one ray each.
class RevealEverywhere : public render::Effect {
  public:
    RevealEverywhere(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mReveal(device, scene.textureLayout()) {}

    [[nodiscard]] std::string name() const override { return "reveal everywhere"; }

    [[nodiscard]] render::Needs decide(const render::DecideContext&) const override {
        return {
            .run = {true, "every pixel is traced"}, .rays = {true, "it is held against raster"}};
    }

    void declare(render::PictureContext& context) override {
        fillList(context.facts.width, context.facts.height);
        motion_blur::MotionBlurSettings settings;
        settings.recursionLimit = 2; // the raster's surface and one ray
        settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
        settings.method = &motion_blur::getMethod("hybrid");
        motion_blur::PassParams params = motion_blur::resolve(
            settings, context.facts.width, context.facts.height, context.facts.rasterTime
        );
        auto own = params.getMethod<shader::HybridParams>();
        own.frame = gpu::splitAddress(context.rays->frameConstants);
        params.setMethod(own);
        const motion_blur::RayRevealInputs inputs{
            context.color,
            context.gbuffer.motionDepth,
            context.gbuffer.entityId,
            context.color, // of the mask: read for entries that share a ray only, and none does
            context.graph.importBuffer("all pixels", mList.handle(), mList.bytes()),
            context.graph.importBuffer("all groups", mArguments.handle(), mArguments.bytes()),
            *context.rays};
        const motion_blur::RayRevealOutputs outputs = mReveal.add(context.graph, inputs, params);
        context.color = outputs.color;
        context.intermediates.publish("reveal_id", outputs.entityId);
    }

  private:
    void fillList(uint32_t width, uint32_t height) {
        const uint32_t count = width * height;
        std::vector<uint32_t> list(sizeof(shader::MaskHeader) / sizeof(uint32_t));
        list[0] = count;
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
                list.push_back(x | y << 16);
        const auto makeBuffer = [&](const char* name, size_t bytes, VkBufferUsageFlags usage) {
            return gpu::Buffer(mDevice, name, bytes, usage, gpu::MemoryUse::Stream);
        };
        mList = makeBuffer(
            "all pixels", list.size() * sizeof(uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT
        );
        mList.write(std::span<const uint32_t>(list));
        const std::array arguments{
            (count + shader::kRevealThreads - 1) / shader::kRevealThreads, 1u, 1u};
        mArguments =
            makeBuffer("all groups", sizeof(arguments), VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
        mArguments.write(std::span<const uint32_t>(arguments));
    }

    gpu::Device& mDevice;
    motion_blur::RayReveal mReveal;
    gpu::Buffer mList;
    gpu::Buffer mArguments;
};

/// Rows of the entity table, in the order in which the scene adds them.
constexpr float kFront = 0.0f;
constexpr float kBehind = 1.0f;

/// A sphere, another of the same facets a millimetre within it, a wall far behind.
SceneBuilder makeShells(double radius, double distance) {
    SceneBuilder scene;
    scene.setPerspective(kYFov, std::min(0.05, 0.1 * radius));
    const auto color = scene.addColor({0.5f, 0.5f, 0.5f});
    const dvec3 centre(0, 0, -distance);
    for (const double own : {radius, radius - kGap}) {
        scene.add(
            makePrimitive(generator::sphere(float(own), 160, 80), color),
            {.position = centre,
             .rotation = glm::angleAxis(0.7, glm::normalize(dvec3(0.3, 0.8, 0.2)))}
        );
    }
    scene.add(
        test::makeQuad(40.0 * radius, 40.0 * radius, color),
        {.position = centre - dvec3(0, 0, 3.0 * radius)}
    );
    return scene;
}

/// Whether the pixel's ray passes well within the inner sphere, so that missing it is a leak.
bool meetsInner(uint32_t x, uint32_t y, double radius, double distance) {
    const double focal = 0.5 * kSizePx / std::tan(0.5 * kYFov);
    const dvec3 direction =
        glm::normalize(dvec3(x + 0.5 - 0.5 * kSizePx, y + 0.5 - 0.5 * kSizePx, focal));
    const double nearest = distance * std::sqrt(1.0 - direction.z * direction.z);
    return nearest < 0.98 * (radius - kGap); // 2 %: facets lie within the sphere
}

class SelfIntersection : public test::GpuTest {};

TEST_F(SelfIntersection, AtMostOneOfAHundredThousandRaysHitsItsSurfaceAgainOrMissesTheNext) {
    if (!device().hasRays())
        GTEST_SKIP() << device().info().name << " traces no rays";
    const dvec3 far(6e3, -5e3, 6.2e3); // 10 km from the origin
    for (const auto& [radius, offset] :
         {std::pair{0.01, dvec3(0.0)},
          {1.0, dvec3(0.0)},
          {1000.0, dvec3(0.0)},
          {1.0, far},
          {1000.0, far}}) {
        const double distance = 3.0 * radius;
        SceneBuilder scene = makeShells(radius, distance);
        scene.moveAll(offset);
        render::Renderer renderer(device(), scene.world.assets);
        RevealEverywhere reveal(device(), renderer.scene());
        render::FrameRequest request;
        request.view.camera = scene.camera;
        request.view.width = request.view.height = kSizePx;
        request.intermediates = {"mesh_id", "reveal_id"};
        const std::array<render::Effect*, 1> effects{&reveal};
        const auto frame = need(renderer.renderFrame(scene.world, request, {.effects = effects}));
        uint64_t rays = 0;
        uint64_t again = 0;
        uint64_t through = 0;
        for (uint32_t y = 0; y < kSizePx; ++y)
            for (uint32_t x = 0; x < kSizePx; ++x) {
                if (frame.intermediates.at("mesh_id").at(x, y, 0) != kFront ||
                    !meetsInner(x, y, radius, distance))
                    continue;
                const float id = frame.intermediates.at("reveal_id").at(x, y, 0);
                ++rays;
                again += id == kFront;
                through += id != kFront && id != kBehind;
            }
        const std::string label =
            fmt::format(", sphere of {} m, {:.0f} m from the origin", radius, glm::length(offset));
        for (const auto& [check, count] :
             {std::pair{"own surface met again", again}, {"next surface missed", through}})
            hold(check + label, {double(count) / double(rays), rays}, 1e-5, "share of rays");
    }
}

} // namespace
} // namespace shutter::stability
