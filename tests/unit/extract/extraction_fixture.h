// SPDX-License-Identifier: MIT
// A small world for the tests of extraction: a camera at the origin and meshes of one box each.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace shutter::extract {

class Extraction : public testing::Test {
  protected:
    Extraction() {
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

    ExtractedFrame extract() {
        auto frame = extractFrame(world, layout, request);
        EXPECT_TRUE(frame.ok());
        return std::move(frame).value();
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
};

} // namespace shutter::extract
