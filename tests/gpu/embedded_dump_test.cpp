// SPDX-License-Identifier: MIT
// A dump holds all that a host's picture depends on: replayed, it gives the picture bit for bit.
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/math/transform.h"
#include "game/replay/replay_run.h"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

namespace fs = std::filesystem;
using motion_blur::HostInputs;

constexpr uint32_t kDumpWidth = 64;
constexpr uint32_t kDumpHeight = 48;
constexpr VkExtent2D kDumpExtent{kDumpWidth, kDumpHeight};
constexpr size_t kDumpPixels = size_t{kDumpWidth} * kDumpHeight;

/// A square that moves before a wall, under a camera that turns; every frame differs.
class EmbeddedDump : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        reported().clear();
    }

    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override {
        motion_blur::HostDevice host = describeHost();
        host.message = [](std::string_view sentence) { reported().emplace_back(sentence); };
        return host;
    }

    static std::vector<std::string>& reported() {
        static std::vector<std::string> sentences;
        return sentences;
    }

    /// A text of the dump.
    [[nodiscard]] std::string read(const std::string& name) const {
        const auto bytes = io::readFileBytes(mFolder / name, 1 << 20);
        EXPECT_TRUE(bytes.ok()) << name;
        return bytes ? std::string(bytes.value().begin(), bytes.value().end()) : "";
    }

    void write(const std::string& name, const std::string& text) const {
        EXPECT_TRUE(io::writeFileText(mFolder / name, text).ok()) << name;
    }

    /// In a separate folder.
    void startDump(uint32_t frames) {
        fs::remove_all(mFolder);
        ASSERT_TRUE(mBlur->dump(mFolder, frames).ok());
    }

    template <class T> motion_blur::HostImage make(VkFormat format, const std::vector<T>& values) {
        return makeTexels(format, kDumpExtent, values).describe();
    }

    HostInputs describe(uint32_t frame) {
        std::vector<uint64_t> color;
        std::vector<glm::vec2> vectors;
        std::vector<float> depth;
        std::vector<uint16_t> ids;
        for (uint32_t i = 0; i < kDumpPixels; ++i) {
            const uint32_t x = i % kDumpWidth;
            const uint32_t y = i / kDumpWidth;
            const bool isSquare = x >= 16 + 5 * frame && x < 32 + 5 * frame && y >= 12 && y < 36;
            const float wave = float((x * 7 + y * 13 + frame) % 16) / 16.0f;
            color.push_back(test::packHalf({isSquare ? 3.0f : wave, wave, 0.5f, 1.0f}));
            vectors.push_back(
                {(isSquare ? -9.0f : -1.5f) / kDumpWidth, (isSquare ? -2.0f : 0.0f) / kDumpHeight}
            );
            depth.push_back(y < 6 ? 0.0f : 0.1f / (isSquare ? 2.0f : 6.0f));
            ids.push_back(y < 6 ? 0xFFFF : isSquare ? 3 : 1);
        }
        HostInputs inputs;
        inputs.width = kDumpWidth;
        inputs.height = kDumpHeight;
        inputs.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, color);
        auto& convention = inputs.convention;
        if (mHasVectors)
            convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, vectors);
        convention.vectors.pixelsPerUnit = {-float(kDumpWidth), -float(kDumpHeight)};
        convention.depth.image = make(VK_FORMAT_D32_SFLOAT, depth);
        const auto clip = math::clipFromViewPerspective(1.0, double(kDumpWidth) / kDumpHeight, 0.1);
        const auto viewAt = [](double time) {
            return glm::rotate(glm::dmat4(1.0), 0.03 * time, glm::dvec3(0.0, 1.0, 0.0));
        };
        convention.cameras.areGiven = true;
        convention.cameras.clipFromView = convention.cameras.clipFromViewBefore = clip;
        convention.cameras.viewFromWorld = viewAt(frame);
        convention.cameras.viewFromWorldBefore = viewAt(double(frame) - 1.0);
        if (mIsCut) {
            convention.scales.isCut = true;
            convention.cameras.viewFromWorldBefore = glm::dmat4(0.0);
            convention.cameras.clipFromViewBefore = glm::dmat4(0.0);
        }
        if (mHasIds)
            inputs.entityId = make(VK_FORMAT_R16_UINT, ids);
        inputs.noEntity = 0xFFFF;
        inputs.frameNumber = frame + 7;
        mKeys = {
            motion_blur::HostCameraKey{
                mFirstKey, viewAt(double(frame) - 0.5 * (1.0 - mFirstKey)), clip},
            motion_blur::HostCameraKey{1.0, viewAt(frame), clip}};
        inputs.motion.keys = mKeys;
        inputs.motion.rowCount = 4;
        if (mHasVectors)
            inputs.motion.movers = mMovers;
        inputs.motion.followsLast = frame > 0;
        inputs.motion.lens = mLens;
        convention.viewModel = mViewModel;
        if (mIsStored) {
            std::vector<uint32_t> bytes;
            for (const uint64_t texel : color)
                bytes.push_back(glm::packUnorm4x8(glm::unpackHalf4x16(texel)));
            inputs.color = make(VK_FORMAT_B8G8R8A8_UNORM, bytes);
            inputs.transfer.curve = shader::kTransferSrgb;
        }
        inputs.responsePoints = mResponse;
        inputs.motion.response = mTable ? &*mTable : nullptr;
        if (mIsPacked) {
            std::vector<glm::vec4> packed;
            for (uint32_t i = 0; i < kDumpPixels; ++i)
                packed.emplace_back(3.0f, 1.0f, i / kDumpWidth < 6 ? 1.0e9f : 4.0f, 0.0f);
            inputs.motionDepth = make(VK_FORMAT_R32G32B32A32_SFLOAT, packed);
        }
        return inputs;
    }

    image::Image
    draw(uint32_t frame, const motion_blur::MotionBlurSettings& settings = test::gather()) {
        mTexels.clear();
        image::Image picture = EmbeddedTest::draw(describe(frame), settings, frame % 2);
        EXPECT_TRUE(mBlur->markDone(frame % 2).ok());
        return picture;
    }

    /// \param out a file in the dump's folder; empty: nothing is written
    /// \param method in place of the host's; null: that
    core::Status
    replay(const char* out = "", bool showsInputs = false, const char* method = nullptr) const {
        replay::ReplayOptions options;
        options.folder = mFolder;
        if (*out != 0)
            options.out = mFolder / out;
        options.showsInputs = showsInputs;
        options.change = [&](motion_blur::MotionBlurSettings& settings) -> core::Status {
            if (method)
                settings.method = &motion_blur::getMethod(method);
            return {};
        };
        return replay::replay(options, device());
    }

    /// Replays the dump and expects pictures to be those, bit for bit.
    void expectReplayed(const std::vector<image::Image>& pictures) {
        EXPECT_TRUE(reported().empty()) << reported().front();
        testing::internal::CaptureStdout();
        const core::Status done = replay("replayed.exr");
        std::fflush(stdout);
        const std::string printed = testing::internal::GetCapturedStdout();
        ASSERT_TRUE(done.ok()) << done.error().message;
        size_t same = 0;
        for (size_t at = 0; (at = printed.find("bit for bit", at)) != std::string::npos; ++at)
            ++same;
        EXPECT_EQ(same, pictures.size()) << printed;
        for (size_t i = 0; i < pictures.size(); ++i) {
            if (pictures[i].pixels.empty())
                continue; // compared by the replay alone
            const auto replayed = io::readImage(mFolder / fmt::format("replayed_{:04}.exr", i));
            ASSERT_TRUE(replayed.ok()) << replayed.error().message;
            EXPECT_TRUE(test::sameBits(replayed.value(), pictures[i])) << i;
        }
    }

    test::TempFolder mTemp;
    fs::path mFolder = mTemp.path() / "dump";
    std::array<motion_blur::HostCameraKey, 2> mKeys;
    std::array<motion_blur::HostMover, 1> mMovers{{{3, {}}}};
    std::vector<math::ResponsePoint> mResponse;
    std::optional<shader::ResponseTable> mTable; ///< in main memory alone
    bool mHasVectors = true;
    bool mHasIds = true;
    double mFirstKey = 0.0; ///< its time
    bool mIsCut = false;
    motion_blur::HostLens mLens;
    motion_blur::HostViewModel mViewModel;
    bool mIsStored = false; ///< colours are bytes in gamma space
    bool mIsPacked = false; ///< vectors and depth are one image
};

