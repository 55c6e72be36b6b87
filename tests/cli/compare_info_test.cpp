// SPDX-License-Identifier: MIT
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <utility>

namespace shutter::cli {

namespace {

class CliCompare : public Cli {
  protected:
    void writePicture(
        const std::string& name,
        uint32_t size,
        uint32_t channels,
        float value,
        const std::vector<std::string>& channelNames = {}
    ) const {
        image::Image picture(size, size, channels);
        for (float& pixel : picture.pixels)
            pixel = value;
        picture.channelNames = channelNames;
        const core::Status written = io::writeImage(path(name), picture);
        ASSERT_TRUE(written.ok()) << written.error().message;
    }

    /// `from` with another value in one of its channels.
    void writeChanged(
        const std::string& name, const std::string& from, uint32_t channel, float value
    ) const {
        auto picture = io::readImage(path(from));
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        image::Image& image = picture.value();
        for (size_t i = channel; i < image.pixels.size(); i += image.channels)
            image.pixels[i] = value;
        ASSERT_TRUE(io::writeImage(path(name), image));
    }

    /// 16x16 pixels at 0,0 of an EXR whose display window has these corners.
    void writeInDisplay(const std::string& name, const std::array<int32_t, 4>& corners) const {
        writePicture(name, 16, 3, 0.5f);
        std::string exr = readFile(name);
        const std::string attribute("displayWindow\0box2i\0\x10\0\0\0", 24);
        const size_t place = exr.find(attribute);
        ASSERT_NE(place, std::string::npos);
        for (size_t i = 0; i < 16; ++i)
            exr[place + attribute.size() + i] = char(uint32_t(corners[i / 4]) >> (8 * (i % 4)));
        writeFile(name, exr);
    }

    [[nodiscard]] nlohmann::json compareAsJson(Arguments arguments) const {
        arguments.insert(arguments.begin(), "compare");
        arguments.push_back("--json");
        return nlohmann::json::parse(expectSuccess(arguments).out);
    }
};

} // namespace

TEST_F(CliCompare, AMissingOrDamagedFileIsNamed) {
    writePicture("a.png", 16, 3, 0.5f);
    writeFile("text.png", "no picture");
    expectRefusal({"compare", "a.png", "nosuch.png"}, kFailed, {"nosuch.png"});
    expectRefusal({"compare", "nosuch.png", "a.png"}, kFailed, {"nosuch.png"});
    expectRefusal({"compare", "a.png", "text.png"}, kFailed, {"text.png"});
    expectRefusal({"compare", "a.png", "."}, kFailed, {"."});
}

TEST_F(CliCompare, TwoPicturesAreNeeded) {
    expectRefusal({"compare"}, kUsage, {"a"});
    expectRefusal({"compare", "a.png"}, kUsage, {"b"});
}

TEST_F(CliCompare, PicturesOfTwoSizesAreRefusedWithBoth) {
    writePicture("a.png", 16, 3, 0.5f);
    writePicture("b.png", 17, 3, 0.5f);
    expectRefusal(
        {"compare", "a.png", "b.png", "--out", "heat.png"},
        kFailed,
        {"a.png", "16x16", "b.png", "17x17"}
    );
}

TEST_F(CliCompare, PicturesOfTwoKindsAreRefused) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("b.exr", 16, 1, 0.5f, {"Z"});
    expectRefusal(
        {"compare", "a.exr", "b.exr", "--linear"},
        kFailed,
        {"a.exr", "b.exr", "the channels R, G, B", "Z", "none that both have"}
    );
}

