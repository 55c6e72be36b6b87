// SPDX-License-Identifier: MIT
// HostInputs::showsInputs: panels cover a part of the picture, and of nothing else.
#include "engine/gpu/frame.h"
#include "engine/math/transform.h"
#include "shaders/motion_blur/overlay.glsl"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/host_texels.h"
#include "tests/support/picture.h"

#include <deque>
#include <set>
#include <string>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostInputs;
using test::HostTexels;

constexpr uint32_t kWidth = 80;
constexpr uint32_t kHeight = 48;
constexpr VkExtent2D kExtent{kWidth, kHeight};
constexpr uint32_t kPixels = kWidth * kHeight;
constexpr uint32_t kNoEntity = 0xFFFF;

class EmbeddedOverlay : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure())
            mBlur = create(describeHost());
    }

    void TearDown() override {
        mTexels.clear();
        mBlur.reset();
        EmbeddedTest::TearDown();
    }

    template <class T> motion_blur::HostImage make(VkFormat format, const std::vector<T>& values) {
        return mTexels.emplace_back(device(), format, kExtent, test::bytesOf(values)).describe();
    }

    /// The left half moves by itself; the camera stands still.
    HostInputs describe() {
        mTexels.clear();
        std::vector<glm::vec2> vectors;
        std::vector<uint16_t> ids;
        for (uint32_t i = 0; i < kPixels; ++i) {
            const bool isLeft = i % kWidth < kWidth / 2;
            vectors.push_back({isLeft ? 12.0f : 0.0f, 0.0f});
            ids.push_back(isLeft ? uint16_t(3) : uint16_t(kNoEntity));
        }
        HostInputs inputs;
        inputs.width = kWidth;
        inputs.height = kHeight;
        inputs.color = make(
            VK_FORMAT_R16G16B16A16_SFLOAT,
            std::vector<uint64_t>(kPixels, test::packHalf({0.25f, 0.5f, 0.75f, 1.0f}))
        );
        auto& convention = inputs.convention;
        convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, vectors);
        convention.depth.image = make(VK_FORMAT_R32_SFLOAT, std::vector<float>(kPixels, 5.0f));
        convention.depth.isLinear = true;
        convention.depth.skyValue = 1.0e9f;
        convention.scales.exposureShare = 1.0f;
        inputs.entityId = make(VK_FORMAT_R16_UINT, ids);
        inputs.noEntity = kNoEntity;
        inputs.observe = [this](graph::Graph& graph, const auto&, const auto&) {
            mPasses.clear();
            for (const graph::PassRecord& pass : graph.passes())
                mPasses.insert(pass.name);
        };
        return inputs;
    }

    void giveCameras(HostInputs& inputs) {
        auto& cameras = inputs.convention.cameras;
        cameras.areGiven = true;
        cameras.clipFromView = cameras.clipFromViewBefore =
            math::clipFromViewPerspective(1.0, double(kWidth) / kHeight, 0.1);
    }

    image::Image draw(HostInputs inputs) {
        const test::Picture output(device(), "output", {kWidth, kHeight});
        inputs.output = {output.handle(), test::kNothing, test::kCopied};
        gpu::Frame frame(device());
        frame.begin();
        for (const HostTexels& texels : mTexels)
            texels.record(frame.commands());
        const core::Status done = mBlur->record(frame.commands(), 0, inputs, test::gather());
        EXPECT_TRUE(done.ok()) << done.error().message;
        output.recordReadback(frame.commands());
        frame.submit();
        frame.wait();
        return output.read();
    }

    /// Which panels differ from a picture without any; kPanelCount: what no panel covers.
    static std::set<uint32_t> findChanged(const image::Image& with, const image::Image& without) {
        std::set<uint32_t> changed;
        for (uint32_t i = 0; i < kPixels; ++i)
            for (uint32_t channel = 0; channel < with.channels; ++channel)
                if (with.pixels[i * with.channels + channel] !=
                    without.pixels[i * with.channels + channel])
                    changed.insert(shader::panelAt({i % kWidth, i / kWidth}, {kWidth, kHeight}));
        return changed;
    }

    /// A panel's colour in its middle row, at a share of its width.
    static glm::vec3 colorIn(const image::Image& picture, uint32_t panel, float share) {
        const glm::uvec2 origin = shader::panelOrigin(panel, {kWidth, kHeight});
        const auto x = origin.x + uint32_t(share * kWidth / 4.0f);
        const auto y = origin.y + kHeight / 8;
        const float* pixel = &picture.pixels[(size_t{y} * kWidth + x) * picture.channels];
        return {pixel[0], pixel[1], pixel[2]};
    }

    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    std::deque<HostTexels> mTexels;
    std::set<std::string> mPasses;
};

