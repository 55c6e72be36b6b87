// SPDX-License-Identifier: MIT
// Motion of a host: places of surfaces at the instants as its keys and ids give them, and refusals.
// What tables of layers have for the engine and hosts alike is in
// tests/unit/extract/instant_tables_test.cpp.
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "shaders/common/shutter_response_shared.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;
using math::LayerTables;
using math::vec3;
using math::vec4;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// A host with a moving and rotating camera.
class HostMotionFixture : public ::testing::Test {
  protected:
    static constexpr uint32_t kInstants = 5;
    static constexpr uint32_t kRows = 4;

    HostMotionFixture() {
        frame.sizePx = {200, 100};
        frame.rasterTime = 1.0;
        frame.instantCount = kInstants;
        setKeys({0.0, 0.5, 1.0});
    }

    static math::dmat4
    place(const math::dvec3& at, const math::dvec3& axis, double angle, double scale = 1.0) {
        math::Transform transform;
        transform.translation = at;
        transform.rotation = glm::angleAxis(angle, glm::normalize(axis));
        transform.scale = math::dvec3(scale);
        return math::computeMatrix(transform);
    }

    /// Seconds, frames and shutter times are one: time 1 of a frame is time 0 of the next.
    static math::dmat4 worldFromViewAt(double seconds) {
        const math::dvec3 at = math::dvec3(0.3, -0.1, 0.4) * seconds;
        return place(at, {1.0, 2.0, 3.0}, 0.2 * seconds);
    }

    /// Turns by less than half a turn from key to key, and is scaled.
    static math::dmat4 worldFromTumblerAt(double seconds) {
        return place(
            math::dvec3(0.5, 0.2, -8.0) + math::dvec3(1.0, 0.5, 1.5) * seconds,
            {2.0, 3.0, 1.0},
            3.7 * seconds,
            2.5
        );
    }

    [[nodiscard]] math::dmat4 projection() const {
        return isPerspective ? math::clipFromViewPerspective(0.9, 2.0, 0.1)
                             : math::clipFromViewOrthographic(6.0, 3.0, 0.1, 100.0);
    }

    /// Keys at these shutter times, of the frame that opens at `openSeconds`.
    void setKeys(const std::vector<double>& times) {
        keys.clear();
        for (const double time : times) {
            const math::dmat4 view = glm::inverse(worldFromViewAt(openSeconds + time));
            keys.push_back({time, view, projection()});
        }
        motion.keys = keys;
        motion.rowCount = kRows;
    }

    /// Row 1 is the tumbler, one matrix a key.
    void addTumbler(uint32_t row = 1) {
        matrices.clear();
        for (const HostCameraKey& key : keys)
            matrices.push_back(worldFromTumblerAt(openSeconds + key.time));
        movers = {{row, matrices}};
        motion.movers = movers;
    }

    [[nodiscard]] core::Status check() const { return checkMotion(motion, frame); }

    [[nodiscard]] HostInstants compute(const HostRaster* last = nullptr) const {
        const core::Status valid = check();
        EXPECT_TRUE(valid.ok()) << valid.error().message;
        return computeHostInstants(motion, frame, last);
    }

    bool isPerspective = true;
    double openSeconds = 0.0;
    HostMotionFrame frame;
    HostMotion motion;
    std::vector<HostCameraKey> keys;
    std::vector<HostMover> movers;
    std::vector<math::dmat4> matrices;
};

/// What a pixel shows: its place and its depth.
struct Seen {
    math::dvec2 at{0.0};
    double depth = 0.0;
};

class HostInstantsTest : public HostMotionFixture {
  protected:
    [[nodiscard]] Seen project(const dvec4& inWorld, double seconds) const {
        const dvec4 inView = glm::inverse(worldFromViewAt(seconds)) * inWorld;
        const dvec4 clip = projection() * inView;
        return {(math::dvec2(clip) / clip.w * 0.5 + 0.5) * math::dvec2(frame.sizePx), -inView.z};
    }

    [[nodiscard]] static dvec4 cornerAt(double seconds) {
        return worldFromTumblerAt(seconds) * dvec4(0.3, -0.2, 0.1, 1.0);
    }

