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

using nlohmann::json;

class CliCompare : public Cli {
  protected:
    CliCompare() { compareHere(); }

    void writePicture(
        const std::string& name,
        uint32_t channels,
        float value,
        const std::vector<std::string>& channelNames = {},
        uint32_t size = 16
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
        image::Image image = read(from);
        for (size_t i = channel; i < image.pixels.size(); i += image.channels)
            image.pixels[i] = value;
        ASSERT_TRUE(io::writeImage(path(name), image));
    }

    /// An EXR of 16x16 pixels with other bytes in an attribute, which is named with its type and
    /// size.
    void writeWith(const std::string& name, const std::string& attribute, const std::string& bytes)
        const {
        writePicture(name, 3, 0.5f);
        std::string exr = readFile(name);
        const size_t place = exr.find(attribute);
        ASSERT_NE(place, std::string::npos);
        writeFile(name, exr.replace(place + attribute.size(), bytes.size(), bytes));
    }

    /// 16x16 pixels at 0,0 of an EXR whose display window has these corners.
    void writeInDisplay(const std::string& name, const std::array<int32_t, 4>& corners) const {
        std::string bytes;
        for (size_t i = 0; i < 16; ++i)
            bytes += char(uint32_t(corners[i / 4]) >> (8 * (i % 4)));
        writeWith(name, std::string("displayWindow\0box2i\0\x10\0\0\0", 24), bytes);
    }

    [[nodiscard]] image::Image read(const std::string& name) const {
        auto picture = io::readImage(path(name));
        EXPECT_TRUE(picture.ok()) << (picture.ok() ? "" : picture.error().message);
        return picture.ok() ? std::move(picture).value() : image::Image(16, 16, 3);
    }

    /// The first channel of a pixel in the middle of an error map.
    [[nodiscard]] float readMap(const std::string& name) const { return read(name).at(3, 4, 0); }

    [[nodiscard]] json compareAsJson(const Arguments& arguments) const {
        return json::parse(expectSuccess(join({"compare", "--json"}, arguments)).out);
    }

    /// The result has all that `expected` has.
    json expectCompared(const Arguments& arguments, const json& expected) const {
        json result = compareAsJson(arguments);
        for (const auto& [key, value] : expected.items())
            EXPECT_EQ(result.at(key), value) << arguments[0] << " " << arguments[1] << ": " << key;
        return result;
    }
};

} // namespace

TEST_F(CliCompare, PicturesThatCannotBeComparedAreRefusedByName) {
    writePicture("a.png", 3, 0.5f);
    writePicture("b.png", 3, 0.5f, {}, 17);
    writeFile("text.png", "no picture");
    writePicture("a.exr", 3, 0.5f);
    writePicture("depth.exr", 1, 0.5f, {"Z"});
    writePicture("motion.exr", 2, 3.0f, {"motion.x", "motion.y"});
    writePicture("normal.exr", 3, 0.5f, {"N.x", "N.y", "N.z"});
    writeInDisplay("left.exr", {0, 0, 31, 15});
    writeInDisplay("right.exr", {-16, 0, 15, 15});
    writeInDisplay("shifted.exr", {16, 0, 31, 15});
    const std::vector<std::pair<Arguments, Arguments>> refused = {
        {{"a.png", "nosuch.png"}, {"nosuch.png"}},
        {{"nosuch.png", "a.png"}, {"nosuch.png"}},
        {{"a.png", "text.png"}, {"text.png"}},
        {{"a.png", "."}, {"."}},
        {{"a.png", "b.png", "--out", "heat.png"}, {"a.png", "16x16", "b.png", "17x17"}},
        {{"a.exr", "depth.exr", "--linear"},
         {"a.exr", "depth.exr", "the channels R, G, B", "Z", "none that both have"}},
        {{"motion.exr", "motion.exr"}, {"motion.exr", "--linear"}},
        {{"normal.exr", "normal.exr"}, {"normal.exr", "--linear"}},
        {{"depth.exr", "depth.exr"}, {"depth.exr", "--linear"}},
        {{"left.exr", "right.exr"}, {"left.exr", "0,0 to 15,15", "right.exr", "16,0 to 31,15"}},
        {{"left.exr", "a.exr"}, {"32x16", "16x16"}},
        {{"shifted.exr", "shifted.exr"}, {"no pixels in its display"}},
        {{"a.png", "a.png", "--out", "nosuch/heat.png"}, {"--out", "nosuch/heat.png"}},
        {{"a.png", "a.png", "--out", "heat.bmp"}, {"--out", "heat.bmp"}},
        {{"a.exr", "a.exr", "--map", "flip", "--linear", "--out", "m.png"}, {"--map", "a.exr"}}};
    for (const auto& [arguments, mentions] : refused)
        expectRefusal(join({"compare"}, arguments), kFailed, mentions);
}