TEST_F(EmbeddedOverlay, CoversThePanelsWhoseInputsThereAreAndNothingElse) {
    HostInputs inputs = describe();
    const image::Image without = draw(inputs);
    EXPECT_FALSE(mPasses.contains("show inputs"));
    inputs.showsInputs = true;
    EXPECT_EQ(
        findChanged(draw(inputs), without),
        (std::set<uint32_t>{shader::kPanelMotion, shader::kPanelDepth, shader::kPanelIds})
    );
    giveCameras(inputs);
    EXPECT_EQ(
        findChanged(draw(inputs), without),
        (std::set<uint32_t>{
            shader::kPanelMotion,
            shader::kPanelCamera,
            shader::kPanelObjects,
            shader::kPanelDepth,
            shader::kPanelWorld,
            shader::kPanelIds,
            shader::kPanelJitter})
    );
    inputs.showsInputs = false;
    EXPECT_TRUE(test::sameBits(draw(inputs), without));
    inputs.showsInputs = true;
    inputs.isOff = true;
    (void)draw(inputs); // a copy of the colours
}

TEST_F(EmbeddedOverlay, ShowsWhatMovesByItself) {
    HostInputs inputs = describe();
    giveCameras(inputs);
    inputs.showsInputs = true;
    const image::Image shown = draw(inputs);
    const glm::vec3 moving = shader::colorOfMotion({12.0f, 0.0f});
    EXPECT_LT(glm::distance(colorIn(shown, shader::kPanelMotion, 0.25f), moving), 1.0e-3f);
    EXPECT_LT(glm::distance(colorIn(shown, shader::kPanelObjects, 0.25f), moving), 1.0e-3f);
    for (const float share : {0.25f, 0.75f})
        EXPECT_EQ(colorIn(shown, shader::kPanelCamera, share), glm::vec3(0.0f));
    EXPECT_EQ(colorIn(shown, shader::kPanelMotion, 0.75f), glm::vec3(0.0f));
    EXPECT_EQ(colorIn(shown, shader::kPanelIds, 0.75f), glm::vec3(0.0f));
    EXPECT_LT(
        glm::distance(colorIn(shown, shader::kPanelIds, 0.25f), shader::colorOfId(3)), 1.0e-3f
    );
}

TEST_F(EmbeddedOverlay, WrongCamerasAreRefusedBeforeTheyAreShown) {
    HostInputs inputs = describe();
    std::vector<glm::vec4> motionDepth(kPixels, glm::vec4(1.0f, 0.0f, 5.0f, 0.0f));
    inputs.motionDepth = make(VK_FORMAT_R32G32B32A32_SFLOAT, motionDepth);
    giveCameras(inputs);
    inputs.convention.cameras.clipFromView = math::dmat4(0.0);
    inputs.showsInputs = true;
    const test::Picture output(device(), "output", {kWidth, kHeight});
    inputs.output = {output.handle(), test::kNothing, test::kCopied};
    gpu::Frame frame(device());
    frame.begin();
    const core::Status done = mBlur->record(frame.commands(), 0, inputs, test::gather());
    frame.submit();
    frame.wait();
    ASSERT_FALSE(done.ok());
    EXPECT_NE(done.error().message.find("cameras.clipFromView is neither"), std::string::npos)
        << done.error().message;
}

} // namespace
} // namespace shutter
