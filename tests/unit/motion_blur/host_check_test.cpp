// SPDX-License-Identifier: MIT
// The checker on frames made in main memory, and the panels that show a host's inputs.
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/check/checked_frame.h"
#include "modules/motion_blur/embedding/host_overlay.h"
#include "shaders/motion_blur/check_grid.glsl"
#include "shaders/motion_blur/overlay.glsl"
#include "shaders/render/scene_shared.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace shutter::motion_blur {
namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;
using shader::bitsOfLetter;
using shader::kPanelCount;

constexpr VkExtent2D kCheckedPicture{320, 180};
constexpr double kShare = 0.4; ///< exposure over the time between the frames
constexpr double kCheckedNear = 0.1;
constexpr uint32_t kWallRow = 0;
constexpr uint32_t kMoverRow = 1;

/// A floor and a wall, before which a square moves, under a camera that moves; all by functions of
/// the time in frames.
class CheckedWorld {
  public:
    virtual ~CheckedWorld() = default;

    [[nodiscard]] virtual dvec3 cameraAt(double frames) const { return {0.25 * frames, 0.0, 0.0}; }

    [[nodiscard]] virtual dvec3 moverAt(double frames) const {
        return {0.5 * frames - 1.0, 0.0, -5.0};
    }

    [[nodiscard]] dmat4 viewAt(double frames) const {
        return glm::translate(dmat4(1.0), -cameraAt(frames));
    }

    [[nodiscard]] dmat4 placeAt(double frames) const {
        return glm::translate(dmat4(1.0), moverAt(frames));
    }

    [[nodiscard]] static dmat4 projection() {
        return math::clipFromViewPerspective(
            0.8, double(kCheckedPicture.width) / kCheckedPicture.height, kCheckedNear
        );
    }

    /// The recording of a frame: two keys in the exposure, a mover with matrices, vectors.
    [[nodiscard]] std::unique_ptr<CheckedFrame> draw(double frames) const {
        auto frame = std::make_unique<CheckedFrame>();
        CheckFacts& facts = frame->facts;
        facts.picture = kCheckedPicture;
        facts.convention.scales.exposureShare = float(kShare);
        facts.convention.cameras = {
            true, viewAt(frames), projection(), viewAt(frames - 1.0), projection()};
        facts.hasIds = facts.readsMotion = facts.wantsHistory = facts.followsLast = true;
        facts.rowCount = 2;
        for (const double time : {0.0, 1.0}) {
            const double at = frames - (1.0 - time) * kShare;
            facts.keys.push_back({time, viewAt(at), projection()});
            facts.matrices.push_back(placeAt(at));
        }
        facts.rasterKey = 1;
        CheckFacts::Mover mover;
        mover.row = kMoverRow;
        mover.firstMatrix = 0;
        facts.movers.push_back(mover);
        fill(*frame, frames);
        return frame;
    }

  private:
    struct Hit {
        uint32_t row = kWallRow;
        double metres = 0.0;
        dvec2 motion{0.0};
    };

    [[nodiscard]] static dvec2 see(const dmat4& view, const dvec3& world) {
        const dvec4 clip = projection() * view * dvec4(world, 1.0);
        return (dvec2(clip) / clip.w * 0.5 + 0.5) *
               dvec2(kCheckedPicture.width, kCheckedPicture.height);
    }

    [[nodiscard]] Hit trace(const dvec2& place, double frames) const {
        const dvec2 ndc = place / dvec2(kCheckedPicture.width, kCheckedPicture.height) * 2.0 - 1.0;
        const dmat4 clip = projection();
        const dvec3 ray(ndc.x / clip[0].x, ndc.y / clip[1].y, -1.0);
        const dvec3 eye = cameraAt(frames);
        Hit hit;
        hit.metres = 20.0 + eye.z; // the wall
        if (ray.y < 0.0)           // the floor
            hit.metres = std::min(hit.metres, (-2.0 - eye.y) / ray.y);
        const double toMover = eye.z - moverAt(frames).z;
        const dvec3 onMover = eye + ray * toMover - moverAt(frames);
        if (std::abs(onMover.x) < 0.8 && std::abs(onMover.y) < 0.8 && toMover < hit.metres) {
            hit.row = kMoverRow;
            hit.metres = toMover;
        }
        const dvec3 world = eye + ray * hit.metres;
        const dvec3 then =
            hit.row == kMoverRow ? world - moverAt(frames) + moverAt(frames - 1.0) : world;
        hit.motion = place - see(viewAt(frames - 1.0), then);
        return hit;
    }

