// SPDX-License-Identifier: MIT
// --environment and --sky: files that are none are refused, good ones are seen.
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

namespace shutter::cli {

namespace {

image::Image makePicture(uint32_t width, uint32_t height, float value) {
    image::Image picture(width, height, 3);
    for (float& v : picture.pixels)
        v = value;
    return picture;
}

image::Image readBack(const std::string& path) {
    auto read = io::readImage(path);
    EXPECT_TRUE(read);
    return read ? std::move(read).value() : image::Image();
}

} // namespace

TEST_F(Cli, AnEnvironmentThatIsNoneIsRefused) {
    requireDevice();
    const std::string wide = path("square.exr");
    ASSERT_TRUE(io::writeImage(wide, makePicture(64, 64, 0.5f)));
    writeFile("text.hdr", "no picture");
    for (const auto& [file, mention] :
         {std::pair{"missing.hdr", "missing.hdr"},
          {"text.hdr", "text.hdr"},
          {"square.exr", "64x64"}})
        expectRefusal(
            renderVase({"--out", "a.png", "--environment", file}),
            kFailed,
            {"--environment", mention}
        );
}

TEST_F(Cli, AnEnvironmentThatIsPartOfAPictureOrNoColourIsRefused) {
    requireDevice();
    image::Image picture = makePicture(64, 32, 0.5f);
    picture.channelNames = {"N.x", "N.y", "N.z"};
    ASSERT_TRUE(io::writeImage(path("normals.exr"), picture));
    picture.channelNames = {};
    ASSERT_TRUE(io::writeImage(path("part.exr"), picture));
    std::string exr = readFile("part.exr");
    const std::string window("displayWindow\0box2i\0\x10\0\0\0", 24);
    const size_t right = exr.find(window) + window.size() + 8;
    exr[right] = 127;
    exr[right + 4] = 63;
    writeFile("part.exr", exr);
    for (const auto& [file, mention] :
         {std::pair{"normals.exr", "no colour but N.x, N.y, N.z"}, {"part.exr", "display window"}})
        expectRefusal(
            renderVase({"--out", "a.png", "--environment", file}),
            kFailed,
            {"--environment", file, mention}
        );
}

TEST_F(Cli, AnEnvironmentIsItsDisplayWindowAndChannelsLeftOutAreReported) {
    requireDevice();
    // A bright frame of a pixel around a grey picture, outside of the display window.
    image::Image picture(66, 34, 4);
    for (uint32_t y = 0; y < 34; ++y)
        for (uint32_t x = 0; x < 66; ++x)
            for (uint32_t c = 0; c < 4; ++c)
                picture.at(x, y, c) = x == 0 || y == 0 || x == 65 || y == 33 ? 1000.0f : 0.4f;
    picture.channelNames = {"R", "G", "B", "Z"};
    ASSERT_TRUE(io::writeImage(path("around.exr"), picture));
    std::string exr = readFile("around.exr");
    const std::string window("displayWindow\0box2i\0\x10\0\0\0", 24);
    const size_t corners = exr.find(window) + window.size();
    for (const auto& [place, value] : {std::pair{0, 1}, {4, 1}, {8, 64}, {12, 32}})
        exr[corners + size_t(place)] = char(value);
    writeFile("around.exr", exr);
    ASSERT_TRUE(io::writeImage(path("plain.exr"), makePicture(64, 32, 0.4f)));
    const Outcome drawn = run(renderVase({"--out", "a.png", "--environment", "around.exr"}));
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_NE(drawn.err.find("'around.exr' has channels that are left out: Z"), std::string::npos)
        << drawn.err;
    expectSuccess(renderVase({"--out", "b.png", "--environment", "plain.exr"}));
    EXPECT_EQ(readFile("a.png"), readFile("b.png"));
}

TEST_F(Cli, AnEnvironmentOfOneColourIsTheTwoColours) {
    requireDevice();
    // Twice as bright by its intensity.
    ASSERT_TRUE(io::writeImage(path("grey.exr"), makePicture(64, 32, 0.2f)));
    expectSuccess(
        renderVase({"--out", "a.exr", "--environment", "grey.exr", "--environment-intensity", "2"})
    );
    expectSuccess(
        renderVase({"--out", "b.exr", "--background", "0.4,0.4,0.4", "--ambient", "0.4,0.4,0.4"})
    );
    expectSuccess(renderVase({"--out", "c.exr"}));
    const image::Image seen = readBack(path("a.exr"));
    EXPECT_GT(image::computePsnr(seen, readBack(path("b.exr"))), 55.0);
    EXPECT_LT(image::computePsnr(seen, readBack(path("c.exr"))), 40.0);
}

TEST_F(Cli, ASkyIsExplained) {
    requireDevice();
    const Outcome sky = run(renderVase({"--out", "a.png", "--sky", "2.5", "--explain"}));
    EXPECT_NE((sky.out + sky.err).find("environment"), std::string::npos);
    EXPECT_NE((sky.out + sky.err).find("it is seen where nothing is"), std::string::npos);
    const Outcome none = run(renderVase({"--out", "b.png", "--explain"}));
    EXPECT_NE((none.out + none.err).find("the scene has none"), std::string::npos);
}

} // namespace shutter::cli