motion_blur::MotionBlurSettings resolvedWithNoise() {
    motion_blur::MotionBlurSettings settings = test::settingsOf("resolved", 5);
    settings.instantNoise = motion_blur::InstantNoise::PerFrame;
    return settings;
}

/// All frames of a dump, which one effect replays.
TEST_F(EmbeddedDump, ReplayGivesTheHostsPictureForAllInputs) {
    struct Case {
        const char* name;
        motion_blur::MotionBlurSettings settings;
        std::function<void()> change;
    };

    const std::vector<double> focuses{2.0, 4.0};
    const std::array<glm::dmat4, 2> poses{
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.0, 0.0)), glm::dmat4(1.0)};
    const std::vector<math::ResponsePoint> points{{0.0, 0.0}, {0.25, 1.0}, {1.0, 0.0}};
    const auto camera = test::settingsOf("rosado2007");
    const auto resolved = test::settingsOf("resolved", 5);
    const std::vector<Case> cases{
        {"plain", test::gather(), [] {}},
        {"a response", test::gather(), [&] { mResponse = points; }},
        {"a table without an address",
         test::gather(),
         [&] {
             mResponse.clear();
             mTable = math::makeResponseTable(points);
         }},
        {"no camera before a cut",
         test::gather(),
         [&] {
             mTable.reset();
             mIsCut = true;
         }},
        {"the same, packed", test::gather(), [&] { mIsPacked = true; }},
        {"the camera alone, packed", camera, [&] { mIsCut = false; }},
        {"the camera alone", camera, [&] { mIsPacked = false; }},
        {"no vectors", resolvedWithNoise(), [&] { mHasVectors = false; }},
        {"a lens", resolved, [&] { mLens = {.radius = 0.04}; }},
        {"a focus that is pulled",
         resolved,
         [&] { mLens = {.radius = 0.04, .focusDistances = focuses, .blades = 5}; }},
        {"a closed lens", resolved, [&] { mLens = {}; }},
        {"bytes in gamma space", resolved, [&] { mIsStored = true; }},
        {"a view model that moves", resolved, [&] {
             mIsStored = false;
             mViewModel = {.depthMin = 0.04f, .depthMax = 1.0f, .viewFromObject = poses};
         }}};
    startDump(uint32_t(cases.size()));
    std::vector<image::Image> pictures;
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        one.change();
        const std::string file = fmt::format("frame_{:04}.json", pictures.size());
        pictures.push_back(draw(0, one.settings));
        if (mIsStored)
            pictures.back() = {}; // its values are not light, as the dump's are
        // Older readers refuse the member.
        EXPECT_EQ(read(file).find("\"lens\"") != std::string::npos, mLens.isOpen());
    }
    expectReplayed(pictures);
    EXPECT_FALSE(test::sameBits(pictures[0], pictures[1])) << "the response counts";
}