TEST_F(CliCompare, GreyIsTheColourOfThreeEqualChannels) {
    writePicture("grey.png", 16, 1, 0.5f);
    writePicture("colour.png", 16, 3, 0.5f);
    writePicture("other.png", 16, 3, 0.6f);
    EXPECT_EQ(compareAsJson({"grey.png", "colour.png"}).at("equal"), true);
    EXPECT_EQ(compareAsJson({"colour.png", "grey.png"}).at("equal"), true);
    EXPECT_EQ(compareAsJson({"grey.png", "other.png"}).at("equal"), false);
    writePicture("grey.exr", 16, 1, 3.0f);
    writePicture("colour.exr", 16, 3, 3.0f);
    EXPECT_EQ(compareAsJson({"grey.exr", "colour.exr", "--linear"}).at("equal"), true);
    // Grey and alpha, too.
    writePicture("alpha.exr", 16, 2, 1.0f, {"Y", "A"});
    writePicture("white.exr", 16, 3, 1.0f);
    EXPECT_EQ(compareAsJson({"alpha.exr", "white.exr"}).at("equal"), true);
}

TEST_F(CliCompare, AlphaCountsAndAPictureWithoutIsOpaque) {
    const std::vector<std::string> names = {"R", "G", "B", "A"};
    writePicture("opaque.exr", 16, 4, 1.0f, names);
    writePicture("plain.exr", 16, 3, 1.0f);
    writeChanged("clear.exr", "opaque.exr", 3, 0.25f);
    EXPECT_EQ(compareAsJson({"opaque.exr", "plain.exr"}).at("equal"), true);
    for (const auto& more : {Arguments{}, Arguments{"--linear"}})
        for (const char* other : {"opaque.exr", "plain.exr"}) {
            Arguments arguments = {"clear.exr", other};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const auto json = compareAsJson(arguments);
            EXPECT_EQ(json.at("equal"), false) << other;
            EXPECT_EQ(json.at("other_channels").at("A"), 0.75) << other;
            EXPECT_TRUE(json.at("psnr_db").is_null()) << "the colours are equal";
        }
    const std::string text = expectSuccess({"compare", "clear.exr", "opaque.exr"}).out;
    EXPECT_NE(text.find("\nA differs by up to 0.75, which no metric is of\n"), std::string::npos)
        << text;
}