    [[nodiscard]] vec3 apply(const vec4 (&rows)[3], const Seen& seen) const {
        const float q = isPerspective ? float(seen.depth) : 1.0f;
        const vec4 point(vec3(math::vec2(seen.at) * q, float(seen.depth)), 1.0f);
        vec3 moved(glm::dot(rows[0], point), glm::dot(rows[1], point), glm::dot(rows[2], point));
        if (isPerspective)
            moved = {moved.x / moved.z, moved.y / moved.z, moved.z};
        return moved;
    }

    /// The maps of a row take what the raster shows to where the instants of this frame do.
    /// \param inWorldAt where the point is at a time in seconds
    template <class At>
    void expectMaps(const LayerTables& layer, uint32_t row, const Seen& raster, const At& inWorldAt)
        const {
        for (uint32_t i = 0; i < kInstants; ++i) {
            const auto& found = layer.motions.at(layer.movers.at(row) * kInstants + i);
            const double seconds = openSeconds + (i + 0.5) / kInstants;
            const Seen seen = project(inWorldAt(seconds), seconds);
            const vec3 there = apply(found.instantFromRaster, raster);
            EXPECT_NEAR(there.x, seen.at.x, 2e-3) << i;
            EXPECT_NEAR(there.y, seen.at.y, 2e-3) << i;
            EXPECT_NEAR(there.z, seen.depth, 1e-4) << i;
            const vec3 back = apply(found.rasterFromInstant, seen);
            EXPECT_NEAR(back.x, raster.at.x, 2e-3) << i;
            EXPECT_NEAR(back.y, raster.at.y, 2e-3) << i;
        }
    }

    void nextFrame() {
        openSeconds += 1.0;
        setKeys({0.0, 0.5, 1.0});
        addTumbler();
    }
};

TEST_F(HostInstantsTest, ThreeKeysAreEnoughForWhatTurnsBeforeATurningCameraOfEitherKind) {
    const dvec4 still(0.5, 0.5, -9.0, 1.0);
    for (const bool perspective : {true, false}) {
        isPerspective = perspective;
        setKeys({0.0, 0.5, 1.0});
        addTumbler();
        const HostInstants made = compute();
        EXPECT_EQ(made.layers.isPerspective, perspective);
        EXPECT_FALSE(made.layers.raster.isStatic);
        EXPECT_FALSE(made.layers.last.has_value());
        expectMaps(made.layers.raster, 1, project(cornerAt(1.0), 1.0), cornerAt);
        EXPECT_EQ(made.layers.raster.movers.at(0), shader::kWorldMover);
        EXPECT_EQ(made.layers.raster.movers.at(kRows), shader::kSkyMover);
        expectMaps(made.layers.raster, 0, project(still, 1.0), [&](double) { return still; });
    }
}

TEST_F(HostInstantsTest, AKeyBeforeTheShutterOpensCountsForWhatComesAfterIt) {
    HostInputs inputs;
    inputs.convention.scales.exposureShare = 0.8f;
    const double before = timeOfFrameBefore(inputs);
    EXPECT_NEAR(before, -0.25, 1e-7);
    setKeys({before, 0.4, 1.0}); // by less than half a turn from key to key
    addTumbler();
    const HostInstants made = compute();
    expectMaps(made.layers.raster, 1, project(cornerAt(1.0), 1.0), cornerAt);
}

TEST_F(HostInstantsTest, TheTimeOfTheFrameBeforeIsFiniteWhateverTheShare) {
    HostInputs inputs;
    EXPECT_DOUBLE_EQ(timeOfFrameBefore(inputs), -1.0); // half of the time between the frames
    inputs.rasterTime = 0.5;
    EXPECT_DOUBLE_EQ(timeOfFrameBefore(inputs), -1.5);
    inputs.convention.scales.displayedPerRendered = 2.0f;
    EXPECT_DOUBLE_EQ(timeOfFrameBefore(inputs), -3.5);
    for (const float share : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
        inputs.convention.scales.exposureShare = share;
        setKeys({timeOfFrameBefore(inputs), 0.5});
        frame.rasterTime = 0.5;
        EXPECT_TRUE(check().ok()) << check().error().message;
    }
}