TEST_F(EmbeddedDump, ReplayGivesResolvedWithItsHistory) {
    for (const bool isStillWorld : {false, true}) {
        forgetFrames();
        mHasVectors = mHasIds = !isStillWorld;
        mFirstKey = isStillWorld ? -1.0 : 0.0; // the frame before's
        (void)draw(0, resolvedWithNoise());    // before the dump: its first frame must not use it
        startDump(2);
        const image::Image second = draw(1, resolvedWithNoise());
        const image::Image third = draw(2, resolvedWithNoise());
        expectReplayed({second, third});
    }
}

TEST_F(EmbeddedDump, OlderDumpsWithoutALensAndOtherMethodsAreReplayedAsByAPinhole) {
    mHasVectors = false;
    const motion_blur::MotionBlurSettings settings = test::settingsOf("resolved", 5);
    const image::Image pinhole = draw(0, settings);
    mLens = {.radius = 0.04};
    startDump(1);
    EXPECT_FALSE(test::sameBits(draw(0, settings), pinhole));
    const core::Status byGather = replay("", false, "gather");
    EXPECT_TRUE(byGather.ok()) << byGather.error().message;
    std::string text = read("frame_0000.json");
    const size_t at = text.find(",", text.find("\"rowIds\""));
    const size_t end = text.find("}", text.find("\"lens\"")) + 1;
    ASSERT_LT(at, end);
    write("frame_0000.json", text.erase(at, end - at));
    const core::Status older = replay("replayed.exr");
    ASSERT_TRUE(older.ok()) << older.error().message;
    EXPECT_TRUE(test::sameBits(io::readImage(mFolder / "replayed.exr").value(), pinhole));
}