TEST_F(CliCompare, OptionsWithoutMeaningAreRefused) {
    const std::vector<std::pair<Arguments, Arguments>> refused = {
        {{"--tonemap", "aces"}, {"--tonemap", "aces"}},
        {{"--ev", "33"}, {"--ev"}},
        {{"--ev", "nan"}, {"--ev"}},
        {{"--linear", "--ev", "1"}, {"--linear", "--ev"}},
        {{"--linear", "--tonemap", "none"}, {"--linear", "--tonemap"}},
        {{"--map", "heat", "--out", "m.png"}, {"--map", "heat"}},
        {{"--map", "flip"}, {"--map", "--out"}}};
    for (const auto& [options, mentions] : refused)
        expectRefusal(join({"compare", "a.exr", "a.exr"}, options), kUsage, mentions);
}

TEST_F(CliCompare, EqualPicturesAreEqual) {
    writePicture("a.png", 3, 0.5f);
    EXPECT_EQ(
        expectSuccess({"compare", "a.png", "a.png"}).out,
        "PSNR inf dB  SSIM 1.0000  FLIP 0.0000  (display values as stored)\n"
    );
    expectCompared(
        {"a.png", "a.png"},
        {{"equal", true},
         {"psnr_db", nullptr},
         {"ssim", 1.0},
         {"flip", 0.0},
         {"values", "display"},
         {"tonemap", nullptr},
         {"max_difference", 0.0}}
    );
}

TEST_F(CliCompare, GreyIsTheColourOfThreeEqualChannels) {
    writePicture("grey.png", 1, 0.5f);
    writePicture("colour.png", 3, 0.5f);
    writePicture("other.png", 3, 0.6f);
    writePicture("grey.exr", 1, 3.0f);
    writePicture("colour.exr", 3, 3.0f);
    writePicture("alpha.exr", 2, 1.0f, {"Y", "A"});
    writePicture("white.exr", 3, 1.0f);
    expectCompared({"grey.png", "colour.png"}, {{"equal", true}});
    expectCompared({"colour.png", "grey.png"}, {{"equal", true}});
    expectCompared({"grey.png", "other.png"}, {{"equal", false}});
    expectCompared({"grey.exr", "colour.exr", "--linear"}, {{"equal", true}});
    expectCompared({"alpha.exr", "white.exr"}, {{"equal", true}});
}

TEST_F(CliCompare, AlphaCountsAndAPictureWithoutIsOpaque) {
    writePicture("opaque.exr", 4, 1.0f, {"R", "G", "B", "A"});
    writePicture("plain.exr", 3, 1.0f);
    writeChanged("clear.exr", "opaque.exr", 3, 0.25f);
    expectCompared({"opaque.exr", "plain.exr"}, {{"equal", true}});
    const json differs = {
        {"equal", false}, {"other_channels", {{"A", 0.75}}}, {"psnr_db", nullptr}};
    for (const char* other : {"opaque.exr", "plain.exr"}) {
        expectCompared({"clear.exr", other}, differs);
        expectCompared({"clear.exr", other, "--linear"}, differs);
    }
    expectPrinted(
        {"compare", "clear.exr", "opaque.exr"},
        {"\nA differs by up to 0.75, which no metric is of\n"}
    );
}

TEST_F(CliCompare, ChannelsBesidesTheColourAreComparedOrNamed) {
    writePicture("a.exr", 5, 0.5f, {"R", "G", "B", "Z", "motion.x"});
    writeChanged("b.exr", "a.exr", 3, 7.0f);
    writePicture("plain.exr", 3, 0.5f);
    expectCompared(
        {"a.exr", "b.exr"},
        {{"equal", false},
         {"max_difference", 0.0},
         {"other_channels", {{"Z", 6.5}, {"motion.x", 0.0}}},
         {"notes", json::array()}}
    );
    const json notes = json::array({"only 'a.exr' has Z, motion.x, which are left out"});
    expectCompared({"a.exr", "plain.exr"}, {{"equal", true}, {"notes", notes}});
    expectPrinted({"compare", "plain.exr", "a.exr"}, {"only 'a.exr' has Z, motion.x"});
}