TEST_F(HostInstantsTest, AViewAlongPlusZGivesTheSameTables) {
    addTumbler();
    for (const bool perspective : {true, false}) {
        isPerspective = perspective;
        setKeys({0.0, 0.5, 1.0});
        motion.aheadIsPlusZ = false;
        const HostInstants minus = compute();
        const dmat4 flip = glm::scale(dmat4(1.0), dvec3(1.0, 1.0, -1.0));
        for (HostCameraKey& key : keys) {
            key.viewFromWorld = flip * key.viewFromWorld;
            key.clipFromView = 0.5 * key.clipFromView * flip; // homogeneous: any factor does
        }
        motion.aheadIsPlusZ = true;
        const HostInstants plus = compute();
        for (size_t i = 0; i < minus.layers.raster.motions.size(); ++i)
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column)
                    EXPECT_NEAR(
                        minus.layers.raster.motions[i].instantFromRaster[row][column],
                        plus.layers.raster.motions[i].instantFromRaster[row][column],
                        1e-4
                    );
    }
}

TEST_F(HostInstantsTest, EverythingIsStaticOutsideOfTheKeys) {
    setKeys({0.5});
    frame.rasterTime = 0.5;
    addTumbler();
    const HostRaster last = compute().raster;
    const HostInstants made = compute(&last);
    EXPECT_TRUE(made.layers.raster.isStatic && made.layers.last->isStatic);
    EXPECT_EQ(made.layers.raster.movers.at(1), shader::kWorldMover);
    setKeys({0.0, 0.5});
    addTumbler();
    const HostInstants half = compute();
    const size_t mover = half.layers.raster.movers.at(1);
    const auto& late = half.layers.raster.motions;
    EXPECT_EQ(
        late.at(mover * kInstants + 3).instantFromRaster[0],
        late.at(mover * kInstants + 4).instantFromRaster[0]
    );
}

TEST_F(HostInstantsTest, AScaleSlowsTheCameraAndTheMoversAboutTheRaster) {
    setKeys({-1.0, 0.0, 0.5, 1.0});
    addTumbler();
    // Half of the motion is that of an exposure of half the time, which ends as this one does.
    motion.cameraScale = motion.objectScale = 0.5;
    const HostInstants made = compute();
    const auto& found = made.layers.raster;
    for (uint32_t i = 0; i < kInstants; ++i) {
        const double seconds = 1.0 + ((i + 0.5) / kInstants - 1.0) * 0.5;
        const vec3 there = apply(
            found.motions.at(found.movers.at(1) * kInstants + i).instantFromRaster,
            project(cornerAt(1.0), 1.0)
        );
        const Seen seen = project(cornerAt(seconds), seconds);
        EXPECT_NEAR(there.x, seen.at.x, 2e-3) << i;
        EXPECT_NEAR(there.y, seen.at.y, 2e-3) << i;
    }
    motion.cameraScale = 0.0;
    EXPECT_TRUE(compute().layers.raster.isStatic);
    EXPECT_NE(compute().layers.raster.movers.at(1), shader::kWorldMover);
    motion.objectScale = 0.0;
    EXPECT_EQ(compute().layers.raster.movers.at(1), shader::kWorldMover);
}

TEST_F(HostInstantsTest, AViewModelStaysWhereItIsInThePictureAndHasNoHistory) {
    const std::vector<uint32_t> rows{2};
    const HostRaster before = compute().raster;
    motion.viewModelRows = rows;
    const HostRaster last = compute().raster;
    nextFrame();
    const HostInstants made = compute(&last);
    const LayerTables& raster = made.layers.raster;
    for (uint32_t i = 0; i < kInstants; ++i) {
        const auto& found = raster.motions.at(raster.movers.at(2) * kInstants + i);
        const vec3 there = apply(found.instantFromRaster, {{30.0, 40.0}, 0.7});
        EXPECT_NEAR(there.x, 30.0f, 1e-4f) << i;
        EXPECT_NEAR(there.y, 40.0f, 1e-4f) << i;
    }
    EXPECT_EQ(made.layers.last->movers.at(2), shader::kNoMover);
    EXPECT_EQ(compute(&before).layers.last->movers.at(2), shader::kNoMover) << "it was static";
    motion.viewModelRows = {};
    EXPECT_EQ(compute(&last).layers.last->movers.at(2), shader::kNoMover) << "it is static now";
}