TEST_F(CliCompare, ChannelsBesidesTheColourAreComparedOrNamed) {
    const std::vector<std::string> names = {"R", "G", "B", "Z", "motion.x"};
    writePicture("a.exr", 16, 5, 0.5f, names);
    writeChanged("b.exr", "a.exr", 3, 7.0f);
    writePicture("plain.exr", 16, 3, 0.5f);
    const auto json = compareAsJson({"a.exr", "b.exr"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_EQ(json.at("max_difference"), 0.0);
    EXPECT_EQ(json.at("other_channels"), nlohmann::json({{"Z", 6.5}, {"motion.x", 0.0}}));
    EXPECT_EQ(json.at("notes"), nlohmann::json::array());
    const auto reported = compareAsJson({"a.exr", "plain.exr"});
    EXPECT_EQ(reported.at("equal"), true) << "of what both have";
    EXPECT_EQ(
        reported.at("notes"),
        nlohmann::json::array({"only 'a.exr' has Z, motion.x, which are left out"})
    );
    const std::string text = expectSuccess({"compare", "plain.exr", "a.exr"}).out;
    EXPECT_NE(text.find("only 'a.exr' has Z, motion.x"), std::string::npos) << text;
}

TEST_F(CliCompare, ChannelsAreMatchedByNameWhateverTheirOrder) {
    image::Image picture(16, 16, 2);
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 2 == 0 ? 3.0f : 40.0f;
    picture.channelNames = {"motion.x", "motion.y"};
    ASSERT_TRUE(io::writeImage(path("a.exr"), picture));
    picture.channelNames = {"motion.y", "motion.x"};
    ASSERT_TRUE(io::writeImage(path("b.exr"), picture));
    const auto json = compareAsJson({"a.exr", "b.exr", "--linear"});
    EXPECT_EQ(json.at("max_difference"), 37.0);
}

TEST_F(CliCompare, ValuesOfAnySizeAreCompared) {
    for (const auto& [name, value] :
         {std::pair{"five.exr", 5.0f},
          {"fifty.exr", 50.0f},
          {"left.exr", -9.0f},
          {"far.exr", -90.0f}})
        writePicture(name, 16, 2, value, {"motion.x", "motion.y"});
    const auto json = compareAsJson({"five.exr", "fifty.exr", "--linear"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_EQ(json.at("max_difference"), 45.0);
    EXPECT_EQ(json.at("peak"), 50.0) << "the reference's";
    EXPECT_NEAR(json.at("psnr_db").get<double>(), 20.0 * std::log10(50.0 / 45.0), 1e-9);
    EXPECT_LT(json.at("ssim").get<double>(), 0.5);
    const auto back = compareAsJson({"left.exr", "far.exr", "--linear"});
    EXPECT_EQ(back.at("equal"), false);
    EXPECT_NEAR(back.at("psnr_db").get<double>(), 20.0 * std::log10(90.0 / 81.0), 1e-9);
    const std::string text = expectSuccess({"compare", "five.exr", "fifty.exr", "--linear"}).out;
    EXPECT_NE(text.find("(values as stored of motion.x, motion.y, peak 50)"), std::string::npos)
        << text;
    EXPECT_EQ(text.find("inf"), std::string::npos) << text;
}

TEST_F(CliCompare, LightThatADisplayClipsIsReported) {
    writePicture("a.exr", 16, 3, 5.0f);
    writePicture("b.exr", 16, 3, 50.0f);
    const auto json = compareAsJson({"a.exr", "b.exr", "--tonemap", "none"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_EQ(json.at("max_difference"), 0.0);
    EXPECT_EQ(json.at("stored_max_difference"), 45.0);
    EXPECT_EQ(json.at("notes").size(), 1u);
    const std::string text = expectSuccess({"compare", "a.exr", "b.exr", "--tonemap", "none"}).out;
    EXPECT_NE(text.find("stored values differ by up to 45"), std::string::npos) << text;
    EXPECT_EQ(compareAsJson({"a.exr", "a.exr"}).at("stored_max_difference"), 0.0);
}

TEST_F(CliCompare, InfinityEqualsItselfAndEachValueThatIsNotFiniteIsCounted) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    writePicture("depth.exr", 16, 1, 7.0f, {"Z"});
    writeChanged("sky.exr", "depth.exr", 0, kInfinity);
    const auto same = compareAsJson({"sky.exr", "sky.exr", "--linear"});
    EXPECT_EQ(same.at("equal"), true);
    EXPECT_EQ(same.at("ssim"), 1.0);
    EXPECT_EQ(same.at("notes").at(0), "'sky.exr' has 256 values that are NaN or infinite");
    const auto other = compareAsJson({"sky.exr", "depth.exr", "--linear", "--out", "map.exr"});
    EXPECT_EQ(other.at("equal"), false);
    EXPECT_TRUE(other.at("max_difference").is_null());
    EXPECT_EQ(other.at("psnr_db"), 0.0) << "errors of the peak everywhere";
    EXPECT_EQ(other.at("ssim"), 0.0);
    EXPECT_EQ(io::readImage(path("map.exr")).value().at(3, 4, 0), 1.0f);
    expectSuccess({"compare", "sky.exr", "sky.exr", "--linear", "--out", "map.exr"});
    EXPECT_EQ(io::readImage(path("map.exr")).value().at(3, 4, 0), 0.0f);
}

TEST_F(CliCompare, CropsOfOtherPlacesAreNotOnePicture) {
    writePicture("whole.exr", 16, 3, 0.5f);
    writeInDisplay("left.exr", {0, 0, 31, 15});
    writeInDisplay("right.exr", {-16, 0, 15, 15});
    expectRefusal(
        {"compare", "left.exr", "right.exr"},
        kFailed,
        {"left.exr", "0,0 to 15,15", "right.exr", "16,0 to 31,15"}
    );
    expectRefusal({"compare", "left.exr", "whole.exr"}, kFailed, {"32x16", "16x16"});
    const auto json = compareAsJson({"left.exr", "left.exr"});
    EXPECT_EQ(json.at("equal"), true);
    EXPECT_EQ(
        json.at("notes").at(0),
        "of the display windows, 32x16, the pixels 0,0 to 15,15 are there and compared"
    );
    writeInDisplay("shifted.exr", {16, 0, 31, 15});
    expectRefusal({"compare", "shifted.exr", "shifted.exr"}, kFailed, {"no pixels in its display"});
}

TEST_F(CliCompare, PixelsAroundTheDisplayWindowAreLeftOutAndReported) {
    writePicture("inner.exr", 8, 3, 0.5f);
    writeInDisplay("around.exr", {4, 4, 11, 11});
    const auto json = compareAsJson({"around.exr", "inner.exr"});
    EXPECT_EQ(json.at("equal"), true);
    EXPECT_EQ(
        json.at("notes"),
        nlohmann::json::array(
            {"of 'around.exr', 192 pixels outside its display window are left out",
             "the display windows begin at 4,4 and 0,0; both are compared from their corners"}
        )
    );
}

TEST_F(CliCompare, PixelsOfAnotherShapeAreReported) {
    writePicture("square.exr", 16, 3, 0.5f);
    std::string wide = readFile("square.exr");
    const std::string attribute("pixelAspectRatio\0float\0\4\0\0\0", 27);
    const size_t place = wide.find(attribute);
    ASSERT_NE(place, std::string::npos);
    wide.replace(place + attribute.size(), 4, std::string("\0\0\0\x40", 4));
    writeFile("wide.exr", wide);
    const auto json = compareAsJson({"square.exr", "wide.exr"});
    EXPECT_EQ(json.at("notes"), nlohmann::json::array({"the pixel aspect ratios differ: 1 and 2"}));
}

TEST_F(CliCompare, WholeNumbersThatNoFloatHoldsAreComparedExactly) {
    image::Image ids(16, 16, 1);
    ids.channelNames = {"id"};
    ids.pixels[0] = 33554432.0f; // 2^25
    ASSERT_TRUE(io::writeImage(path("even.exr"), ids, io::SampleType::Uint));
    EXPECT_EQ(compareAsJson({"even.exr", "even.exr", "--linear"}).at("notes").size(), 0u);
    ids.pixels[0] = 4294967296.0f; // stored as one less, the largest
    ASSERT_TRUE(io::writeImage(path("odd.exr"), ids, io::SampleType::Uint));
    const auto json = compareAsJson({"even.exr", "odd.exr", "--linear"});
    EXPECT_EQ(json.at("notes").size(), 1u);
    EXPECT_EQ(json.at("max_difference"), 4294967295.0 - 33554432.0);
    ids.pixels[0] = 4294967040.0f; // the float below
    ASSERT_TRUE(io::writeImage(path("below.exr"), ids, io::SampleType::Uint));
    EXPECT_EQ(compareAsJson({"below.exr", "odd.exr", "--linear"}).at("max_difference"), 255.0)
        << "no float is one below 2^32";
}

TEST_F(CliCompare, AHeatMapThatCannotBeWrittenIsRefused) {
    writePicture("a.png", 16, 3, 0.5f);
    for (const char* out : {"nosuch/heat.png", "heat.bmp"})
        expectRefusal({"compare", "a.png", "a.png", "--out", out}, kFailed, {"--out", out});
}

TEST_F(CliCompare, EqualPicturesAreEqual) {
    writePicture("a.png", 16, 3, 0.5f);
    EXPECT_EQ(
        expectSuccess({"compare", "a.png", "a.png"}).out,
        "PSNR inf dB  SSIM 1.0000  FLIP 0.0000  (display values as stored)\n"
    );
    const auto json = compareAsJson({"a.png", "a.png"});
    EXPECT_EQ(json.at("equal"), true);
    EXPECT_TRUE(json.at("psnr_db").is_null());
    EXPECT_EQ(json.at("ssim"), 1.0);
    EXPECT_EQ(json.at("flip"), 0.0);
    EXPECT_EQ(json.at("values"), "display");
    EXPECT_TRUE(json.at("tonemap").is_null());
    EXPECT_EQ(json.at("max_difference"), 0.0);
}

TEST_F(CliCompare, LinearTakesTheValuesAsTheyAreStored) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("b.exr", 16, 3, 0.6f);
    const auto json = compareAsJson({"a.exr", "b.exr", "--linear"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_NEAR(json.at("psnr_db").get<double>(), 20.0, 1e-4);
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.1, 1e-6);
    EXPECT_LT(json.at("ssim").get<double>(), 1.0);
    EXPECT_TRUE(json.at("flip").is_null()) << "FLIP models what a display shows";
    EXPECT_EQ(json.at("values"), "stored");
    EXPECT_TRUE(json.at("tonemap").is_null());
    const std::string text = expectSuccess({"compare", "a.exr", "b.exr", "--linear"}).out;
    EXPECT_EQ(text.find("FLIP"), std::string::npos) << text;
    EXPECT_NE(text.find("as stored"), std::string::npos) << text;
}

TEST_F(CliCompare, LinearPicturesAreToneMappedAlike) {
    writePicture("a.exr", 16, 3, 0.04f);
    writePicture("b.exr", 16, 3, 0.5f);
    // sRGB alone: 0.22092 and 0.73536.
    auto json = compareAsJson({"a.exr", "b.exr", "--tonemap", "none"});
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.51444, 1e-4);
    EXPECT_EQ(json.at("values"), "display");
    EXPECT_EQ(json.at("tonemap").at("operator"), "none");
    EXPECT_EQ(json.at("tonemap").at("applied_to"), nlohmann::json({"a", "b"}));
    EXPECT_GT(json.at("flip").get<double>(), 0.3);
    // Neutral takes 0.04 - 6.25 * 0.04^2 = 0.03 and 0.04 off: sRGB of 0.01 and 0.46.
    json = compareAsJson({"a.exr", "b.exr"});
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.60852, 1e-4);
    EXPECT_EQ(json.at("tonemap").at("operator"), "neutral");
    EXPECT_EQ(json.at("tonemap").at("ev"), 0.0);
    json = compareAsJson({"a.exr", "b.exr", "--tonemap", "none", "--ev", "1"});
    EXPECT_NEAR(json.at("max_difference").get<double>(), 1.0 - 0.31330, 1e-4);
    EXPECT_EQ(json.at("tonemap").at("ev"), 1.0);
    const std::string text = expectSuccess({"compare", "a.exr", "b.exr", "--ev", "-1.5"}).out;
    EXPECT_NE(text.find("(display values, tone map neutral, EV -1.5)"), std::string::npos) << text;
}

TEST_F(CliCompare, ALinearPictureAgreesWithItsDisplayPicture) {
    writePicture("linear.exr", 16, 3, 0.5f);
    writePicture("display.png", 16, 3, 0.735357f);
    const auto json = compareAsJson({"linear.exr", "display.png", "--tonemap", "none"});
    EXPECT_LT(json.at("max_difference").get<double>(), 0.5 / 255.0);
    EXPECT_EQ(json.at("values"), "display");
    EXPECT_EQ(json.at("tonemap").at("applied_to"), nlohmann::json::array({"a"}));
    const std::string text = expectSuccess({"compare", "display.png", "linear.exr"}).out;
    EXPECT_NE(text.find("EV 0 of 'linear.exr' alone"), std::string::npos) << text;
}

TEST_F(CliCompare, ADisplayPictureIsNotToneMapped) {
    writePicture("a.png", 16, 3, 0.2f);
    writePicture("b.png", 16, 3, 0.4f);
    EXPECT_EQ(
        compareAsJson({"a.png", "b.png", "--ev", "3"}),
        compareAsJson({"a.png", "b.png", "--linear"})
    );
}

TEST_F(CliCompare, NonColourChannelsAreComparedAsStoredOrNotAtAll) {
    writePicture("motion.exr", 16, 2, 3.0f, {"motion.x", "motion.y"});
    writePicture("normal.exr", 16, 3, 0.5f, {"N.x", "N.y", "N.z"});
    writePicture("depth.exr", 16, 1, 7.0f, {"Z"});
    for (const char* name : {"motion.exr", "normal.exr", "depth.exr"}) {
        expectRefusal({"compare", name, name}, kFailed, {name, "--linear"});
        EXPECT_EQ(compareAsJson({name, name, "--linear"}).at("equal"), true);
    }
    writePicture("layer.exr", 16, 3, 0.5f, {"layer.R", "layer.G", "layer.B"});
    EXPECT_EQ(compareAsJson({"layer.exr", "layer.exr"}).at("values"), "display");
}

TEST_F(CliCompare, OptionsWithoutMeaningAreRefused) {
    writePicture("a.exr", 16, 3, 0.5f);
    const Arguments base = {"compare", "a.exr", "a.exr"};
    const auto refuse = [&](const Arguments& more, int status, const Arguments& mentions) {
        Arguments all = base;
        all.insert(all.end(), more.begin(), more.end());
        expectRefusal(all, status, mentions);
    };
    refuse({"--tonemap", "aces"}, kUsage, {"--tonemap", "aces"});
    refuse({"--ev", "33"}, kUsage, {"--ev"});
    refuse({"--ev", "nan"}, kUsage, {"--ev"});
    refuse({"--linear", "--ev", "1"}, kUsage, {"--linear", "--ev"});
    refuse({"--linear", "--tonemap", "none"}, kUsage, {"--linear", "--tonemap"});
    refuse({"--map", "heat", "--out", "m.png"}, kUsage, {"--map", "heat"});
    refuse({"--map", "flip"}, kUsage, {"--map", "--out"});
    refuse({"--map", "flip", "--linear", "--out", "m.png"}, kFailed, {"--map", "a.exr"});
}

TEST_F(CliCompare, APictureOfNansStillGivesValidJsonAndTheWorstMaps) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("nan.exr", 16, 3, std::numeric_limits<float>::quiet_NaN());
    const auto json = compareAsJson({"a.exr", "nan.exr", "--out", "flip.exr"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_EQ(json.at("flip"), 1.0);
    EXPECT_EQ(json.at("psnr_db"), 0.0);
    EXPECT_EQ(io::readImage(path("flip.exr")).value().at(3, 4, 0), 1.0f);
    expectSuccess({"compare", "a.exr", "nan.exr", "--linear", "--out", "heat.exr"});
    EXPECT_EQ(io::readImage(path("heat.exr")).value().at(3, 4, 2), 1.0f);
}

TEST_F(CliCompare, TheErrorMapIsBlackWhereEqualAndBrightWhereNot) {
    writePicture("a.png", 16, 3, 0.0f);
    writePicture("b.png", 16, 3, 1.0f);
    const auto map = [&](const Arguments& more) {
        Arguments arguments = {"compare", "a.png", "b.png", "--out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expectSuccess(arguments);
        auto read = io::readImage(path(more.front()));
        EXPECT_TRUE(read.ok());
        return read.ok() ? std::move(read.value()) : image::Image(16, 16, 3);
    };
    const double flip = compareAsJson({"a.png", "b.png"}).at("flip").get<double>();
    const image::Image colors = map({"flip.png"});
    EXPECT_EQ(colors.width, 16u);
    EXPECT_GT(colors.at(3, 4, 0), 0.95f) << "magma ends in pale yellow";
    EXPECT_NEAR(colors.at(3, 4, 2), 0.7f, 0.06f);
    const image::Image errors = map({"flip.exr"});
    ASSERT_EQ(errors.channels, 1u) << "an EXR holds the errors themselves";
    EXPECT_NEAR(double(errors.at(3, 4, 0)), flip, 1e-6);
    const image::Image heat = map({"heat.exr", "--map", "difference"});
    ASSERT_EQ(heat.channels, 3u);
    EXPECT_EQ(heat.at(3, 4, 2), 1.0f);
    expectSuccess({"compare", "a.png", "a.png", "--out", "equal.exr"});
    EXPECT_EQ(io::readImage(path("equal.exr")).value().at(3, 4, 0), 0.0f);
}

TEST_F(Cli, TheVersionIsOneLineOfTheProgramsNameAndThreeNumbers) {
    const std::string version = expectSuccess({"--version"}).out;
    EXPECT_TRUE(std::regex_match(version, std::regex("shutter [0-9]+\\.[0-9]+\\.[0-9]+\n")))
        << version;
}

TEST_F(Cli, InfoNeedsToKnowWhatAbout) {
    expectRefusal({"info"}, kUsage, {"SCENE", "--devices", "--methods"});
}

TEST_F(Cli, InfoListsTheMethodsOnePerLineAsErrorsNameThem) {
    std::string names = expectSuccess({"info", "--methods"}).out;
    ASSERT_TRUE(
        names.starts_with("sharp\n") &&
        names.ends_with("\nhybrid\nresolved\nadaptive\ndenoised\naccumulate\ntruth\n")
    ) << names;
    names.pop_back();
    for (size_t at = 0; (at = names.find('\n', at)) != std::string::npos;)
        names.replace(at, 1, ", ");
    expectRefusal(
        renderVase({"--out", "a.png", "--method", "nosuch"}), kUsage, {"--method", names}
    );
}

TEST_F(Cli, InfoPrintsTheSchemaOfTheSettings) {
    const std::string schema = expectSuccess({"info", "--schema"}).out;
    for (const char* part : {"\"$schema\"", "tileSizePx", "exposureSeconds", "\"hybrid\""})
        EXPECT_NE(schema.find(part), std::string::npos) << part;
}

TEST_F(Cli, InfoListsDevicesWithTheirRays) {
    requireDevice();
    if (IsSkipped())
        return;
    const std::string out = expectSuccess({"info", "--devices"}).out;
    EXPECT_NE(out.find("0: "), std::string::npos);
    EXPECT_NE(out.find("software"), std::string::npos);
    EXPECT_NE(out.find("rays: "), std::string::npos);
    EXPECT_NE(out.find("VK_KHR_ray_query"), std::string::npos);
    EXPECT_NE(out.find("VK_KHR_ray_tracing_pipeline"), std::string::npos);
}

TEST_F(Cli, InfoCountsWhatASceneHolds) {
    writeFile("points.bin", std::string(36, '\0'));
    writeFile(
        "two.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [4, 0, 0]},
                      {"camera": 0, "name": "eye"}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
            "meshes": [{"name": "face", "primitives": [{"attributes": {"POSITION": 0},
                        "targets": [{"POSITION": 0}]}]}],
            "skins": [{"name": "rig", "joints": [0, 1]}],
            "animations": [{"name": "nod", "samplers": [{"input": 1, "output": 1}], "channels":
                            [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [0, 0, 0]},
                          {"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR",
                           "min": [0], "max": [0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "points.bin"}]})"
    );
    const std::string out = expectSuccess({"info", "two.gltf"}).out;
    for (const char* part :
         {"entities 3",
          "drawn 2",
          "triangles drawn 2",
          "meshes 1",
          "lights 0",
          "bounds 0 0 0 to 4 0 0 m",
          "camera 0: ",
          "eye",
          "clip 0 'nod': 0 s, 1 channel\n",
          "skin rig: 2 joints",
          "mesh face: 1 morph target\n"})
        EXPECT_NE(out.find(part), std::string::npos) << part << "\n" << out;
}

} // namespace shutter::cli
