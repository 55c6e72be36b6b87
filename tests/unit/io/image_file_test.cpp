// SPDX-License-Identifier: MIT
#include "engine/io/image_file.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace shutter::io {

namespace {

using test::TempFolder;

namespace fs = std::filesystem;

image::Image makeRamp(uint32_t width, uint32_t height, uint32_t channels) {
    image::Image image(width, height, channels);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] = float(i) / float(image.pixels.size());
    }
    return image;
}

/// Does not compress below a thousand bytes.
image::Image makeNoise(uint32_t width, uint32_t height, uint32_t channels) {
    image::Image image(width, height, channels);
    uint32_t state = 1;
    for (float& value : image.pixels) {
        state = state * 1664525u + 1013904223u;
        value = float(state >> 8);
    }
    return image;
}

std::string readAll(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The picture as it is read from a file of that name, to which it was written.
image::Image
reread(const char* name, const image::Image& image, SampleType type = SampleType::Float) {
    const TempFolder folder;
    test::expectDone(writeImage(folder.path() / name, image, type));
    return test::valueOf(readImage(folder.path() / name));
}

/// One row of one channel.
image::Image makeRow(std::vector<float> pixels) {
    image::Image image(uint32_t(pixels.size()), 1, 1);
    image.pixels = std::move(pixels);
    return image;
}

TEST(ImageFile, AFloatExrComesBackExactlyWithItsChannelNames) {
    image::Image image = makeRamp(5, 3, 2);
    image.channelNames = {"motion.x", "motion.y"};
    image.pixels[0] = -1234.5678f;
    image.pixels[1] = 1e30f;
    image.pixels[2] = std::numeric_limits<float>::infinity();
    const image::Image read = reread("motion.exr", image);
    EXPECT_EQ(read.width, 5u);
    EXPECT_EQ(read.height, 3u);
    EXPECT_EQ(read.pixels, image.pixels);
    EXPECT_EQ(read.channelNames, image.channelNames);
    EXPECT_TRUE(std::isnan(reread("nan.exr", makeRow({std::nanf("")})).pixels[0]));
}

TEST(ImageFile, EightBitPicturesAreStoredForADisplayAndFloatsAndIdsAreNot) {
    const TempFolder folder;
    for (const char* name : {"a.png", "a.jpg", "a.exr"}) {
        ASSERT_TRUE(writeImage(folder.path() / name, makeRamp(4, 4, 3)));
        const StoredImage read = test::valueOf(readStoredImage(folder.path() / name));
        EXPECT_EQ(read.isDisplayEncoded, std::string(name) != "a.exr") << name;
        EXPECT_EQ(read.image.pixels, readImage(folder.path() / name).value().pixels);
    }
    for (const SampleType type : {SampleType::Half, SampleType::Uint}) {
        ASSERT_TRUE(writeImage(folder.path() / "b.exr", makeRamp(4, 4, 1), type));
        EXPECT_FALSE(readStoredImage(folder.path() / "b.exr").value().isDisplayEncoded);
    }
    EXPECT_FALSE(readStoredImage(folder.path() / "missing.exr"));
}

TEST(ImageFile, AnExrHasNoTimeOfWriting) {
    const TempFolder folder;
    ASSERT_TRUE(writeImage(folder.path() / "a.exr", makeRamp(5, 3, 2)).ok());
    const std::string bytes = readAll(folder.path() / "a.exr");
    const size_t date = bytes.find("capDate");
    ASSERT_NE(date, std::string::npos);
    EXPECT_NE(bytes.substr(date, 60).find("1970:01:01 00:00:00"), std::string::npos);
}

TEST(ImageFile, AHalfExrKeepsElevenBitsAndAnUnsignedOneIdsAsTheyAre) {
    const image::Image image = makeRow({1.0f + 1.0f / 1024.0f, 1.0f + 1.0f / 4096.0f});
    const image::Image half = reread("half.exr", image, SampleType::Half);
    EXPECT_EQ(half.pixels[0], image.pixels[0]);
    EXPECT_EQ(half.pixels[1], 1.0f) << "a float channel would have kept it";
    image::Image ids = makeRow({0.0f, 1.0f, 70000.0f, 16777215.0f, -3.0f});
    ids.channelNames = {"mesh_id"};
    const image::Image whole = reread("id.exr", ids, SampleType::Uint);
    EXPECT_EQ(whole.pixels, (std::vector<float>{0.0f, 1.0f, 70000.0f, 16777215.0f, 0.0f}));
    EXPECT_EQ(whole.channelNames, ids.channelNames);
}

TEST(ImageFile, APngRoundsToTheNearestOf256StepsAndClamps) {
    const image::Image read =
        reread("grey.PNG", makeRow({-1.0f, 0.0f, 0.5f, 100.4f / 255.0f, 7.0f, std::nanf("")}));
    ASSERT_EQ(read.channels, 1u);
    const float expected[] = {0.0f, 0.0f, 128.0f, 100.0f, 255.0f, 0.0f};
    for (uint32_t x = 0; x < 6; ++x)
        EXPECT_NEAR(read.at(x, 0, 0) * 255.0f, expected[x], 1e-3f) << x;
}

TEST(ImageFile, ADeepPngKeepsSixteenBits) {
    const TempFolder folder;
    const fs::path path = folder.path() / "deep.png";
    ASSERT_TRUE(writeDeepPng(path, makeRow({-1.0f, 1.0f / 65535.0f, 40000.0f / 65535.0f, 7.0f})));
    const auto read = test::valueOf(readStoredImage(path));
    EXPECT_TRUE(read.isDisplayEncoded);
    const std::vector<float> expected = {0.0f, 1.0f / 65535.0f, 40000.0f / 65535.0f, 1.0f};
    for (size_t i = 0; i < expected.size(); ++i)
        EXPECT_FLOAT_EQ(read.image.pixels[i], expected[i]) << i;
}

TEST(ImageFile, APngOfFourChannelsStoresTheFirstThreeUnchanged) {
    image::Image image(1, 1, 4);
    image.pixels = {1.0f, 0.2f, 0.4f, 0.0f}; // alpha 0 must not blacken the colour
    const image::Image read = reread("rgba.png", image);
    EXPECT_EQ(read.channels, 3u);
    EXPECT_NEAR(read.at(0, 0, 0), 1.0f, 1e-4f);
    EXPECT_NEAR(read.at(0, 0, 1), 0.2f, 1e-4f);
}

TEST(ImageFile, EncodedBytesAreThoseOfTheFile) {
    const TempFolder folder;
    for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
        const image::Image image = makeRamp(16, 16, 3);
        ASSERT_TRUE(writeImage(folder.path() / name, image, SampleType::Half)) << name;
        const auto bytes = test::valueOf(encodeImage(name, image, SampleType::Half));
        EXPECT_EQ(std::string(bytes.begin(), bytes.end()), readAll(folder.path() / name)) << name;
    }
    EXPECT_FALSE(encodeImage("a.bmp", makeRamp(1, 1, 3)));
    EXPECT_FALSE(encodeImage("a.png", image::Image(0, 0, 3)));
}