TEST_F(HostInstantsTest, AViewModelThatMovesFollowsItsPosesByItsOwnProjection) {
    // As seen by a lens of its own, in a part of the range of depth.
    const math::dmat4 own = math::clipFromViewPerspective(0.6, 2.0, 0.02);
    math::dmat4 range(1.0);
    range[2].z = 0.25;
    range[3].z = 0.75;
    motion.hasViewModel = true;
    motion.viewModelProjection = range * own;
    const auto poseAt = [](double seconds) {
        return glm::translate(
            math::dmat4(1.0), math::dvec3(0.1 * seconds, 0.05, -0.6 - 0.1 * seconds)
        );
    };
    std::vector<math::dmat4> poses;
    for (const HostCameraKey& key : keys)
        poses.push_back(poseAt(openSeconds + key.time));
    motion.viewFromObject = poses;
    const auto see = [&](double seconds) {
        const dvec4 inView = poseAt(seconds) * dvec4(0.02, -0.03, 0.01, 1.0);
        const dvec4 clip = own * inView;
        return Seen{
            (math::dvec2(clip) / clip.w * 0.5 + 0.5) * math::dvec2(frame.sizePx), -inView.z};
    };
    const uint32_t row = motion.rowCount; // one more
    const HostInstants made = compute();
    for (uint32_t i = 0; i < kInstants; ++i) {
        const auto& found =
            made.layers.raster.motions.at(made.layers.raster.movers.at(row) * kInstants + i);
        const Seen seen = see((i + 0.5) / kInstants);
        const vec3 there = apply(found.instantFromRaster, see(1.0));
        EXPECT_NEAR(there.x, seen.at.x, 2e-3) << i;
        EXPECT_NEAR(there.y, seen.at.y, 2e-3) << i;
        EXPECT_NEAR(there.z, seen.depth, 1e-5) << i;
    }
    // It has no history, and no other row is mistaken for it where the host has more.
    const HostRaster last = made.raster;
    nextFrame();
    motion.rowCount = row + 1;
    EXPECT_EQ(compute(&last).layers.last->movers.at(row), shader::kNoMover);
    EXPECT_EQ(compute(&last).layers.last->rasterRows.at(row), shader::kNoRasterRow);
    motion.objectScale = 0.0;
    const auto& fixed = compute().layers.raster;
    const vec3 there =
        apply(fixed.motions.at(fixed.movers.at(row + 1) * kInstants).instantFromRaster, see(1.0));
    EXPECT_NEAR(there.x, see(1.0).at.x, 1e-4);
}

TEST_F(HostInstantsTest, ALensDisplacesByItsPlacesWhatIsOutOfFocus) {
    motion.lens = {.radius = 0.02, .focusDistance = 4.0, .squeeze = 2.0};
    const HostInstants made = compute();
    const math::InstantLayers& layers = made.layers;
    constexpr size_t kPairs = size_t(kInstants) * shader::kLensSets;
    ASSERT_EQ(layers.lens.size(), kPairs);
    ASSERT_EQ(layers.lensPlaces.size(), kPairs);
    ASSERT_EQ(layers.times.size(), kPairs);
    EXPECT_FALSE(layers.raster.isStatic);
    EXPECT_EQ(layers.raster.motions.size(), 2u * kInstants) << "the pinhole's";
    math::dvec2 widest(0.0);
    for (size_t i = 0; i < kPairs; ++i) {
        EXPECT_NEAR(layers.times[i], (double(i / shader::kLensSets) + 0.5) / kInstants, 1e-6);
        // A point straight ahead, from the place and from the lens's middle.
        const math::dvec2 place(layers.lensPlaces[i]);
        const double depth = 9.0;
        const dvec4 seen = projection() * dvec4(-place, -depth, 1.0);
        const dvec4 focused = projection() * dvec4(-place, -4.0, 1.0);
        const math::dvec2 moved = 0.5 * math::dvec2(frame.sizePx) *
                                  (math::dvec2(seen) / seen.w - math::dvec2(focused) / focused.w);
        const vec4 shift = layers.lens[i];
        EXPECT_NEAR(shift.x + shift.z / depth, moved.x, 1e-5) << i;
        EXPECT_NEAR(shift.y + shift.w / depth, moved.y, 1e-5) << i;
        EXPECT_NEAR(shift.x + shift.z / 4.0, 0.0, 1e-6) << i;
        widest = glm::max(widest, glm::abs(place));
    }
    EXPECT_LE(widest.y, 0.02 + 1e-9);
    EXPECT_GT(widest.y, 0.019);
    EXPECT_NEAR(widest.x / widest.y, 2.0, 0.1);
    // Circle of confusion at the raster instant: 2 |x - y / z|.
    const double pixelsPerUnit = 50.0 / std::tan(0.45);
    EXPECT_NEAR(layers.confusion.y, 0.02 * pixelsPerUnit, 1e-4);
    EXPECT_NEAR(layers.confusion.x, 0.02 * pixelsPerUnit / 4.0, 1e-4);
}

