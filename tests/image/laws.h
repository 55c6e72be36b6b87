// SPDX-License-Identifier: MIT
// What laws of several subjects share: parts of scenes, and pictures held against others.
#pragma once

#include "engine/gpu/device.h"
#include "engine/image/metrics.h"
#include "modules/particles/particle_emitter.h"
#include "tests/kit/sweep.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::test {

/// For functions outside of fixtures; in a test that was not skipped.
inline gpu::Device& sharedDevice() {
    struct Fixture : GpuTest {
        using GpuTest::device;
    };

    return Fixture::device();
}

/// Whatever draws by `adaptive`, from several files: its pipelines take most of a minute to
/// compile, and the tests of a suite share them.
class AdaptiveLaw : public RayTest {};

inline constexpr scene::ShutterPhase kPhases[] = {
    scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End};

/// Methods that have the same laws in files where all others would be too many.
inline constexpr std::string_view kSharpAndResolved[] = {"sharp", "resolved"};

/// Those of a sweep over methods that a run draws: `chosen`, which differ most in what the law is
/// about, as far as the device runs them, or all (tests/kit/sweep.h).
inline std::vector<std::string_view>
pickMethods(const std::vector<std::string_view>& all, const std::vector<std::string_view>& chosen) {
    std::vector<std::string_view> picked;
    for (const std::string_view method : all)
        if (drawsAll() || std::find(chosen.begin(), chosen.end(), method) != chosen.end())
            picked.push_back(method);
    return picked;
}

/// Nothing before a camera.
inline SceneBuilder makeView(double yFov = 0.9, double near = 0.05) {
    SceneBuilder scene;
    scene.setPerspective(yFov, near);
    return scene;
}

/// Nothing before a camera whose pixels are metres.
inline SceneBuilder makePixelView(uint32_t heightPx) {
    SceneBuilder scene;
    scene.setPixelView(heightPx);
    return scene;
}

/// A camera before a wall of waves.
inline SceneBuilder
makeWavyRoom(double depth = 5.0, double width = 8.0, double height = 6.0, double yFov = 0.9) {
    SceneBuilder scene = makeView(yFov);
    scene.add(makeQuad(width, height, scene.addWaves()), {.position = {0, 0, -depth}});
    return scene;
}

/// A rectangle of one colour.
inline ecs::Entity addCard(
    SceneBuilder& scene,
    const math::dvec2& size,
    const math::vec3& color,
    const Placement& placement
) {
    return scene.add(makeQuad(size.x, size.y, scene.addColor(color)), placement);
}

inline ecs::Entity addBox(
    SceneBuilder& scene,
    const math::dvec3& size,
    const math::vec3& color,
    const Placement& placement
) {
    return scene.add(makeBox(size, scene.addColor(color)), placement);
}

/// Unlit, blended.
inline scene::AssetIndex addGlass(
    SceneBuilder& scene,
    const math::vec4& color,
    bool doubleSided = false,
    scene::BlendMode mode = scene::BlendMode::Over
) {
    scene::Material glass;
    glass.unlit = true;
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.blendMode = mode;
    glass.baseColorFactor = color;
    glass.doubleSided = doubleSided;
    return scene.addMaterial(std::move(glass));
}

inline ecs::Entity addEmitter(
    SceneBuilder& scene, const particles::ParticleEmitter& emitter, const math::dvec3& place
) {
    const ecs::Entity entity = scene.world.registry.create();
    scene.place(entity, {.position = place});
    particles::addEmitter(scene.world.registry, entity, emitter);
    return entity;
}

inline ecs::Entity
addLight(SceneBuilder& scene, const scene::Light& light, const Placement& placement) {
    const ecs::Entity entity = scene.world.registry.create();
    scene.place(entity, placement);
    scene.world.registry.add(entity, light);
    return entity;
}

/// Puts the entity under a new one of that transform.
inline ecs::Entity
addParent(SceneBuilder& scene, ecs::Entity child, const math::Transform& transform = {}) {
    const ecs::Entity parent = scene.world.registry.create();
    scene.world.registry.add(parent, scene::LocalTransform{transform});
    scene.world.registry.add(child, scene::Parent{parent});
    return parent;
}

/// Without the joints and weights that makeStrip() binds to.
inline scene::Primitive unbound(scene::Primitive strip) {
    strip.influenceCount = 0;
    strip.joints.clear();
    strip.weights.clear();
    return strip;
}

/// Sum of one channel of all pixels.
inline double sumChannel(const image::Image& picture, uint32_t channel) {
    double sum = 0.0;
    for (size_t i = channel; i < picture.pixels.size(); i += picture.channels)
        sum += double(picture.pixels[i]);
    return sum;
}

inline double sumLight(const image::Image& picture) {
    return sumChannel(picture, 0) + sumChannel(picture, 1) + sumChannel(picture, 2);
}

inline float findBrightest(const image::Image& picture) {
    return *std::max_element(picture.pixels.begin(), picture.pixels.end());
}

/// One shot by several methods, held against its mean of instants, which is drawn once.
class Comparison {
  public:
    /// \param scene outlives this
    Comparison(gpu::Device& device, const SceneBuilder& scene, const Shot& shot, uint32_t instants)
        : mShot(shot), mStage(device, scene) {
        Shot truth = shot;
        truth.method = "accumulate";
        truth.instants = instants;
        mTruth = mStage.render(truth).color;
    }

    [[nodiscard]] const image::Image& truth() const { return mTruth; }

    [[nodiscard]] render::FrameResult render(std::string_view method) {
        mShot.method = method;
        return mStage.render(mShot);
    }

    [[nodiscard]] double psnr(std::string_view method) { return psnr(render(method)); }

    [[nodiscard]] double psnr(const render::FrameResult& frame) const {
        return image::computePsnr(frame.color, mTruth);
    }

    [[nodiscard]] double psnr(const Shot& shot) { return psnr(mStage.render(shot)); }

  private:
    Shot mShot;
    Stage mStage;
    image::Image mTruth;
};

} // namespace shutter::test