TEST(ImageFile, AJpegOfLowerQualityIsSmaller) {
    image::Image image = makeNoise(64, 64, 3);
    for (float& value : image.pixels)
        value /= float(1 << 24);
    size_t before = SIZE_MAX;
    for (int quality : {95, 80, 40, 10}) {
        const auto bytes = test::valueOf(encodeImage("a.jpg", image, SampleType::Float, quality));
        EXPECT_LT(bytes.size(), before * 9 / 10) << quality;
        before = bytes.size();
    }
}

TEST(ImageFile, AnExrOfASequenceCarriesItsRateAndItsTimeCode) {
    const TempFolder folder;
    const fs::path path = folder.path() / "frame.exr";
    const Timecode timecode{12, 34, 56, 29};
    ASSERT_TRUE(writeStampedImage(path, makeRamp(4, 4, 3), {{30000.0, 1001.0}, timecode}));
    const std::string text = readAll(path);
    // 30000 and 1001.
    constexpr std::string_view kRate(
        "framesPerSecond\0rational\0\x08\0\0\0\x30\x75\0\0\xE9\x03\0\0", 37
    );
    EXPECT_NE(text.find(kRate), std::string::npos);
    // Name, type and size of the attribute, and the digits of the code from the last to the first.
    constexpr std::string_view kAttribute("timeCode\0timecode\0\x08\0\0\0\x29\x56\x34\x12", 26);
    EXPECT_NE(text.find(kAttribute), std::string::npos);
    EXPECT_EQ(test::valueOf(readImage(path)).pixels, makeRamp(4, 4, 3).pixels);
    ASSERT_TRUE(writeImage(path, makeRamp(4, 4, 3)));
    const std::string bare = readAll(path);
    EXPECT_EQ(bare.find("timeCode"), std::string::npos);
    EXPECT_EQ(bare.find("framesPerSecond"), std::string::npos);
    ASSERT_TRUE(writeStampedImage(path, makeRamp(4, 4, 3), {core::FrameRate(1e12)}));
    EXPECT_EQ(readAll(path).find("framesPerSecond"), std::string::npos) << "no fraction holds it";
}

