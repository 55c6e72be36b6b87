// SPDX-License-Identifier: MIT
// --environment and --sky: files that are none are refused, good ones are seen.
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

namespace shutter::cli {

namespace {

constexpr int kFailed = 1;

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