    void fill(CheckedFrame& frame, double frames) const {
        const glm::uvec2 size(kCheckedPicture.width, kCheckedPicture.height);
        shader::CheckTotals& totals = frame.totals;
        totals.depthLeast = std::bit_cast<uint32_t>(1.0e-3f);
        totals.depthMost = std::bit_cast<uint32_t>(1.0f);
        for (uint32_t i = 0; i < shader::kCheckSamples; ++i) {
            const glm::uvec2 cell(i % shader::kCheckAcross, i / shader::kCheckAcross);
            const Hit hit = trace(dvec2(shader::checkedPixel(cell, size)) + 0.5, frames);
            totals.samples[i] = {glm::vec2(hit.motion), float(kCheckedNear / hit.metres), hit.row};
            totals.seenRows[0] |= 1u << hit.row;
        }
        const glm::uvec2 fine = shader::fineGrid(size);
        for (uint32_t i = 0; i < fine.x * fine.y; ++i) {
            const glm::uvec2 pixel = shader::finePixel({i % fine.x, i / fine.x}, size);
            const Hit hit = trace(dvec2(pixel) + 0.5, frames);
            totals.fineDepths[i] = float(kCheckedNear / hit.metres);
            totals.fineIds[i] = hit.row;
        }
    }
};

using Change = void (*)(CheckFacts&, const CheckedWorld&, double frames);

/// All sentences for three frames.
std::string check(const CheckedWorld& world, Change change = nullptr) {
    std::string all;
    std::unique_ptr<CheckedFrame> last;
    for (int frame = 0; frame < 3; ++frame) {
        auto now = world.draw(frame);
        if (change)
            change(now->facts, world, frame);
        for (const Finding& finding : checkFrame(*now, last.get()))
            all += finding.sentence + "\n";
        last = std::move(now);
    }
    return all;
}

void leaveVectorsOut(CheckFacts& facts, const CheckedWorld&, double) {
    facts.hasVectors = false;
}

/// All moves by the square of the time, from rest in the first frame.
struct Starting : CheckedWorld {
    static double squareOf(double frames) { return frames < 0.0 ? 0.0 : frames * frames; }

    [[nodiscard]] dvec3 cameraAt(double frames) const override {
        return {0.3 * squareOf(frames), 0.0, 0.0};
    }

    [[nodiscard]] dvec3 moverAt(double frames) const override {
        return {0.4 * squareOf(frames) - 1.0, 0.0, -5.0};
    }
};

/// All stops in the last frame, just before its shutter opens.
struct Stopping : CheckedWorld {
    [[nodiscard]] dvec3 cameraAt(double frames) const override {
        return CheckedWorld::cameraAt(std::min(frames, 1.59));
    }

    [[nodiscard]] dvec3 moverAt(double frames) const override {
        return CheckedWorld::moverAt(std::min(frames, 1.59));
    }
};

/// Turns back in each frame.
struct Shaking : CheckedWorld {
    [[nodiscard]] dvec3 cameraAt(double frames) const override {
        return {0.3 * std::sin(2.2 * frames), 0.0, 0.0};
    }
};

TEST(HostCheck, ValidWorldsAreNotReported) {
    for (const Change change : {Change(nullptr), Change(leaveVectorsOut)}) {
        EXPECT_EQ(check(CheckedWorld(), change), "");
        EXPECT_EQ(check(Starting(), change), "");
        EXPECT_EQ(check(Stopping(), change), "");
    }
    EXPECT_EQ(check(Shaking()), "");
}

/// Sentences for a deforming mover whose displacements are changed.
std::string checkDeformedBy(math::vec4 (*change)(const math::vec4&)) {
    std::string all;
    auto frame = CheckedWorld().draw(1.0);
    frame->facts.hasDeformed = true;
    frame->facts.movers[0].firstMatrix = CheckFacts::kNone;
    for (shader::CheckSample& sample : frame->totals.samples)
        sample.deformed = sample.id == kMoverRow
                              ? change(math::vec4(-float(kShare) * sample.vector, 0.0f, 0.0f))
                              : math::vec4(std::numeric_limits<float>::quiet_NaN());
    for (const Finding& finding : checkFrame(*frame, nullptr))
        if (finding.kind == CheckKind::Deformed)
            all += finding.sentence;
    return all;
}