TEST_F(CliCompare, ChannelsAreMatchedByNameWhateverTheirOrder) {
    image::Image picture(16, 16, 2);
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 2 == 0 ? 3.0f : 40.0f;
    picture.channelNames = {"motion.x", "motion.y"};
    ASSERT_TRUE(io::writeImage(path("a.exr"), picture));
    picture.channelNames = {"motion.y", "motion.x"};
    ASSERT_TRUE(io::writeImage(path("b.exr"), picture));
    expectCompared({"a.exr", "b.exr", "--linear"}, {{"max_difference", 37.0}});
}

TEST_F(CliCompare, ValuesAreComparedAsStoredWhateverTheirSize) {
    for (const auto& [name, value] :
         {std::pair{"five.exr", 5.0f},
          {"fifty.exr", 50.0f},
          {"left.exr", -9.0f},
          {"far.exr", -90.0f}})
        writePicture(name, 2, value, {"motion.x", "motion.y"});
    const json far = expectCompared(
        {"five.exr", "fifty.exr", "--linear"},
        {{"equal", false}, {"max_difference", 45.0}, {"peak", 50.0}} // the reference's
    );
    EXPECT_NEAR(far.at("psnr_db").get<double>(), 20.0 * std::log10(50.0 / 45.0), 1e-9);
    EXPECT_LT(far.at("ssim").get<double>(), 0.5);
    const json back = expectCompared({"left.exr", "far.exr", "--linear"}, {{"equal", false}});
    EXPECT_NEAR(back.at("psnr_db").get<double>(), 20.0 * std::log10(90.0 / 81.0), 1e-9);
    const std::string text = expectPrinted(
        {"compare", "five.exr", "fifty.exr", "--linear"},
        {"(values as stored of motion.x, motion.y, peak 50)"}
    );
    EXPECT_EQ(text.find("inf"), std::string::npos) << text;

    writePicture("a.exr", 3, 0.5f);
    writePicture("b.exr", 3, 0.6f);
    const json colors = expectCompared(
        {"a.exr", "b.exr", "--linear"},
        {{"equal", false},
         {"flip", nullptr}, // it models what a display shows
         {"values", "stored"},
         {"tonemap", nullptr}}
    );
    EXPECT_NEAR(colors.at("psnr_db").get<double>(), 20.0, 1e-4);
    EXPECT_NEAR(colors.at("max_difference").get<double>(), 0.1, 1e-6);
    EXPECT_LT(colors.at("ssim").get<double>(), 1.0);
    const std::string linear =
        expectPrinted({"compare", "a.exr", "b.exr", "--linear"}, {"as stored"});
    EXPECT_EQ(linear.find("FLIP"), std::string::npos) << linear;
    for (const char* name : {"five.exr", "a.exr"})
        expectCompared({name, name, "--linear"}, {{"equal", true}});
}

TEST_F(CliCompare, LightThatADisplayClipsIsReported) {
    writePicture("a.exr", 3, 5.0f);
    writePicture("b.exr", 3, 50.0f);
    const json result = expectCompared(
        {"a.exr", "b.exr", "--tonemap", "none"},
        {{"equal", false}, {"max_difference", 0.0}, {"stored_max_difference", 45.0}}
    );
    EXPECT_EQ(result.at("notes").size(), 1u);
    expectPrinted(
        {"compare", "a.exr", "b.exr", "--tonemap", "none"}, {"stored values differ by up to 45"}
    );
    expectCompared({"a.exr", "a.exr"}, {{"stored_max_difference", 0.0}});
}

