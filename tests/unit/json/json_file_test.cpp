// SPDX-License-Identifier: MIT
#include "engine/json/json_file.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace shutter::json {
namespace {

using test::TempFolder;

struct Film {
    std::string name;
    double fps = 24.0;
    int64_t count = 0;
    bool loop = false;
    int ease = 0;
    std::vector<double> times;
    std::array<double, 3> place{};
};

constexpr std::array<std::pair<std::string_view, int>, 2> kEases{{{"none", 0}, {"inOut", 1}}};

Film readFilm(JsonNode root) {
    Film film;
    const JsonObject object =
        root.readObject({"name", "fps", "count", "loop", "ease", "keys", "place"});
    film.name = object.require("name").readString(16);
    if (const auto fps = object.find("fps"))
        film.fps = fps->readNumber({.min = 0.0, .max = 1000.0, .isAboveMin = true});
    if (const auto count = object.find("count"))
        film.count = count->readInteger(-3, 7);
    if (const auto loop = object.find("loop"))
        film.loop = loop->readBoolean();
    if (const auto ease = object.find("ease"))
        film.ease = ease->readChoice(kEases);
    if (const auto keys = object.find("keys"))
        for (const JsonNode& key : keys->readArray(1, 3))
            film.times.push_back(key.readObject({"time"}).require("time").readNumber());
    if (const auto place = object.find("place"))
        film.place = place->readNumbers<3>();
    return film;
}

core::Result<Film> parseFilm(const std::string& text) {
    auto document = JsonDocument::parse(text, "film.json");
    if (!document)
        return document.error();
    Film film = readFilm(document.value().root());
    if (core::Status finished = document.value().finish(); !finished)
        return finished.error();
    return film;
}

std::string errorOf(const std::string& text) {
    const auto film = parseFilm(text);
    return film.ok() ? "no error" : film.error().message;
}

std::string nest(size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
}

} // namespace

TEST(JsonFile, EveryKindOfFieldIsReadOrKeepsItsDefaultAndAByteOrderMarkIsSkipped) {
    const auto film =
        test::valueOf(parseFilm(R"({"name": "pan \u00e4", "fps": 29.97, "count": 3.0, "loop": true,
        "ease": "inOut", "keys": [{"time": 0}, {"time": -1.5e1}], "place": [1, 2, 3]})"));
    EXPECT_EQ(film.name, "pan \u00e4");
    EXPECT_EQ(film.fps, 29.97);
    EXPECT_EQ(film.count, 3);
    EXPECT_TRUE(film.loop);
    EXPECT_EQ(film.ease, 1);
    EXPECT_EQ(film.times, (std::vector<double>{0.0, -15.0}));
    EXPECT_EQ(film.place, (std::array<double, 3>{1.0, 2.0, 3.0}));
    EXPECT_EQ(test::valueOf(parseFilm("\xEF\xBB\xBF{\"name\": \"a\"}\r\n")).fps, 24.0);
}

TEST(JsonFile, FieldsOfAnyNamesAreReadInTheirOrder) {
    const auto document = test::valueOf(JsonDocument::parse(R"({"b": 1, "a": null})", "film.json"));
    const auto fields = document.root().readFields();
    ASSERT_EQ(fields.size(), 2u);
    EXPECT_EQ(fields[0].first, "b");
    EXPECT_FALSE(fields[0].second.isNull());
    EXPECT_EQ(fields[1].first, "a");
    EXPECT_TRUE(fields[1].second.isNull());
    EXPECT_TRUE(document.finish());
    EXPECT_TRUE(fields[0].second.readFields().empty());
    EXPECT_EQ(document.finish().error().message, "film.json:1: b: must be an object, not a number");
}