TEST(HostCheck, DeformedMotionMustAgreeWithVectors) {
    const auto contains = [](const std::string& reported, const char* part) {
        return reported.find(part) != std::string::npos;
    };
    EXPECT_EQ(checkDeformedBy([](const math::vec4& v) { return v; }), "");
    EXPECT_TRUE(contains(checkDeformedBy([](const math::vec4& v) { return -v; }), "exchanged"));
    EXPECT_TRUE(contains(
        checkDeformedBy([](const math::vec4& v) { return v / math::vec4(320, 180, 320, 180); }),
        "shares of the picture"
    ));
    EXPECT_TRUE(contains(
        checkDeformedBy([](const math::vec4& v) { return v / math::vec4(160, 90, 160, 90); }),
        "clip space"
    ));
    EXPECT_TRUE(contains(
        checkDeformedBy([](const math::vec4& v) { return v / float(kShare); }), "between the frames"
    ));
    const std::string other =
        checkDeformedBy([](const math::vec4& v) { return v + math::vec4(90, 70, 0, 0); });
    EXPECT_TRUE(contains(other, "deformedMotion")) << other;
    EXPECT_FALSE(contains(other, "would be")) << other;
}

TEST(HostCheck, AMoverBehindAWallIsNotCountedAsVisible) {
    const Change behind = [](CheckFacts& facts, const CheckedWorld&, double) {
        facts.rowCount = 3; // the picture does not show the last of them
        facts.movers.front() = {2, true, {160.0, 40.0}, 40.0, CheckFacts::kNone};
    };
    EXPECT_EQ(check(CheckedWorld(), behind).find("shows none of"), std::string::npos);
    const Change before = [](CheckFacts& facts, const CheckedWorld&, double) {
        facts.rowCount = 3;
        facts.movers.front() = {2, true, {160.0, 40.0}, 20.5, CheckFacts::kNone};
    };
    EXPECT_NE(check(CheckedWorld(), before).find("shows none of"), std::string::npos);
}

TEST(HostCheck, OnePixelHasOneDepthAndSharesAreRoundedAsPeopleWriteThem) {
    CheckedFrame frame;
    frame.facts.picture = {1, 1};
    frame.totals.depthLeast = frame.totals.depthMost = std::bit_cast<uint32_t>(0.5f);
    std::vector<Finding> findings;
    checkTotals(frame, findings);
    EXPECT_FALSE(hasFound(findings, {CheckKind::DepthEqual}));
    frame.facts.picture = {64, 64};
    checkTotals(frame, findings);
    EXPECT_TRUE(hasFound(findings, {CheckKind::DepthEqual}));
    EXPECT_EQ(describeShare(1.0), "100 %");
    EXPECT_EQ(describeShare(0.999), "100 %");
    EXPECT_EQ(describeShare(0.4512), "45 %");
    EXPECT_EQ(describeShare(0.0996), "10 %");
    EXPECT_EQ(describeShare(0.0321), "3.2 %");
    EXPECT_EQ(describeShare(0.00012), "0.012 %");
    EXPECT_EQ(describeShare(0.0), "0 %");
}

constexpr glm::uvec2 kSize{200, 100};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

HostInputs makeInputs(const dmat4& view, const dmat4& viewBefore) {
    HostInputs inputs;
    inputs.width = kSize.x;
    inputs.height = kSize.y;
    HostCameras& cameras = inputs.convention.cameras;
    cameras.areGiven = true;
    cameras.viewFromWorld = view;
    cameras.viewFromWorldBefore = viewBefore;
    cameras.clipFromView = cameras.clipFromViewBefore =
        math::clipFromViewPerspective(0.9, 2.0, 0.1);
    inputs.convention.scales.exposureShare = 0.5f;
    return inputs;
}

/// Near at 0, infinity at 1.
dmat4 forwardDepth(dmat4 clipFromView) {
    clipFromView[2].z = -1.0;
    clipFromView[3].z = -clipFromView[3].z;
    return clipFromView;
}

/// Where a point in front of the camera is seen, pixels, and how far it is.
glm::vec3 see(const HostInputs& inputs, const dmat4& view, const dvec3& point) {
    const dvec4 inView = view * dvec4(point, 1.0);
    const dvec4 clip = inputs.convention.cameras.clipFromView * inView;
    const dvec3 ndc = dvec3(clip) / clip.w;
    return {(ndc.x + 1.0) * 0.5 * kSize.x, (ndc.y + 1.0) * 0.5 * kSize.y, -inView.z};
}