TEST(ImageFile, AFailedWriteKeepsTheOldFileAndLeavesNoTemporary) {
    const TempFolder folder;
    const fs::path path = folder.write("a.jpg", "old");
    const image::Image wide(70000, 1, 3); // JPEG ends at 65500
    test::expectRefused(writeImage(path, wide), "cannot write '" + path.string());
    EXPECT_EQ(readAll(path).size(), 3u);
    EXPECT_EQ(test::countFiles(folder.path()), 1u);
}

TEST(ImageFile, FilesThatCannotBeWrittenOrReadAreNamedWithTheCause) {
    const TempFolder folder;
    test::expectRefused(writeImage(folder.path() / "a.exr", image::Image()), "no pixels");
    EXPECT_TRUE(checkWritable(folder.path() / "a.exr"));
    test::expectRefused(checkWritable(folder.path() / "nowhere" / "a.exr"), "nowhere");
    EXPECT_FALSE(checkWritable(""));
    EXPECT_FALSE(isDisplayFormat("a.exr").value());
    EXPECT_TRUE(isDisplayFormat("a.JPG").value());
    test::expectRefused(isDisplayFormat("a.tga"), ".tga");
    EXPECT_FALSE(isDisplayFormat("noextension"));
    test::expectRefused(readImage(folder.path() / "none.png"), "no such file");
    EXPECT_FALSE(readImage(folder.path()));
    test::expectRefused(readImage(folder.write("text.png", "not a picture")), "text.png");
    EXPECT_FALSE(readImage(folder.write("empty.exr", "")));
}

/// The texture of a picture that is encoded as a file of that name.
scene::TextureImage decodeEncoded(const char* name, const image::Image& image) {
    return test::valueOf(decodeTexture(test::valueOf(encodeImage(name, image)), name));
}

using Rgba = std::vector<uint8_t>;

TEST(DecodeTexture, PicturesBecomeEightBitsOfFourChannelsWithOpaqueAlpha) {
    image::Image color(2, 1, 3);
    color.pixels = {1.0f, 0.0f, 0.2f, 0.0f, 1.0f, 0.4f};
    const scene::TextureImage texture = decodeEncoded("a.png", color);
    EXPECT_EQ(texture.width, 2u);
    EXPECT_EQ(texture.height, 1u);
    EXPECT_EQ(texture.rgba, (Rgba{255, 0, 51, 255, 0, 255, 102, 255}));
    EXPECT_EQ(decodeEncoded("a.png", makeRow({0.4f})).rgba, (Rgba{102, 102, 102, 255}));
    image::Image white(8, 8, 3);
    std::fill(white.pixels.begin(), white.pixels.end(), 1.0f);
    const Rgba jpeg = decodeEncoded("a.jpg", white).rgba;
    EXPECT_GE(jpeg[0], 253);
    EXPECT_EQ(jpeg[3], 255);
}

// A 1x1 RGBA PNG of (200, 100, 50, 128).
const Rgba kTranslucentPng = {137, 80,  78, 71,  13,  10,  26, 10, 0,  0,  0,   13,  73,  72,
                              68,  82,  0,  0,   0,   1,   0,  0,  0,  1,  8,   6,   0,   0,
                              0,   31,  21, 196, 137, 0,   0,  0,  13, 73, 68,  65,  84,  120,
                              156, 99,  56, 145, 98,  212, 0,  0,  5,  53, 1,   223, 115, 98,
                              227, 219, 0,  0,   0,   0,   73, 69, 78, 68, 174, 66,  96,  130};

