// SPDX-License-Identifier: MIT
// A host that draws a scene under a moving camera and passes it to the checker of inputs, with a
// case's convention and mistake.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "engine/core/result.h"
#include "engine/render/renderer.h"
#include "game/options/shot_arguments.h"
#include "game/shot/shot.h"
#include "shaders/render/scene_shared.h"
#include "tests/gpu/gbuffer_host.h"

#include <deque>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace shutter::test {

struct CheckScene {
    std::string name;
    generator::GltfWriter (*build)(); ///< null: a file of the shared scenes
    std::string path;                 ///< of that
    std::string keys;                 ///< of a flythrough
    double orthographicYMag = 0.0;    ///< half height of the view, metres; 0: perspective
    /// Too much moves by itself for mistakes to be seen.
    bool hidesMistakes = false;
    void (*prepare)(scene::World& world) = nullptr; ///< moves what the file has at rest
};

inline constexpr uint32_t kCheckedWidth = 192;
inline constexpr uint32_t kCheckedHeight = 108;
inline constexpr size_t kCheckedPixels = size_t{kCheckedWidth} * kCheckedHeight;

/// A frame of a scene as the engine's raster has it.
struct CheckedDrawing {
    std::vector<glm::vec4> color{kCheckedPixels};
    std::vector<glm::vec2> motion{kCheckedPixels}; ///< pixels since the previous frame
    std::vector<float> metres = std::vector<float>(kCheckedPixels);
    std::vector<uint32_t> ids = std::vector<uint32_t>(kCheckedPixels);
    motion_blur::HostCameras cameras; ///< reversed; infinite where they are perspective
    uint32_t rowCount = 0;
    std::vector<uint32_t> movers; ///< rows that move
    std::vector<bool> deforms;    ///< by row
    /// World from object of a row, and the camera, at shares of the time between the frames: 0 the
    /// previous frame, 1 this one.
    std::function<math::dmat4(uint32_t row, double share)> placeAt;
    std::function<motion_blur::HostCameraKey(double share)> cameraAt;
};

/// A host's inputs, to be changed to a mistake or another convention.
struct GivenFrame : CheckedDrawing {
    int frame = 0;
    const CheckedDrawing* before = nullptr; ///< the frame before and the next one
    const CheckedDrawing* after = nullptr;
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
    /// The picture is this part of the image.
    VkRect2D part{{0, 0}, {kCheckedWidth, kCheckedHeight}};

    /// There is none before this one: all that was then is zero.
    void cutFromLast();
};

struct CheckCase {
    std::string name;
    std::string sentence; ///< part of one; empty: none may come
    std::function<void(GivenFrame&)> change;
    std::string orthographicSentence{}; ///< in place of `sentence`; empty: that
    bool isStatic = false;              ///< the camera is static in all frames
    uint32_t viewCount = 1;
    bool needsMovers = false; ///< rigid ones, in view
    bool isUneven = false;    ///< the last frame is twice as long after the one before
};

/// Named for gtest's sake.
void PrintTo(const CheckScene& scene, std::ostream* stream);

/// Scenes under cameras that move and turn: two, all of them with SHUTTER_ALL.
[[nodiscard]] std::vector<CheckScene> listCheckScenes();
/// Mistakes of hosts, with part of the reported sentence.
[[nodiscard]] const std::vector<CheckCase>& listMistakes();
/// What hosts may do; the first is the plainest.
[[nodiscard]] const std::vector<CheckCase>& listRightHosts();

/// Middle of a pixel.
[[nodiscard]] glm::dvec2 placeOf(size_t pixel);
/// Where another camera sees what a pixel shows.
[[nodiscard]] glm::dvec2
seeFrom(const CheckedDrawing& drawn, size_t pixel, const glm::dmat4& view, const glm::dmat4& clip);
/// \param clip of `cameras`, which are reversed
[[nodiscard]] float storeDepth(const glm::dmat4& clip, float metres);

/// Keys of the frame before and of this one, as a host has them that knows no others.
void giveKeys(GivenFrame& given);
/// A matrix for each key, of each listed mover that does not deform, and keys if there are none.
void giveMatrices(GivenFrame& given);
/// The same, and no other movers.
void giveMatricesOnly(GivenFrame& given);

/// Frames of a scene, which is loaded and drawn once for all tests.
struct CheckedScene {
    game::ShotOptions options;
    game::Shot shot;
    std::deque<CheckedDrawing> drawn; ///< each half a frame after the one before
    CheckedDrawing uneven;            ///< the last frame, where it is longer
};

class CheckerHost : public EmbeddedTest, public testing::WithParamInterface<CheckScene> {
  protected:
    void SetUp() override;

    [[nodiscard]] GivenFrame give(int frame, const CheckCase& one, uint32_t view = 0) const;

    /// Sentences of the suite's checker for some frames. It leaves out what it has reported before.
    [[nodiscard]] std::vector<std::string> check(const CheckCase& one);

    /// \param number of the recording
    static void record(
        motion_blur::EmbeddedMotionBlur& blur,
        uint32_t number,
        GivenFrame& given,
        const Picture* output = nullptr
    );

    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override;

  private:
    const CheckedScene* mScene = nullptr;
};

} // namespace shutter::test
