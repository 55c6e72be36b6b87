// SPDX-License-Identifier: MIT
// The panels that show a host's inputs: which there are, where they lie and what they show.
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_overlay.h"
#include "shaders/motion_blur/overlay.glsl"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace shutter::motion_blur {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;
using shader::bitsOfLetter;
using shader::kPanelCount;

constexpr glm::uvec2 kSize{200, 100};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

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
    // Nobody says what share of a frame motionDepth is over.
    inputs.motionDepth.image = reinterpret_cast<VkImage>(uintptr_t{1});
    EXPECT_TRUE(has(shader::kPanelCamera));
    EXPECT_FALSE(has(shader::kPanelObjects));
}

TEST(HostOverlay, WhatStandsStillHasNoMotionOfItsOwn) {
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

TEST(HostOverlay, CellsStandStillInTheWorldAndAreAMetreWide) {
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

TEST(HostOverlay, WhatIsNoNumberIsMagenta) {
    EXPECT_EQ(shader::colorOfMotion({kNaN, 0.0f}), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfMotion({0.0f, -1.0f / 0.0f}), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfDepth(kNaN), shader::kPanelBroken);
    EXPECT_EQ(shader::colorOfNormal({0.0f, kNaN, 1.0f}), shader::kPanelBroken);
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