TEST(JsonFile, AWrongFieldIsNamedWithItsLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"{\n\"name\": 3}", "film.json:2: name: must be a string, not a number"},
        {"{}", "film.json:1: the field 'name' is missing"},
        {"\n\n[]", "film.json:3: must be an object, not an array"},
        {"{\"name\": \"a\",\n\n \"speed\": 3\n}",
         "film.json:3: speed: is not a field here; the fields are name, fps, count, loop, ease, "
         "keys, place"},
        {"{\"name\": \"a\", \"keys\": [{\"time\": 0},\n{\"time\":\n12\n}, {\n\"time\":\nnull}]}",
         "film.json:6: keys[2].time: must be a number, not null"},
        {"{\"name\": \"a\", \"keys\": [{\"time\": 0},\n{}]}",
         "film.json:2: keys[1]: the field 'time' is missing"},
        {"{\"name\": \"a\", \"keys\":\n[]}",
         "film.json:2: keys: must have at least 1 element, not 0"},
        {"{\"name\": \"a\", \"keys\": [{}, {}, {}, {}]}",
         "film.json:1: keys: must have at most 3 elements, not 4"},
        {"{\"name\": \"a\", \"place\": [1, 2]}", "film.json:1: place: must have 3 elements, not 2"},
        {"{\"name\": \"a\", \"place\": [1,\n2,\n\"x\"]}",
         "film.json:3: place[2]: must be a number, not a string"},
        {"{\"name\": \"a\", \"fps\": 0}", "film.json:1: fps: must lie in (0, 1000], not 0"},
        {"{\"name\": \"a\", \"fps\": 1001\n}", "film.json:1: fps: must lie in (0, 1000], not 1001"},
        {"{\"name\": \"a\", \"count\": 1.5}",
         "film.json:1: count: must be a whole number, not 1.5"},
        {"{\"name\": \"a\", \"count\": 8}", "film.json:1: count: must lie in [-3, 7], not 8"},
        {"{\"name\": \"a\", \"loop\": 1}",
         "film.json:1: loop: must be true or false, not a number"},
        {"{\"name\": \"a\", \"ease\": \"out\"}",
         "film.json:1: ease: 'out' is not one of none, inOut"},
        {"{\"name\": \"a\", \"ease\": []}", "film.json:1: ease: must be a string, not an array"},
        {"{\"name\": \"12345678901234567\"}", "film.json:1: name: is longer than 16 bytes"},
        // The first of many.
        {"{\"name\": 1, \"fps\": \"x\", \"keys\": 4}",
         "film.json:1: name: must be a string, not a number"},
    };
    for (const auto& [text, error] : cases)
        EXPECT_EQ(errorOf(text), error) << text;
}

TEST(JsonFile, InvalidJsonIsRefusedWithItsLine) {
    const std::pair<std::string, const char*> cases[] = {
        {"", "film.json: the file is empty"},
        {" \n\t\r\n", "film.json: the file is empty"},
        {"\xEF\xBB\xBF", "film.json:1: "},
        {"{\n\"name\": \"a\",\n}", "film.json:3: "},
        {"{\"name\": \"a\"}\n\n{}", "film.json:3: "},
        {"{\"name\": \"a\"\n", "film.json:1: "},
        {"{\"name\": NaN}", "film.json:1: "},
        {"{\"name\": Infinity}", "film.json:1: "},
        {"{\"name\": \"a\", \n\"fps\": 1e999}", "film.json:2: number overflow"},
        {"{\"name\": \"a\", \"name\": \"b\"}", "film.json:1: the field 'name' stands here twice"},
        {"{\"keys\": [{\"time\": 1,\n\"time\": 1}]}",
         "film.json:2: keys[0]: the field 'time' stands here twice"},
        {"{\"name\": \"\xFF\"}", "film.json:1: "},
        {"{\"name\": \"a\nb\"}", "film.json:1: "},
        {"// a remark\n{}", "film.json:1: "},
        {std::string("{\"name\": \"a\"}\n\0 and more", 24), "film.json:2: a NUL byte is not JSON"},
        {nest(33), "film.json:1: the values nest deeper than 32 levels"},
        {nest(10000), "film.json:1: the values nest deeper than 32 levels"},
        {std::string(10000, '['), "film.json:1: the values nest deeper than 32 levels"},
    };
    for (const auto& [text, error] : cases) {
        const std::string message = errorOf(text);
        EXPECT_EQ(message.substr(0, std::string_view(error).size()), error) << text;
        EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
        EXPECT_LT(message.size(), 200u) << message;
    }
    // As deep as it may be: then it is read, and is no object.
    EXPECT_EQ(errorOf(nest(32)), "film.json:1: must be an object, not an array");
}

TEST(JsonFile, LongTextsFromTheFileAreCutInErrors) {
    const std::string text(100000, 'x');
    for (const std::string& file :
         {fmt::format("{{\"{}\": 1}}", text),
          fmt::format("{{\"name\": \"a\", \"ease\": \"{}\"}}", text),
          fmt::format("{{\"{0}\": 1, \"{0}\": 1}}", text),
          fmt::format("{{\"name\": {}}}", text),
          fmt::format("{{\"name\": \"{}", text)})
        EXPECT_LT(errorOf(file).size(), 250u);
    // Not within a character of two bytes.
    std::string umlauts(1, 'x');
    for (int i = 0; i < 100; ++i)
        umlauts += "\u00e4";
    const std::string message =
        errorOf(fmt::format("{{\"name\": \"a\", \"ease\": \"{}\"}}", umlauts));
    EXPECT_NE(message.find("\u00e4...' is not one of"), std::string::npos) << message;
}