TEST(HostOverlay, PanelsLieAlongTheTopAndTheBottomWhateverTheSize) {
    for (const glm::uvec2 size :
         {glm::uvec2(200, 100), {41, 39}, {7, 5}, {4, 4}, {1, 1}, {1, 50}}) {
        std::set<uint32_t> seen;
        for (uint32_t y = 0; y < size.y; ++y)
            for (uint32_t x = 0; x < size.x; ++x) {
                const uint32_t panel = shader::panelAt({x, y}, size);
                ASSERT_LE(panel, kPanelCount);
                seen.insert(panel);
                if (panel == kPanelCount)
                    continue;
                EXPECT_EQ(panel < 4, 4 * y < size.y);
                const glm::uvec2 origin = shader::panelOrigin(panel, size);
                ASSERT_TRUE(origin.x <= x && origin.y <= y) << panel << " at " << x << ", " << y;
                const glm::uvec2 shown = shader::pixelInPanel(panel, {x, y}, size);
                EXPECT_TRUE(shown.x < size.x && shown.y < size.y);
            }
        if (size.x >= 4 && size.y >= 4) {
            EXPECT_EQ(seen.size(), kPanelCount + 1) << size.x << " x " << size.y;
        }
    }
}

TEST(HostOverlay, APanelIsLeftOutWhereItsInputIsNotThere) {
    HostInputs inputs;
    inputs.width = kSize.x;
    inputs.height = kSize.y;
    MotionBlurInputs own;
    const auto has = [&](uint32_t panel) {
        return (makeOverlayTable(inputs, own).panels >> panel & 1u) != 0;
    };
    EXPECT_TRUE(has(shader::kPanelMotion) && has(shader::kPanelDepth));
    for (const uint32_t panel :
         {shader::kPanelCamera,
          shader::kPanelObjects,
          shader::kPanelWorld,
          shader::kPanelIds,
          shader::kPanelNormal,
          shader::kPanelJitter})
        EXPECT_FALSE(has(panel)) << panel;
    inputs.convention.cameras = makeInputs(dmat4(1.0), dmat4(1.0)).convention.cameras;
    EXPECT_TRUE(has(shader::kPanelCamera) && has(shader::kPanelObjects));
    EXPECT_TRUE(has(shader::kPanelWorld) && has(shader::kPanelJitter));
    // The exposure of motionDepth is unknown.
    inputs.motionDepth.image = reinterpret_cast<VkImage>(uintptr_t{1});
    EXPECT_TRUE(has(shader::kPanelCamera));
    EXPECT_FALSE(has(shader::kPanelObjects));
}

TEST(HostOverlay, StaticSurfacesHaveNoObjectMotion) {
    const dmat4 view = glm::rotate(dmat4(1.0), 0.02, dvec3(0.0, 1.0, 0.0));
    const dmat4 before = glm::translate(dmat4(1.0), dvec3(0.1, 0.0, 0.05));
    const HostInputs inputs = makeInputs(view, before);
    const shader::OverlayTable table = makeOverlayTable(inputs, {});
    for (const dvec3& point : {dvec3(0.2, 0.1, -3.0), {-1.0, 0.4, -5.0}, {2.0, -0.5, -9.0}}) {
        const glm::vec3 now = see(inputs, view, point);
        const glm::vec3 then = see(inputs, before, point);
        const glm::vec2 motion = 0.5f * (glm::vec2(now) - glm::vec2(then));
        ASSERT_GT(glm::length(motion), 0.5f);
        const auto show = [&](uint32_t panel, const glm::vec2& moved) {
            return shader::colorOfPanel(table, panel, glm::vec2(now), moved, now.z);
        };
        EXPECT_LT(glm::length(show(shader::kPanelObjects, motion)), 0.02f);
        EXPECT_LT(
            glm::distance(show(shader::kPanelCamera, motion), show(shader::kPanelMotion, motion)),
            0.02f
        );
        // A wrong sign is seen everywhere.
        EXPECT_GT(glm::length(show(shader::kPanelObjects, -motion)), 0.2f);
        EXPECT_GT(
            glm::distance(show(shader::kPanelCamera, -motion), show(shader::kPanelMotion, -motion)),
            0.1f
        );
    }
}