TEST_F(HostInstantsTest, AFocusIsPulledFromKeyToKeyAndALensGrowsWithTheFocalLength) {
    const std::vector<double> distances{2.0, 3.0, 5.0};
    motion.lens = {.radius = 0.02, .focusDistance = kNoNumber, .focusDistances = distances};
    const math::InstantLayers constant = compute().layers;
    keys[0].clipFromView = math::clipFromViewPerspective(1.6, 2.0, 0.1);
    const HostInstants made = compute();
    for (uint32_t i = 0; i < kInstants; ++i) {
        const double s = (i + 0.5) / kInstants;
        const double inverse = s < 0.5 ? glm::mix(1.0 / 2.0, 1.0 / 3.0, 2.0 * s)
                                       : glm::mix(1.0 / 3.0, 1.0 / 5.0, 2.0 * s - 1.0);
        EXPECT_NEAR(made.layers.lensReaches.at(i).inverseFocus, inverse, 1e-6) << i;
    }
    const double zoom = glm::mix(std::tan(0.45) / std::tan(0.8), 1.0, 0.2); // at time 0.1
    for (size_t i = 0; i < made.layers.lensPlaces.size(); ++i) {
        const math::vec2 expected =
            constant.lensPlaces[i] * (i < shader::kLensSets ? float(zoom) : 1.0f);
        if (i < shader::kLensSets || i >= 3 * shader::kLensSets) {
            EXPECT_NEAR(made.layers.lensPlaces[i].x, expected.x, 1e-7) << i;
            EXPECT_NEAR(made.layers.lensPlaces[i].y, expected.y, 1e-7) << i;
        }
    }
    EXPECT_NEAR(made.layers.confusion.y / made.layers.confusion.x, 5.0, 1e-4);
}

TEST_F(HostInstantsTest, ThroughALensALastRasterOfTheSameAddsNothing) {
    motion.lens = {.radius = 0.02};
    addTumbler();
    const HostRaster same = compute().raster;
    EXPECT_FALSE(compute(&same).layers.last.has_value());
    nextFrame();
    const HostInstants other = compute(&same);
    ASSERT_TRUE(other.layers.last.has_value());
    EXPECT_FALSE(other.layers.last->isStatic);
    const HostRaster mover = other.raster;
    for (math::dmat4& matrix : matrices)
        matrix[3].x += 1.0;
    EXPECT_TRUE(compute(&mover).layers.last.has_value()) << "under a camera that stays";
    movers[0].worldFromObject = {};
    const HostRaster deforming = compute().raster;
    EXPECT_TRUE(compute(&deforming).layers.last.has_value());
    motion.lens = {};
    EXPECT_TRUE(compute(&deforming).layers.last.has_value());
}

TEST_F(
    HostInstantsTest, MoversWithoutTransformsAreFoundByMotionVectorsAndSingularOnesAreInvisible
) {
    movers = {{2, {}}};
    motion.movers = movers;
    EXPECT_EQ(compute().layers.raster.movers.at(2), shader::kDeformedMover);
    addTumbler();
    for (dmat4& matrix : matrices)
        matrix[0] = dvec4(0.0);
    const HostInstants made = compute();
    const auto& found = made.layers.raster.motions.at(made.layers.raster.movers.at(1) * kInstants);
    EXPECT_EQ(found.instantFromRaster[2], vec4(0.0f));
}