// A 1x1 16-bit grey and alpha PNG of (0x8000, 0x4000).
const Rgba kDeepPng = {137, 80,  78,  71,  13,  10, 26, 10, 0,  0,   0,   13,  73, 72,
                       68,  82,  0,   0,   0,   1,  0,  0,  0,  1,   16,  4,   0,  0,
                       0,   229, 140, 208, 65,  0,  0,  0,  13, 73,  68,  65,  84, 120,
                       156, 99,  104, 96,  112, 96, 0,  0,  2,  133, 0,   193, 26, 194,
                       37,  36,  0,   0,   0,   0,  73, 69, 78, 68,  174, 66,  96, 130};

// A 2x1 PNG with a palette of (10, 20, 30) and (200, 150, 100), the second half transparent.
const Rgba kPalettePng = {
    137, 80, 78, 71,  13,  10,  26,  10,  0,  0,   0,   13,  73,  72,  68,  82,  0,   0,  0,  2,
    0,   0,  0,  1,   8,   3,   0,   0,   0,  195, 252, 143, 184, 0,   0,   0,   6,   80, 76, 84,
    69,  10, 20, 30,  200, 150, 100, 211, 34, 196, 98,  0,   0,   0,   2,   116, 82,  78, 83, 255,
    128, 8,  15, 179, 106, 0,   0,   0,   11, 73,  68,  65,  84,  120, 156, 99,  96,  96, 4,  0,
    0,   4,  0,  2,   191, 122, 63,  74,  0,  0,   0,   0,   73,  69,  78,  68,  174, 66, 96, 130};

TEST(DecodeTexture, AlphaIsNotMultipliedInAndDepthsAndPalettesBecomeEightBits) {
    const auto decode = [](const Rgba& png) { return test::valueOf(decodeTexture(png, "a")).rgba; };
    EXPECT_EQ(decode(kTranslucentPng), (Rgba{200, 100, 50, 128}));
    EXPECT_EQ(decode(kDeepPng), (Rgba{128, 128, 128, 64}));
    EXPECT_EQ(decode(kPalettePng), (Rgba{10, 20, 30, 255, 200, 150, 100, 128}));
}

TEST(DecodeTexture, DamagedBytesAreAnErrorThatNamesThePicture) {
    EXPECT_FALSE(decodeTexture({}, "a"));
    const std::vector<uint8_t> noise(100, 7);
    test::expectRefused(decodeTexture(noise, "images[3] (wood.png)"), "images[3] (wood.png)");
    for (size_t size = 1; size < kTranslucentPng.size(); ++size) {
        EXPECT_FALSE(decodeTexture(std::span(kTranslucentPng).first(size), "a")) << size;
    }
    test::expectRefused(decodeTexture(std::span(kTranslucentPng).first(40), "a"), "cut off");
    std::vector<uint8_t> flipped = kTranslucentPng;
    flipped[43] ^= 0x40; // inside the compressed pixels
    EXPECT_FALSE(decodeTexture(flipped, "a"));
}

// A correct grey PNG of 20000x1 pixels.
const Rgba kWidePng = {
    137, 80,  78,  71,  13,  10,  26,  10, 0, 0,  0,   13,  73,  72, 68,  82,  0,  0,   78, 32,
    0,   0,   0,   1,   8,   0,   0,   0,  0, 30, 223, 193, 82,  0,  0,   0,   42, 73,  68, 65,
    84,  120, 156, 237, 193, 49,  1,   0,  0, 0,  194, 160, 245, 79, 109, 13,  15, 160, 0,  0,
    0,   0,   0,   0,   0,   0,   0,   0,  0, 0,  0,   0,   0,   0,  0,   0,   0,  184, 48, 78,
    33,  0,   1,   62,  181, 213, 181, 0,  0, 0,  0,   73,  69,  78, 68,  174, 66, 96,  130};

