// SPDX-License-Identifier: MIT
// A small world for the tests of extraction: a camera at the origin and meshes of one box each.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/extract/timed_tables.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace shutter::extract {

class Extraction : public testing::Test {
  protected:
    Extraction() { reset(); }

    void reset() {
        world = {};
        layout = {};
        request = {};
        addMesh(scene::AlphaMode::Opaque, 1);
        camera = addCamera({});
        request.camera = camera;
        request.width = 200;
        request.height = 100;
        request.exposure = {0.0, 1.0, 1.0, 1.0};
    }

    ecs::Entity addCamera(const math::Transform& transform) {
        const ecs::Entity entity = world.registry.create();
        world.registry.add(entity, scene::LocalTransform{transform});
        world.registry.add(entity, scene::Camera{});
        return entity;
    }

    /// A mesh that fills [-1, 1]^3, with `primitives` geometries.
    uint32_t addMesh(scene::AlphaMode alphaMode, uint32_t primitives) {
        if (layout.firstGeometry.empty())
            layout.firstGeometry.push_back(0);
        for (uint32_t i = 0; i < primitives; ++i)
            layout.geometries.push_back({0, 3, alphaMode, false});
        layout.firstGeometry.push_back(static_cast<uint32_t>(layout.geometries.size()));
        layout.bounds.push_back({math::dvec3(-1.0), math::dvec3(1.0)});
        return static_cast<uint32_t>(layout.bounds.size() - 1);
    }

    ecs::Entity addBox(const math::dvec3& position, uint32_t mesh = 0) {
        math::Transform transform;
        transform.translation = position;
        return addBox(transform, mesh);
    }

    ecs::Entity addBox(const math::Transform& transform, uint32_t mesh = 0) {
        const ecs::Entity entity = world.registry.create();
        world.registry.add(entity, scene::LocalTransform{transform});
        world.registry.add(entity, scene::MeshInstance{mesh});
        return entity;
    }

    ecs::Entity
    addMover(const math::dvec3& position, const math::dvec3& velocity, uint32_t mesh = 0) {
        const ecs::Entity entity = addBox(position, mesh);
        world.registry.add(entity, scene::LinearVelocity{velocity});
        return entity;
    }

    /// Goes along the x axis: as far as each key has it, `ahead` of the origin.
    void animateX(
        ecs::Entity entity,
        std::vector<float> times,
        const std::vector<float>& metres,
        scene::Interpolation interpolation = scene::Interpolation::Linear,
        float ahead = 0.0f
    ) {
        std::vector<math::vec4> values;
        for (const float x : metres)
            values.emplace_back(x, 0.0f, -ahead, 0.0f);
        const auto path = scene::AnimationPath::Translation;
        animate(entity, path, interpolation, std::move(times), std::move(values));
    }

    /// Scales all axes.
    void animateScale(
        ecs::Entity entity,
        std::vector<float> times,
        const std::vector<float>& factors,
        scene::Interpolation interpolation = scene::Interpolation::Linear
    ) {
        std::vector<math::vec4> values;
        for (const float factor : factors)
            values.emplace_back(factor);
        const auto path = scene::AnimationPath::Scale;
        animate(entity, path, interpolation, std::move(times), std::move(values));
    }

    /// Gives mesh 0 a vertex at each corner of its box: the lower ones bend with the first joint of
    /// a skin, the upper ones with its last, and a morph target lifts these by 1 m.
    void makeDeformable(uint16_t joints, float lowerLift = 0.0f) {
        scene::Primitive box;
        box.influenceCount = 4;
        scene::MorphTarget target;
        for (int corner = 0; corner < 8; ++corner) {
            const bool above = corner & 2;
            box.positions.push_back(
                {corner & 1 ? 1.0f : -1.0f, above ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f}
            );
            box.joints.insert(box.joints.end(), {uint16_t(above ? joints - 1 : 0), 0, 0, 0});
            box.weights.insert(box.weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
            target.positions.push_back({0.0f, above ? 1.0f : lowerLift, 0.0f});
        }
        box.morphTargets.push_back(target);
        layout.geometries[0].vertexCount = 8;
        layout.reaches.assign(layout.bounds.size(), scene::computePoseReach({&box, 1}));
        world.assets.skins.push_back({"", std::vector<math::dmat4>(joints, math::dmat4(1.0))});
    }

    /// A box of mesh 0 whose morph target's weight is animated.
    ecs::Entity
    addMorphed(const math::dvec3& position, std::vector<float> times, std::vector<float> weights) {
        const ecs::Entity entity = addBox(position);
        const auto clip = static_cast<uint32_t>(world.assets.clips.size());
        world.registry.add(entity, scene::MorphWeights{{weights.front()}, {{clip, 0}}});
        scene::WeightChannel channel;
        channel.targetCount = 1;
        channel.times = std::move(times);
        channel.values = std::move(weights);
        const double duration = double{channel.times.back()};
        world.assets.clips.push_back({"", duration, {}, {std::move(channel)}});
        return entity;
    }

    ExtractedFrame extract() {
        auto frame = extractFrame(world, layout, request);
        EXPECT_TRUE(frame.ok());
        return std::move(frame).value();
    }

    TimedTables computeTables(const ExtractedFrame& frame) const {
        auto tables = computeTimedTables(world, layout, request, frame);
        EXPECT_TRUE(tables.ok());
        return std::move(tables).value();
    }

    [[nodiscard]] scene::ExposureMotion motion() const {
        return {world, request.camera, request.exposure};
    }

    /// Motion of a row of the table; one without motion is at the ends where it is at the raster
    /// instant.
    static shader::EntityMotion motionOf(const ExtractedFrame& frame, size_t row) {
        const shader::EntityRow& entry = frame.entities.at(row);
        if (entry.motion == shader::kNoMotion)
            return {entry.clipFromObjectRaster, entry.clipFromObjectRaster};
        const size_t stillCount = frame.staticMotions.size();
        return entry.motion < stillCount ? frame.staticMotions[entry.motion]
                                         : frame.movingMotions.at(entry.motion - stillCount);
    }

    static math::vec3 project(const math::mat4& clipFromObject, const math::vec3& point) {
        const math::vec4 clip = clipFromObject * math::vec4(point, 1.0f);
        return math::vec3(clip) / clip.w;
    }

    scene::World world;
    SceneLayout layout;
    ViewRequest request;
    ecs::Entity camera;

  private:
    /// Adds a channel of a clip of its own.
    void animate(
        ecs::Entity entity,
        scene::AnimationPath path,
        scene::Interpolation interpolation,
        std::vector<float> times,
        std::vector<math::vec4> values
    ) {
        scene::AnimationClip clip;
        clip.duration = double{times.back()};
        clip.channels.push_back({0, path, interpolation, std::move(times), std::move(values)});
        const auto index = static_cast<uint32_t>(world.assets.clips.size());
        world.assets.clips.push_back(std::move(clip));
        if (!world.registry.has<scene::Animated>(entity))
            world.registry.add(entity, scene::Animated{});
        world.registry.get<scene::Animated>(entity).channels.push_back({index, 0});
    }
};

} // namespace shutter::extract