TEST_F(HostInstantsTest, AnotherSizeOrProjectionHasNoLastRaster) {
    const HostRaster last = compute().raster;
    EXPECT_TRUE(compute(&last).layers.last.has_value());
    frame.sizePx.y = 101;
    EXPECT_FALSE(compute(&last).layers.last.has_value());
    frame.sizePx.y = 100;
    isPerspective = false;
    setKeys({0.0, 0.5, 1.0});
    EXPECT_FALSE(compute(&last).layers.last.has_value());
}

TEST_F(HostInstantsTest, TheLastRasterIsNotUsedWithoutBothTransforms) {
    addTumbler();
    const HostRaster listed = compute().raster;
    motion.movers = {};
    const HostRaster unlisted = compute().raster;
    EXPECT_EQ(compute(&listed).layers.last->movers.at(1), shader::kNoMover);
    EXPECT_EQ(compute(&unlisted).layers.last->movers.at(1), shader::kWorldMover);
    addTumbler();
    EXPECT_EQ(compute(&unlisted).layers.last->movers.at(1), shader::kNoMover);
    movers[0].worldFromObject = {};
    EXPECT_EQ(compute(&listed).layers.last->movers.at(1), shader::kNoMover);
    const HostRaster deforming = compute().raster;
    addTumbler();
    EXPECT_EQ(compute(&deforming).layers.last->movers.at(1), shader::kNoMover);
}

TEST_F(HostInstantsTest, RowsThatMoveAreFoundByTheirId) {
    const std::vector<uint64_t> idsThen{10, 11, 12, 13};
    motion.rowIds = idsThen;
    addTumbler();
    const HostRaster last = compute().raster;
    nextFrame();
    const std::vector<uint64_t> idsNow{12, 13, 11, 99};
    motion.rowIds = idsNow;
    addTumbler(2);
    const HostInstants made = compute(&last);
    ASSERT_TRUE(made.layers.last.has_value());
    expectMaps(*made.layers.last, 1, project(cornerAt(1.0), 1.0), cornerAt);
    const dvec4 still(0.5, 0.5, -9.0, 1.0);
    expectMaps(*made.layers.last, 2, project(still, 1.0), [&](double) { return still; });
    EXPECT_EQ(made.layers.last->movers.at(0), shader::kNoMover) << "10 is gone";
    EXPECT_EQ(made.layers.last->movers.at(2), shader::kWorldMover);
}

TEST_F(HostInstantsTest, AnIdThatOccursTwiceFindsNothing) {
    const std::vector<uint64_t> once{10, 11, 12, 13};
    const std::vector<uint64_t> twice{10, 11, 10, 13};
    motion.rowIds = once;
    const HostRaster last = compute().raster;
    motion.rowIds = twice;
    const HostRaster ambiguous = compute().raster;
    EXPECT_EQ(compute(&last).layers.last->movers.at(0), shader::kNoMover);
    motion.rowIds = once;
    const LayerTables found = *compute(&ambiguous).layers.last;
    EXPECT_EQ(found.movers.at(0), shader::kNoMover);
    EXPECT_EQ(found.movers.at(2), shader::kNoMover);
    EXPECT_EQ(found.movers.at(3), shader::kWorldMover);
}

TEST_F(HostInstantsTest, FewerRowsThanBeforeLeaveTheOthersOut) {
    const HostRaster last = compute().raster;
    motion.rowCount = 2;
    const LayerTables found = *compute(&last).layers.last;
    EXPECT_EQ(found.movers.at(1), shader::kWorldMover);
    EXPECT_EQ(found.movers.at(2), shader::kNoMover);
    EXPECT_EQ(found.movers.at(kRows), shader::kSkyMover);
    EXPECT_EQ(found.rasterRows.at(1), 1u);
    EXPECT_EQ(found.rasterRows.at(2), shader::kNoRasterRow);
}

class HostMotionCheck : public HostMotionFixture {
  protected:
    void SetUp() override { reset(); }

    void reset() {
        motion = {};
        frame.hasResponse = false;
        setKeys({0.0, 0.5, 1.0});
        addTumbler();
        response = {};
        response.knotCount = 2;
        response.knots[1] = {1.0f, 2.0f, 1.0f, 0.0f};
    }

    /// Refused after the change, by one sentence with `part`; accepted without it.
    void refuse(const std::string& part, const std::function<void()>& change) {
        reset();
        ASSERT_TRUE(check().ok()) << check().error().message;
        change();
        const core::Status status = check();
        ASSERT_FALSE(status.ok()) << "expected: " << part;
        const std::string& message = status.error().message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }

    /// The same after another change, which is valid.
    template <class Before> auto refuseAfter(const Before& before) {
        return [this, before](const std::string& part, const std::function<void()>& change) {
            refuse(part, [&] {
                before();
                ASSERT_TRUE(check().ok()) << check().error().message;
                change();
            });
        };
    }

    /// An array that is declared to have a size, and that is not there.
    template <class T> static std::span<const T> missing(size_t size) {
        return {static_cast<const T*>(nullptr), size};
    }

    shader::ResponseTable response{};
};

TEST_F(HostMotionCheck, EachBadKeyIsNamed) {
    refuse("keys holds 0, it needs 1 to 64", [&] { motion.keys = {}; });
    refuse("keys holds 65", [&] { setKeys(std::vector<double>(65, 0.5)); });
    refuse("keys is null, its size is 3", [&] { motion.keys = missing<HostCameraKey>(3); });
    refuse("keys[1].time is nan", [&] { keys[1].time = kNoNumber; });
    refuse("keys[2].time is 2000000, it must be -1000000 to", [&] { keys[2].time = 2.0e6; });
    refuse("keys[0].time is -2000000", [&] { keys[0].time = -2.0e6; });
    refuse("keys[0].time is -inf", [&] { keys[0].time = -HUGE_VAL; });
    refuse("keys[1].time is 0, not after", [&] { keys[1].time = 0.0; });
    refuse("keys has no key at rasterTime, which is 1", [&] { keys[2].time = 0.9; });
    refuse("keys[1].viewFromWorld is not finite", [&] { keys[1].viewFromWorld[2][1] = kNoNumber; });
    refuse("keys[0].viewFromWorld is singular", [&] { keys[0].viewFromWorld[2] = dvec4(0.0); });
    refuse("keys[0].viewFromWorld is not affine", [&] { keys[0].viewFromWorld[1].w = 1.0; });
    refuse("keys[0].viewFromWorld is not affine", [&] { keys[0].viewFromWorld = dmat4(0.0); });
    const std::string name = "keys[1].clipFromView ";
    refuse(name + "is not finite", [&] { keys[1].clipFromView[0][0] = kNoNumber; });
    refuse(name + "is singular", [&] { keys[1].clipFromView[0][0] = 0.0; });
    refuse(name + "is neither perspective nor ortho", [&] { keys[1].clipFromView = dmat4(0.0); });
    refuse(name + "is neither perspective nor ortho", [&] { keys[1].clipFromView[0].w = 0.5; });
    refuse(name + "is neither perspective nor ortho", [&] { keys[1].clipFromView[3].w = 1.0; });
    refuse(name + "is orthographic, keys[0].clipFromView is not", [&] {
        keys[1].clipFromView = math::clipFromViewOrthographic(1.0, 1.0, 0.1, 9.0);
    });
    refuse(name + "faces +Z", [&] { keys[1].clipFromView[2] *= -1.0; });
    refuse("keys[0].clipFromView faces -Z", [&] { motion.aheadIsPlusZ = true; });
}

TEST_F(HostMotionCheck, EachBadMoverAndIdIsNamed) {
    refuse("rowCount is 0, it must be 1 to 16777215", [&] { motion.rowCount = 0; });
    refuse("rowCount is 16777216", [&] { motion.rowCount = 1u << 24u; });
    refuse("movers[0].row is 4, rowCount 4", [&] { movers[0].row = kRows; });
    refuse("movers[1].row is 1, as another mover's is", [&] {
        movers.push_back(movers[0]);
        motion.movers = movers;
    });
    const std::vector<uint32_t> one{1};
    refuse("viewModelRows[0] is 1, as a mover's row is", [&] { motion.viewModelRows = one; });
    const std::vector<uint32_t> beyond{0, kRows};
    refuse("viewModelRows[1] is 4, rowCount 4", [&] { motion.viewModelRows = beyond; });
    refuse("viewModelRows is null, its size is 1", [&] {
        motion.viewModelRows = missing<uint32_t>(1);
    });
    refuse("movers is null, its size is 1", [&] { motion.movers = missing<HostMover>(1); });
    refuse("movers[0].worldFromObject holds 2, keys 3", [&] {
        movers[0].worldFromObject = movers[0].worldFromObject.first(2);
    });
    refuse("movers[0].worldFromObject is null", [&] {
        movers[0].worldFromObject = missing<dmat4>(3);
    });
    refuse("movers[0].worldFromObject[2] is not finite", [&] { matrices[2][3][0] = kNoNumber; });
    refuse("movers[0].worldFromObject[1] is not affine", [&] { matrices[1][1].w = 0.5; });
    const std::vector<uint64_t> ids(3);
    refuse("rowIds holds 3, rowCount is 4", [&] { motion.rowIds = ids; });
    refuse("rowIds is null", [&] { motion.rowIds = missing<uint64_t>(kRows); });
}