// A grey PNG that claims 16000x16000 pixels and holds 16.
const Rgba kClaimingPng = {137, 80,  78, 71,  13, 10,  26, 10, 0,   0,   0,  13,  73,  72,
                           68,  82,  0,  0,   62, 128, 0,  0,  62,  128, 8,  0,   0,   0,
                           0,   100, 21, 128, 2,  0,   0,  0,  11,  73,  68, 65,  84,  120,
                           156, 99,  96, 64,  5,  0,   0,  16, 0,   1,   57, 189, 143, 101,
                           0,   0,   0,  0,   73, 69,  78, 68, 174, 66,  96, 130};

TEST(DecodeTexture, PicturesAboveTheLimitOrOfMorePixelsThanBytesCanHoldAreRefused) {
    const auto wide = decodeTexture(kWidePng, "a");
    test::expectRefused(wide, "20000x1");
    test::expectRefused(wide, "16384x16384");
    EXPECT_EQ(
        test::errorOf(decodeTexture(kClaimingPng, "a")),
        "cannot decode a: it claims 16000x16000 pixels in 68 bytes"
    );
    const TempFolder folder;
    const std::string bytes(kClaimingPng.begin(), kClaimingPng.end());
    test::expectRefused(readImage(folder.write("a.png", bytes)), "claims 16000x16000");
}

TEST(ImageFile, APngThatIsCutOffAnywhereIsRefusedBeforeItIsDecoded) {
    const TempFolder folder;
    ASSERT_TRUE(writeImage(folder.path() / "a.png", makeRamp(4, 4, 3)));
    const std::string whole = readAll(folder.path() / "a.png");
    for (size_t size = 8; size < whole.size(); ++size) {
        const fs::path cut = folder.write("b.png", whole.substr(0, size));
        test::expectRefused(readImage(cut), "the PNG is cut off");
    }
}

/// The file with 32 bits changed, `offset` bytes after `name`.
std::string replaceInExr(std::string exr, const std::string& name, size_t offset, uint32_t value) {
    const size_t place = exr.find(name);
    EXPECT_NE(place, std::string::npos);
    for (size_t i = 0; i < 4; ++i)
        exr[place + name.size() + offset + i] = char(value >> (8 * i));
    return exr;
}

TEST(ImageFile, AnExrThatDeclaresMoreThanItHoldsIsRefused) {
    using namespace std::string_literals;
    const TempFolder folder;
    ASSERT_TRUE(writeImage(folder.path() / "a.exr", makeRamp(4, 4, 3)));
    const std::string whole = readAll(folder.path() / "a.exr");
    const auto refuse = [&](const std::string& exr, const char* mention) {
        test::expectRefused(readImage(folder.write("b.exr", exr)), mention);
    };
    // After name, type and size.
    const std::string window = "dataWindow\0box2i\0\x10\0\0\0"s;
    refuse(replaceInExr(whole, "channels\0chlist\0"s, 0, 0x7FFFFFF0), "'channels' is longer");
    refuse(replaceInExr(whole, "dataWindow\0box2i"s, 1, 17), "not of its type's size");
    refuse(replaceInExr(whole, "channels\0chlist"s, 1, 20), "not of its type's size");
    refuse(replaceInExr(whole, window, 8, 0x7FFFFFF0), "too large");
    refuse(replaceInExr(whole, window, 8, uint32_t(-5)), "no pixels");
    refuse(replaceInExr(whole, "\x76\x2F\x31\x01"s, 0, 0x1002), "an EXR of many parts");
    refuse(replaceInExr(whole, "\x76\x2F\x31\x01"s, 0, 0x802), "a deep EXR");
    for (size_t size = 8; size < whole.find(window); size += 7)
        EXPECT_FALSE(readImage(folder.write("b.exr", whole.substr(0, size)))) << size;
    std::string tiled = whole;
    tiled.insert(tiled.find("compression"), "tiles\0tiledesc\0\x09\0\0\0\1\0\0\0\1\0\0\0\0"s);
    tiled = replaceInExr(tiled, window, 8, 60000);
    refuse(tiled, "it claims 240004 tiles of 1x1 pixels");
}

/// An EXR of 4x4 pixels at 0,0 whose display window is another one.
fs::path writeInDisplay(const TempFolder& folder, const std::array<int, 4>& corners) {
    using namespace std::string_literals;
    const fs::path path = folder.path() / "display.exr";
    EXPECT_TRUE(writeImage(path, makeRamp(4, 4, 3)));
    std::string exr = readAll(path);
    for (size_t i = 0; i < corners.size(); ++i)
        exr = replaceInExr(exr, "displayWindow\0box2i\0\x10\0\0\0"s, 4 * i, uint32_t(corners[i]));
    return folder.write("display.exr", exr);
}

