// SPDX-License-Identifier: MIT
// A frame that is kept up to date, held against extractFrame(), which starts from nothing.
#pragma once

#include "engine/extract/frame_extractor.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <cstring>
#include <ranges>
#include <utility>
#include <vector>

namespace shutter::extract {

template <class T> [[nodiscard]] bool isIdenticalBytes(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

[[nodiscard]] inline bool isSameDraw(const DrawItem& a, const DrawItem& b) {
    return a.entity == b.entity && a.geometry == b.geometry && a.geometryRow == b.geometryRow &&
           a.alphaMode == b.alphaMode && a.doubleSided == b.doubleSided &&
           a.mirrored == b.mirrored && a.distance == b.distance;
}

class KeptFrame : public Extraction {
  protected:
    /// Brings the kept frame up to date and holds it against a new one.
    const ExtractedFrame& update() {
        auto updated = extractor.update(world, layout, request);
        EXPECT_TRUE(updated.ok());
        const ExtractedFrame& kept = *updated.value();
        expectSame(kept, extract());
        follow(kept);
        return kept;
    }

    void expectSame(const ExtractedFrame& kept, const ExtractedFrame& fresh) const {
        ASSERT_EQ(kept.entityHandles, fresh.entityHandles);
        EXPECT_EQ(kept.entityMeshes, fresh.entityMeshes);
        for (size_t row = 0; row < fresh.entities.size(); ++row) {
            shader::EntityRow a = kept.entities[row];
            shader::EntityRow b = fresh.entities[row];
            ASSERT_EQ(a.motion == shader::kNoMotion, b.motion == shader::kNoMotion) << row;
            ASSERT_TRUE(isIdenticalBytes(motionOf(kept, row), motionOf(fresh, row))) << row;
            a.motion = b.motion = 0;
            ASSERT_TRUE(isIdenticalBytes(a, b)) << row;
        }
        EXPECT_TRUE(std::ranges::equal(kept.opaque.merge(), fresh.opaque.merge(), isSameDraw));
        EXPECT_TRUE(std::ranges::equal(kept.blended.merge(), fresh.blended.merge(), isSameDraw));
        ASSERT_EQ(kept.lightEntities, fresh.lightEntities);
        for (size_t i = 0; i < fresh.lights.size(); ++i)
            EXPECT_TRUE(isIdenticalBytes(kept.lights[i], fresh.lights[i])) << i;
        EXPECT_TRUE(isIdenticalBytes(kept.constants, fresh.constants));
        EXPECT_EQ(kept.moves, fresh.moves);
        expectSameDeformed(kept.deformed, fresh.deformed);
    }

    static void expectSameDeformed(
        const std::vector<DeformedEntity>& kept, const std::vector<DeformedEntity>& fresh
    ) {
        ASSERT_EQ(kept.size(), fresh.size());
        for (size_t i = 0; i < fresh.size(); ++i) {
            EXPECT_EQ(kept[i].row, fresh[i].row);
            EXPECT_EQ(kept[i].mesh, fresh[i].mesh);
            EXPECT_TRUE(isSame(kept[i].open, fresh[i].open));
            EXPECT_TRUE(isSame(kept[i].raster, fresh[i].raster));
            EXPECT_TRUE(isSame(kept[i].close, fresh[i].close));
            EXPECT_TRUE(isIdenticalBytes(kept[i].bounds, fresh[i].bounds));
            EXPECT_EQ(kept[i].changes, fresh[i].changes);
            EXPECT_EQ(kept[i].mirrored, fresh[i].mirrored);
        }
    }

    /// Does with a copy of the tables what EntityTable does on the device.
    void follow(const ExtractedFrame& frame) {
        const RowChanges& changes = frame.changes;
        EXPECT_EQ(changes.since, revision);
        EXPECT_EQ(changes.ownRows, frame.entities.size());
        if (changes.all)
            rows = frame.entities;
        ASSERT_EQ(rows.size(), frame.entities.size());
        for (const uint32_t row : changes.rows)
            rows.at(row) = frame.entities[row];
        for (size_t row = 0; row < rows.size(); ++row)
            EXPECT_TRUE(isIdenticalBytes(rows[row], frame.entities[row])) << row;
        if (frame.stillRevision != stillRevision)
            stillMotions = frame.stillMotions;
        ASSERT_EQ(stillMotions.size(), frame.stillMotions.size());
        for (size_t i = 0; i < stillMotions.size(); ++i)
            EXPECT_TRUE(isIdenticalBytes(stillMotions[i], frame.stillMotions[i])) << i;
        expectStillRowsOf(frame);
        revision = changes.revision;
        stillRevision = frame.stillRevision;
    }

    /// Those of one revision are the same rows in the same places.
    void expectStillRowsOf(const ExtractedFrame& frame) {
        EXPECT_TRUE(std::is_sorted(frame.movingRows.begin(), frame.movingRows.end()));
        std::vector<shader::EntityRow> still = frame.entities;
        for (const uint32_t row : frame.movingRows)
            still.at(row) = {};
        if (frame.stillRevision == stillRevision) {
            ASSERT_EQ(still.size(), stillRows.size());
            for (size_t row = 0; row < still.size(); ++row)
                EXPECT_TRUE(isIdenticalBytes(still[row], stillRows[row])) << row;
        }
        stillRows = std::move(still);
    }

    ecs::Entity addMover(const math::dvec3& position) {
        const ecs::Entity entity = addBox(position);
        world.registry.add(entity, scene::LinearVelocity{{0.5, 0.25, 0.0}});
        return entity;
    }

    scene::LocalTransform& transformOf(ecs::Entity entity) {
        return world.registry.get<scene::LocalTransform>(entity);
    }

    FrameExtractor extractor;
    uint64_t revision = 0;
    uint64_t stillRevision = 0;
    std::vector<shader::EntityRow> rows;
    std::vector<shader::EntityMotion> stillMotions;
    std::vector<shader::EntityRow> stillRows;
};

} // namespace shutter::extract