TEST_F(CliCompare, InfinityEqualsItselfAndEachValueThatIsNotFiniteIsCounted) {
    writePicture("depth.exr", 1, 7.0f, {"Z"});
    writeChanged("sky.exr", "depth.exr", 0, std::numeric_limits<float>::infinity());
    const json notes = json::array({"'sky.exr' has 256 values that are NaN or infinite"});
    expectCompared(
        {"sky.exr", "sky.exr", "--linear", "--out", "same.exr"},
        {{"equal", true}, {"ssim", 1.0}, {"notes", {notes[0], notes[0]}}}
    );
    expectCompared(
        {"sky.exr", "depth.exr", "--linear", "--out", "other.exr"},
        {{"equal", false},
         {"max_difference", nullptr},
         {"psnr_db", 0.0}, // errors of the peak everywhere
         {"ssim", 0.0}}
    );
    EXPECT_EQ(readMap("same.exr"), 0.0f);
    EXPECT_EQ(readMap("other.exr"), 1.0f);
}

TEST_F(CliCompare, PixelsThatAreNotOfBothPicturesAreReported) {
    writePicture("inner.exr", 3, 0.5f, {}, 8);
    writePicture("square.exr", 3, 0.5f);
    writeInDisplay("around.exr", {4, 4, 11, 11});
    writeInDisplay("left.exr", {0, 0, 31, 15});
    writeWith(
        "wide.exr",
        std::string("pixelAspectRatio\0float\0\4\0\0\0", 27),
        std::string("\0\0\0\x40", 4)
    );
    expectCompared(
        {"around.exr", "inner.exr"},
        {{"equal", true},
         {"notes",
          {"of 'around.exr', 192 pixels outside its display window are left out",
           "the display windows begin at 4,4 and 0,0; both are compared from their corners"}}}
    );
    expectCompared(
        {"square.exr", "wide.exr"},
        {{"notes", json::array({"the pixel aspect ratios differ: 1 and 2"})}}
    );
    const json part = expectCompared({"left.exr", "left.exr"}, {{"equal", true}});
    EXPECT_EQ(
        part.at("notes").at(0),
        "of the display windows, 32x16, the pixels 0,0 to 15,15 are there and compared"
    );
}

TEST_F(CliCompare, WholeNumbersThatNoFloatHoldsAreComparedExactly) {
    image::Image ids(16, 16, 1);
    ids.channelNames = {"id"};
    const auto write = [&](const char* name, float id) {
        ids.pixels[0] = id;
        ASSERT_TRUE(io::writeImage(path(name), ids, io::SampleType::Uint));
    };
    write("even.exr", 33554432.0f);    // 2^25
    write("odd.exr", 4294967296.0f);   // stored as one less, the largest
    write("below.exr", 4294967040.0f); // the float below
    expectCompared({"even.exr", "even.exr", "--linear"}, {{"notes", json::array()}});
    const json result = expectCompared(
        {"even.exr", "odd.exr", "--linear"}, {{"max_difference", 4294967295.0 - 33554432.0}}
    );
    EXPECT_EQ(result.at("notes").size(), 1u);
    // No float is one below 2^32.
    expectCompared({"below.exr", "odd.exr", "--linear"}, {{"max_difference", 255.0}});
}

TEST_F(CliCompare, LinearPicturesAreToneMappedAlike) {
    writePicture("a.exr", 3, 0.04f);
    writePicture("b.exr", 3, 0.5f);
    const auto expectMapped = [&](const Arguments& options, double difference, const json& tonemap
                              ) {
        const json result = expectCompared(
            join({"a.exr", "b.exr"}, options), {{"values", "display"}, {"tonemap", tonemap}}
        );
        EXPECT_NEAR(result.at("max_difference").get<double>(), difference, 1e-4);
        return result;
    };
    const auto describe = [](const char* name, double ev) {
        return json{{"operator", name}, {"ev", ev}, {"applied_to", {"a", "b"}}};
    };
    // sRGB alone: 0.22092 and 0.73536.
    const json plain = expectMapped({"--tonemap", "none"}, 0.51444, describe("none", 0.0));
    EXPECT_GT(plain.at("flip").get<double>(), 0.3);
    // Neutral takes 0.04 - 6.25 * 0.04^2 = 0.03 and 0.04 off: sRGB of 0.01 and 0.46.
    expectMapped({}, 0.60852, describe("neutral", 0.0));
    expectMapped({"--tonemap", "none", "--ev", "1"}, 1.0 - 0.31330, describe("none", 1.0));
    expectPrinted(
        {"compare", "a.exr", "b.exr", "--ev", "-1.5"},
        {"(display values, tone map neutral, EV -1.5)"}
    );
    writePicture("layer.exr", 3, 0.5f, {"layer.R", "layer.G", "layer.B"});
    expectCompared({"layer.exr", "layer.exr"}, {{"values", "display"}});
}