TEST_F(HostMotionCheck, EachBadLensIsNamed) {
    HostLens& lens = motion.lens;
    const auto refuseLens = refuseAfter([&] { lens = {.radius = 0.01}; });
    refuseLens("lens.radius is -0.01, it must be 0 to 1000", [&] { lens.radius = -0.01; });
    refuseLens("lens.radius is nan", [&] { lens.radius = kNoNumber; });
    refuseLens("lens.radius is inf", [&] { lens.radius = HUGE_VAL; });
    refuseLens("lens.focusDistance is 0, it must be 0.0001 to", [&] { lens.focusDistance = 0.0; });
    refuseLens("lens.focusDistance is nan", [&] { lens.focusDistance = kNoNumber; });
    refuseLens("lens.focusDistance is 2000000000", [&] { lens.focusDistance = 2e9; });
    refuseLens("lens.blades is 2, it must be 0 or 3 to 16", [&] { lens.blades = 2; });
    refuseLens("lens.blades is 17", [&] { lens.blades = 17; });
    refuseLens("lens.bladeRotation is 7", [&] { lens.bladeRotation = 7.0; });
    refuseLens("lens.bladeRotation is nan", [&] { lens.bladeRotation = kNoNumber; });
    refuseLens("lens.roundness is 1.1, it must be 0 to 1", [&] { lens.roundness = 1.1; });
    refuseLens("lens.squeeze is 0, it must be above 0, to 4", [&] { lens.squeeze = 0.0; });
    refuseLens("lens.squeeze is nan", [&] { lens.squeeze = kNoNumber; });
    std::vector<double> distances(keys.size(), 2.0);
    distances[1] = kNoNumber;
    refuseLens("lens.focusDistances[1] is nan", [&] { lens.focusDistances = distances; });
    refuseLens("lens.focusDistances holds 1, keys 3", [&] {
        lens.focusDistances = std::span<const double>(distances).first(1);
    });
    refuseLens("lens.focusDistances is null, its size is 3", [&] {
        lens.focusDistances = missing<double>(3);
    });
    isPerspective = false;
    refuse(
        "motion blur: lens.radius is 0.01, but keys[0].clipFromView is orthographic; it must be 0",
        [&] { lens.radius = 0.01; }
    );
}

TEST_F(HostMotionCheck, ABadResponseIsNamed) {
    refuse("motion.response is null, response is not 0", [&] { frame.hasResponse = true; });
    refuse("motion.response is given, response is 0", [&] { motion.response = &response; });
    const auto refuseTable = refuseAfter([&] {
        motion.response = &response;
        frame.hasResponse = true;
    });
    refuseTable("motion.response->knotCount is 1", [&] { response.knotCount = 1; });
    refuseTable("motion.response->knotCount is 65", [&] { response.knotCount = 65; });
    refuseTable("motion.response->knots[0]", [&] { response.knots[0].s = 0.5f; });
    refuseTable("motion.response->knots[1]", [&] { response.knots[1].s = 0.5f; });
    refuseTable("motion.response->knots[1]", [&] { response.knots[1].density = float(kNoNumber); });
    refuseTable("motion.response->knots[1]", [&] { response.knots[1].cumulative = 2.0f; });
    refuseTable("motion.response->firstKnots[0] is 1", [&] { response.firstKnots[0] = 1; });
    refuseTable("motion.response->firstKnots[9] is 64", [&] { response.firstKnots[9] = 64; });
}

} // namespace
} // namespace shutter::motion_blur