TEST(ImageFile, AnExrStatesWhereItsPixelsLie) {
    const TempFolder folder;
    const auto read = test::valueOf(readStoredImage(writeInDisplay(folder, {-3, 2, 8, 9})));
    EXPECT_EQ(read.data, (PixelWindow{0, 0, 4, 4}));
    EXPECT_EQ(read.display, (PixelWindow{-3, 2, 12, 8}));
    EXPECT_EQ(read.pixelAspect, 1.0f);
    ASSERT_TRUE(writeImage(folder.path() / "a.png", makeRamp(4, 3, 3)));
    const auto png = test::valueOf(readStoredImage(folder.path() / "a.png"));
    EXPECT_EQ(png.data, (PixelWindow{0, 0, 4, 3}));
    EXPECT_EQ(png.display, png.data);
}

TEST(ImageFile, PixelsOutsideTheDisplayWindowAreCroppedAway) {
    const TempFolder folder;
    const image::Image whole = makeRamp(4, 4, 3);
    const auto crop = [&](const std::array<int, 4>& corners) {
        StoredImage stored = test::valueOf(readStoredImage(writeInDisplay(folder, corners)));
        cropToDisplay(stored);
        EXPECT_EQ(stored.image.width, stored.data.width);
        EXPECT_EQ(stored.image.height, stored.data.height);
        EXPECT_EQ(stored.image.pixels.size(), size_t(stored.data.width) * stored.data.height * 3);
        return stored;
    };
    EXPECT_EQ(crop({-1, -1, 9, 9}).image.pixels, whole.pixels) << "all of it is inside";
    const StoredImage inner = crop({1, 2, 2, 2});
    EXPECT_EQ(inner.data, (PixelWindow{1, 2, 2, 1}));
    for (uint32_t x = 0; x < 2; ++x)
        for (uint32_t c = 0; c < 3; ++c)
            EXPECT_EQ(inner.image.at(x, 0, c), whole.at(x + 1, 2, c));
    EXPECT_EQ(crop({3, 3, 9, 9}).data, (PixelWindow{3, 3, 1, 1}));
    EXPECT_TRUE(crop({4, 0, 9, 9}).image.pixels.empty()) << "next to it";
    EXPECT_TRUE(crop({-9, -9, -1, 9}).image.pixels.empty());
}

TEST(ImageFile, ImagesAreReadByContentInKnownFormatsOnly) {
    const TempFolder folder;
    const fs::path exr = folder.path() / "a.exr";
    ASSERT_TRUE(writeImage(exr, makeRamp(2, 2, 3)));
    fs::rename(exr, folder.path() / "a.png");
    EXPECT_TRUE(readImage(folder.path() / "a.png"));
    test::expectRefused(
        readImage(folder.write("a.ppm", "P6\n1 1\n255\nabc")), "neither PNG, JPEG, EXR nor HDR"
    );
    using namespace std::string_literals;
    const std::string flat = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81"s;
    EXPECT_EQ(test::errorOf(readImage(folder.write("a.hdr", flat))), "");
}

TEST(ImageFile, APngHoldsItsTextsAndThePictureIsTheSame) {
    const TempFolder folder;
    const image::Image ramp = makeRamp(9, 4, 3);
    const std::string settings = "{\"version\":1,\"method\":\"truth\"}";
    const PictureText texts[] = {{"Settings", settings}, {"Title", "rally, 1.5 s"}};
    ASSERT_TRUE(writePngWithTexts(folder.path() / "a.png", ramp, texts).ok());
    ASSERT_TRUE(writeImage(folder.path() / "b.png", ramp).ok());
    const std::string bytes = readAll(folder.path() / "a.png");
    for (const PictureText& one : texts)
        EXPECT_NE(bytes.find(one.key + '\0' + one.text), std::string::npos) << one.key;
    EXPECT_EQ(
        test::valueOf(readImage(folder.path() / "a.png")).pixels,
        test::valueOf(readImage(folder.path() / "b.png")).pixels
    );
}

} // namespace

} // namespace shutter::io