TEST_F(EmbeddedDump, ReplayCanShowTheInputsThatTheHostDidNot) {
    startDump(1);
    const image::Image picture = draw(0);
    // The number of the dump's frame.
    ASSERT_TRUE(replay("shown_%d.exr", true).ok());
    const auto shown = io::readImage(mFolder / "shown_0.exr");
    ASSERT_TRUE(shown.ok());
    // Panels lie along the top and the bottom.
    const size_t row = size_t{kDumpWidth} * picture.channels;
    const auto sameRow = [&](uint32_t y) {
        return std::equal(
            &picture.pixels[y * row], &picture.pixels[y * row] + row, &shown.value().pixels[y * row]
        );
    };
    EXPECT_TRUE(sameRow(kDumpHeight / 2));
    EXPECT_FALSE(sameRow(kDumpHeight / 8));
}

TEST_F(EmbeddedDump, FaultsOfADumpAreReported) {
    startDump(1);
    const auto refuse = [&](const fs::path& folder, uint32_t frames, const char* sentence) {
        test::expectRefusal(mBlur->dump(folder, frames), sentence);
    };
    refuse(mFolder, 1, "1 recording of the last dump is to come");
    (void)draw(0);
    refuse(mFolder, 1, "holds a dump already");
    refuse(mFolder / "other", 0, "frames is 0, it must be 1 to 9999");
    refuse("/proc/none", 1, "'/proc/none'");
    // A folder that went away.
    startDump(2);
    fs::remove_all(mFolder);
    (void)draw(0);
    ASSERT_EQ(reported().size(), 1u);
    EXPECT_NE(reported()[0].find("No such file or directory"), std::string::npos) << reported()[0];
    startDump(1); // the last one has ended
    (void)draw(0);
}

TEST_F(EmbeddedDump, HostileDumpsAndMethodsThatADumpCannotServeAreRefusedInOneSentence) {
    startDump(1);
    (void)draw(0);
    for (const auto& [method, sentence] :
         {std::pair(
              "hybrid", "the dump holds nothing of what lies behind, since the host ran gather"
          ),
          {"resolved", "the dump holds no camera keys, since the host ran gather"},
          {"adaptive", "needs the scene, which no dump holds"}})
        test::expectRefusal(replay("", false, method), sentence);
    const std::string text = read("frame_0000.json");
    const auto refuse = [&](const std::string& from, const std::string& to, const char* sentence) {
        std::string changed = text;
        const size_t at = changed.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        write("frame_0000.json", changed.replace(at, from.size(), to));
        test::expectRefusal(replay(), sentence);
    };
    refuse("frame_0000_color.bin", "../frame_0000_color.bin", "the name of a file in the folder");
    refuse("frame_0000_color.bin", "/etc/passwd", "the name of a file in the folder");
    refuse(
        "frame_0000_color.bin", "frame_0000_depth.bin", "bytes, the image 'color' of 64 x 48 has"
    );
    refuse("\"width\": 64", "\"width\": 4000000000", "width");
    refuse("\"width\": 64", "\"width\": NaN", "frame_0000.json:");
    refuse("\"gather\"", "\"teapot\"", "is no method of the motion blur");
    refuse("\"frameNumber\"", "\"frame number\"", "frame number");
    refuse(text.substr(text.size() / 2), "", "frame_0000.json:");
    write("frame_0000.json", text);
    fs::resize_file(mFolder / "frame_0000_color.bin", 100);
    test::expectRefusal(replay(), "has 100 bytes");
}

} // namespace
} // namespace shutter