TEST(HostOverlay, CellsAreStaticInTheWorldAndAMetreWide) {
    // Far from the origin, where floats are coarse.
    const dvec3 away(1.0e6, -3.0e5, 2.0e6);
    const dmat4 first = glm::translate(dmat4(1.0), -away);
    const dmat4 second = glm::rotate(dmat4(1.0), 0.1, dvec3(0.0, 1.0, 0.0)) *
                         glm::translate(dmat4(1.0), -away - dvec3(1.3, 0.2, 0.7));
    const auto show = [](const dmat4& view, const dvec3& point) {
        const HostInputs inputs = makeInputs(view, view);
        const glm::vec3 seen = see(inputs, view, point);
        return shader::colorOfWorld(makeOverlayTable(inputs, {}), glm::vec2(seen), seen.z);
    };
    const dvec3 point = away + dvec3(0.5, 0.5, -4.5);
    EXPECT_EQ(show(first, point), show(second, point));
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 step(0.0);
        step[axis] = 1.0;
        const glm::vec3 next = show(first, point + step);
        for (int other = 0; other < 3; ++other)
            EXPECT_EQ(next[other] == show(first, point)[other], other != axis);
        EXPECT_EQ(show(first, point + 2.0 * step), show(first, point));
        EXPECT_EQ(show(first, point + 0.4 * step), show(first, point));
    }
    const HostInputs inputs = makeInputs(first, first);
    EXPECT_EQ(
        shader::colorOfWorld(makeOverlayTable(inputs, {}), {1.0f, 1.0f}, shader::kSkyDepth),
        glm::vec3(0.0f)
    );
}

TEST(HostOverlay, CellsHaveASizeThatTheNearPlaneShowsWhereAnotherUnitIsUsed) {
    // A unit of 2.5 cm: the near plane is at 4, a cell 100 wide.
    HostInputs inputs = makeInputs(dmat4(1.0), dmat4(1.0));
    const auto show = [&](double x) {
        return shader::colorOfWorld(
            makeOverlayTable(inputs, {}),
            glm::vec2(see(inputs, dmat4(1.0), {x, 10.0, -250.0})),
            250.0f
        );
    };
    for (const bool isReversed : {true, false}) {
        inputs.convention.cameras.clipFromView =
            isReversed ? math::clipFromViewPerspective(0.9, 2.0, 4.0)
                       : forwardDepth(math::clipFromViewPerspective(0.9, 2.0, 4.0));
        inputs.convention.depth.skyValue = isReversed ? 0.0f : 1.0f;
        EXPECT_EQ(show(20.0), show(80.0));
        EXPECT_NE(show(20.0), show(120.0));
    }
}

TEST(HostOverlay, NonFiniteValuesAreMagenta) {
    EXPECT_EQ(shader::colorOfMotion({kNan, 0.0f}), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfMotion({0.0f, -1.0f / 0.0f}), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfDepth(kNan), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfNormal({0.0f, kNan, 1.0f}), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfMotion({0.0f, 0.0f}), glm::vec3(0.0f));
}

TEST(HostOverlay, TheJittersDotLiesWhereSamplesDo) {
    const glm::vec2 panelPx(50.0f, 25.0f);
    const auto show = [&](const glm::vec2& jitterPx, const glm::vec2& offset) {
        return shader::colorOfJitter(jitterPx, (offset + 1.0f) * 0.5f, panelPx);
    };
    const glm::vec2 jitter(0.25f, -0.4f);
    const glm::vec3 dot = show(jitter, jitter);
    EXPECT_GT(dot.y, 2.0f * dot.x) << "green";
    EXPECT_LT(show(jitter, {0.25f, 0.3f}).y, 0.1f);
    const glm::vec3 far = show({3.0f, 0.0f}, {1.0f, 0.0f});
    EXPECT_GT(far.x, 2.0f * far.y) << "red at the border: more than half a pixel";
}

TEST(HostOverlay, EachPanelHasItsName) {
    std::set<std::string> names;
    for (uint32_t panel = 0; panel < kPanelCount; ++panel) {
        std::string name;
        for (uint32_t i = 0; i < shader::kLabelLetters; ++i) {
            const uint32_t word = i < 4 ? shader::labelBegins(panel) : shader::labelEnds(panel);
            const uint32_t letter = word >> (24 - 8 * (i % 4)) & 0xFFu;
            if (letter == 0)
                continue;
            name += char(letter);
            EXPECT_NE(bitsOfLetter(letter), 0u) << char(letter);
        }
        names.insert(name);
    }
    EXPECT_EQ(
        names,
        (std::set<std::string>{
            "MOTION", "CAMERA", "OBJECTS", "DEPTH", "WORLD", "IDS", "NORMAL", "JITTER"})
    );
    // D: a straight left side and a round right one.
    EXPECT_EQ(bitsOfLetter('D'), 0b110'101'101'101'110u);
    EXPECT_FALSE(shader::isInLabel(0, {0, 0}, kSize));
    EXPECT_TRUE(shader::isInLabel(0, {1, 1}, kSize)) << "M begins";
    EXPECT_FALSE(shader::isInLabel(0, {4, 3}, kSize)) << "between two letters";
}

} // namespace
} // namespace shutter::motion_blur
