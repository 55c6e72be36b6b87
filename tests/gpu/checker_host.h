// SPDX-License-Identifier: MIT
// A host that draws a scene under a moving camera and hands it to the checker of inputs, in the
// convention and with the mistake that a case says.
#pragma once

#include "engine/render/renderer.h"
#include "shaders/render/scene_shared.h"
#include "tests/gpu/checked_shot.h"
#include "tests/gpu/embedding_host.h"

#include <deque>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace shutter::test {

inline constexpr uint32_t kCheckedWidth = 192;
inline constexpr uint32_t kCheckedHeight = 108;
inline constexpr size_t kCheckedPixels = size_t{kCheckedWidth} * kCheckedHeight;

/// A frame of a scene as the engine's raster has it.
struct CheckedDrawing {
    std::vector<glm::vec4> color{kCheckedPixels};
    std::vector<glm::vec2> motion{kCheckedPixels}; ///< pixels since the frame before
    std::vector<float> metres = std::vector<float>(kCheckedPixels);
    std::vector<uint32_t> ids = std::vector<uint32_t>(kCheckedPixels);
    motion_blur::HostCameras cameras; ///< reversed; infinite where they are perspective
    uint32_t rowCount = 0;
    std::vector<uint32_t> movers; ///< rows that move
    std::vector<bool> deforms;    ///< by row
    /// World from object of a row, and the camera, at shares of the time between the frames: 0 the
    /// frame before, 1 this one.
    std::function<math::dmat4(uint32_t row, double share)> placeAt;
    std::function<motion_blur::HostCameraKey(double share)> cameraAt;
};

/// What a host hands in, to be changed into what it gets wrong or has in another way.
struct GivenFrame : CheckedDrawing {
    std::vector<float> depth; ///< as stored
    motion_blur::HostInputs inputs;
    std::vector<motion_blur::HostMover> listed;
    /// Empty: the frame before's and this one's.
    std::vector<motion_blur::HostCameraKey> keys;
    std::deque<std::vector<math::dmat4>> matrices; ///< of `listed`
    std::vector<uint64_t> rowIds;                  ///< empty: the rows
    glm::dvec2 jitterPx{0.0};
    glm::dvec2 jitterPxBefore{0.0};
    bool isResolved = false;
    bool hasVectors = true;
    bool hasIds = true;
    bool history = true;
    bool isNative = false; ///< vectors and metres are one image
    VkFormat vectorFormat = VK_FORMAT_R32G32_SFLOAT;
    VkFormat depthFormat = VK_FORMAT_R32_SFLOAT;
    uint32_t coarseness = 1;   ///< vectors and depth have so many times fewer columns and rows
    bool isSurrounded = false; ///< each image is part of a larger one, with rubbish elsewhere
    /// Each image is a layer of two, with rubbish in the other; null: none is.
    std::optional<uint32_t> layer;
    /// The picture is this part of what was drawn.
    VkRect2D part{{0, 0}, {kCheckedWidth, kCheckedHeight}};
};

using ChangeGiven = std::function<
    void(GivenFrame&, int frame, const CheckedDrawing& before, const CheckedDrawing& after)>;

struct CheckCase {
    std::string name;
    std::string sentence; ///< part of one; empty: none may come
    ChangeGiven change;
    bool isStill = false; ///< the camera stands still in all frames
    uint32_t viewCount = 1;
    std::string orthographicSentence{}; ///< in place of `sentence`; empty: that
    bool needsMovers = false;           ///< rigid ones, in view
    bool isUneven = false;              ///< the last frame is twice as long after the one before
};

/// Named for gtest's sake.
void PrintTo(const CheckScene& scene, std::ostream* stream);

/// Scenes under cameras that move and turn.
[[nodiscard]] std::vector<CheckScene> listCheckScenes();
/// What hosts get wrong, with part of the sentence that says so.
[[nodiscard]] const std::vector<CheckCase>& listMistakes();
/// The same of what "resolved" reads besides.
[[nodiscard]] const std::vector<CheckCase>& listMotionMistakes();
/// What hosts may do; the first is the plainest.
[[nodiscard]] const std::vector<CheckCase>& listRightHosts();

/// Middle of a pixel.
[[nodiscard]] glm::dvec2 placeOf(size_t pixel);
/// Where another camera sees what a pixel shows.
[[nodiscard]] glm::dvec2
seeFrom(const CheckedDrawing& drawn, size_t pixel, const glm::dmat4& view, const glm::dmat4& clip);
/// \param clip of `cameras`, which are reversed
[[nodiscard]] float storeDepth(const glm::dmat4& clip, float metres);

class CheckerHost : public EmbeddedTest, public testing::WithParamInterface<CheckScene> {
  protected:
    void SetUp() override;

    [[nodiscard]] GivenFrame give(int frame, const CheckCase& one, uint32_t view = 0) const;

    /// What the checker says of some frames.
    [[nodiscard]] std::vector<std::string> check(const CheckCase& one);

    /// \param number of the recording
    void record(
        motion_blur::EmbeddedMotionBlur& blur,
        uint32_t number,
        GivenFrame& given,
        const Picture* output = nullptr
    );

  private:
    /// \param number of half frames
    /// \param frames since the one before
    CheckedDrawing draw(render::Renderer& renderer, int number, double frames);

    std::optional<CheckedShot> mShot;
    std::deque<CheckedDrawing> mDrawn; ///< each half a frame after the one before
    CheckedDrawing mUneven;            ///< the last frame, where it is longer
};

} // namespace shutter::test