TEST_F(CliCompare, ADisplayPictureIsNotToneMappedAndALinearOneBesideItIs) {
    writePicture("linear.exr", 3, 0.5f);
    writePicture("display.png", 3, 0.735357f);
    const json result =
        expectCompared({"linear.exr", "display.png", "--tonemap", "none"}, {{"values", "display"}});
    EXPECT_LT(result.at("max_difference").get<double>(), 0.5 / 255.0);
    EXPECT_EQ(result.at("tonemap").at("applied_to"), json::array({"a"}));
    expectPrinted({"compare", "display.png", "linear.exr"}, {"EV 0 of 'linear.exr' alone"});
    writePicture("other.png", 3, 0.4f);
    EXPECT_EQ(
        compareAsJson({"display.png", "other.png", "--ev", "3"}),
        compareAsJson({"display.png", "other.png", "--linear"})
    );
}

TEST_F(CliCompare, TheErrorMapIsBlackWhereEqualAndBrightWhereNot) {
    writePicture("a.png", 3, 0.0f);
    writePicture("b.png", 3, 1.0f);
    const auto map = [&](const std::string& name, const Arguments& more = {}) {
        expectSuccess(join({"compare", "a.png", "b.png", "--out", name}, more));
        return read(name);
    };
    const image::Image colors = map("flip.png");
    EXPECT_EQ(colors.width, 16u);
    EXPECT_GT(colors.at(3, 4, 0), 0.95f) << "magma ends in pale yellow";
    EXPECT_NEAR(colors.at(3, 4, 2), 0.7f, 0.06f);
    const image::Image errors = map("flip.exr");
    ASSERT_EQ(errors.channels, 1u) << "an EXR holds the errors themselves";
    const double flip = compareAsJson({"a.png", "b.png"}).at("flip").get<double>();
    EXPECT_NEAR(double(errors.at(3, 4, 0)), flip, 1e-6);
    const image::Image heat = map("heat.exr", {"--map", "difference"});
    ASSERT_EQ(heat.channels, 3u);
    EXPECT_EQ(heat.at(3, 4, 2), 1.0f);
    expectSuccess({"compare", "a.png", "a.png", "--out", "equal.exr"});
    EXPECT_EQ(readMap("equal.exr"), 0.0f);
    // A picture of NaNs is the worst, and no reason for invalid JSON.
    writePicture("a.exr", 3, 0.5f);
    writePicture("nan.exr", 3, std::numeric_limits<float>::quiet_NaN());
    expectCompared(
        {"a.exr", "nan.exr", "--out", "flip.exr"},
        {{"equal", false}, {"flip", 1.0}, {"psnr_db", 0.0}}
    );
    EXPECT_EQ(readMap("flip.exr"), 1.0f);
    expectSuccess({"compare", "a.exr", "nan.exr", "--linear", "--out", "heat.exr"});
    EXPECT_EQ(read("heat.exr").at(3, 4, 2), 1.0f);
}

TEST_F(Cli, TheVersionIsOneLineOfTheProgramsNameAndThreeNumbers) {
    const std::string version = expectSuccess({"--version"}).out;
    EXPECT_TRUE(std::regex_match(version, std::regex("shutter [0-9]+\\.[0-9]+\\.[0-9]+\n")))
        << version;
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
    expectPrinted(
        {"info", "--schema"}, {"\"$schema\"", "tileSizePx", "exposureSeconds", "\"hybrid\""}
    );
}

TEST_F(Cli, InfoListsDevicesWithTheirRays) {
    requireDevice();
    if (IsSkipped())
        return;
    expectPrinted(
        {"info", "--devices"},
        {"0: ", "software", "rays: ", "VK_KHR_ray_query", "VK_KHR_ray_tracing_pipeline"}
    );
}

TEST_F(Cli, InfoCountsWhatASceneHolds) {
    writeFile("points.bin", std::string(36, '\0'));
    writeFile(
        "two.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [4, 0, 0]},
                      {"camera": 0, "name": "eye"}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0},
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
    expectPrinted(
        {"info", "two.gltf"},
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
         "mesh 0: 1 morph target\n"}
    );
}

} // namespace shutter::cli