TEST(JsonFile, MissingFilesTooManyValuesAndTooManyBytesAreRefused) {
    JsonLimits limits;
    limits.maxValues = 4;
    EXPECT_TRUE(JsonDocument::parse("[1, 2, 3]", "a").ok());
    EXPECT_TRUE(JsonDocument::parse("[1, 2, 3]", "a", limits).ok());
    EXPECT_EQ(
        test::errorOf(JsonDocument::parse("[1, 2, 3,\n4]", "a", limits)),
        "a:2: the file holds more than 4 values"
    );

    const TempFolder folder;
    const auto path = folder.write("a.json", "[1, 2]");
    limits.maxBytes = 6;
    EXPECT_TRUE(JsonDocument::load(path, limits).ok());
    limits.maxBytes = 5;
    EXPECT_EQ(
        test::errorOf(JsonDocument::load(path, limits)),
        path.string() + ": the file is over 5 bytes"
    );
    EXPECT_EQ(
        test::errorOf(readJsonFile("no/such/film.json", readFilm)),
        "cannot open 'no/such/film.json': no such file"
    );
}

TEST(JsonFile, WrittenJsonIsReadBackUnchanged) {
    const TempFolder folder;
    const auto path = folder.path() / "film.json";
    const double fps = 1.0 / 3.0;
    const std::array<double, 3> place{
        -0.0, std::numeric_limits<double>::denorm_min(), 1.0 + 1.0e-15};
    const std::string name = "\"\\\n\u00e4\x01";
    nlohmann::ordered_json content;
    content["name"] = name;
    content["fps"] = fps;
    content["count"] = -3;
    content["loop"] = true;
    content["ease"] = "inOut";
    content["keys"] = nlohmann::ordered_json::array();
    for (const double time : {0.0, 1e-300})
        content["keys"].push_back({{"time", time}});
    content["place"] = place;
    ASSERT_TRUE(writeJsonFile(path, content).ok());
    const auto film = test::valueOf(readJsonFile(path, readFilm));
    EXPECT_EQ(film.name, name);
    EXPECT_EQ(film.fps, fps);
    EXPECT_EQ(film.count, -3);
    EXPECT_EQ(film.times, (std::vector<double>{0.0, 1e-300}));
    EXPECT_EQ(film.place, place);
    EXPECT_TRUE(std::signbit(film.place[0]));
}

TEST(JsonFile, EveryFiniteDoubleAndFloatReadsBackToTheLastBit) {
    std::mt19937_64 random(1);
    std::vector<double> written{
        std::numeric_limits<double>::max(),
        std::numeric_limits<double>::min(),
        std::numeric_limits<double>::lowest(),
        std::numeric_limits<double>::denorm_min(),
        double(std::numeric_limits<float>::max()),
        double(0.1f),
        9007199254740993.0,
        0.1,
        5e-324};
    while (written.size() < 20000) {
        const uint64_t bits = random();
        const auto number = std::bit_cast<double>(bits);
        const auto single = std::bit_cast<float>(uint32_t(bits));
        if (std::isfinite(number))
            written.push_back(number);
        if (std::isfinite(single))
            written.push_back(double(single));
    }
    const auto document = test::valueOf(JsonDocument::parse(formatJson(written), "numbers"));
    const std::vector<JsonNode> read = document.root().readArray();
    ASSERT_EQ(read.size(), written.size());
    for (size_t i = 0; i < read.size(); ++i)
        ASSERT_EQ(
            std::bit_cast<uint64_t>(read[i].readNumber()), std::bit_cast<uint64_t>(written[i])
        ) << written[i];
}

TEST(JsonFile, JsonIsWrittenOneFieldPerLineInOrderAndInvalidUtf8Replaced) {
    nlohmann::ordered_json content;
    content["b"] = {1.0, "x"};
    content["a"] = nlohmann::ordered_json::object();
    content["c"] = -0.0;
    EXPECT_EQ(
        formatJson(content),
        "{\n  \"b\": [\n    1.0,\n    \"x\"\n  ],\n  \"a\": {},\n  \"c\": -0.0\n}\n"
    );
    EXPECT_EQ(formatJsonLine(content), "{\"b\":[1.0,\"x\"],\"a\":{},\"c\":-0.0}\n");
    EXPECT_EQ(formatJson("a\xFF"), "\"a\uFFFD\"\n");
}

TEST(JsonFileDeathTest, ANumberThatIsNotFiniteEndsTheProgram) {
    nlohmann::ordered_json content;
    content["keys"] = {{{"time", 0.0}}, {{"time", std::nan("")}}};
    EXPECT_DEATH((void)formatJson(content), "JSON has no nan");
    EXPECT_DEATH(
        (void)formatJsonLine(-std::numeric_limits<double>::infinity()), "JSON has no -inf"
    );
}

} // namespace shutter::json
