// SPDX-License-Identifier: MIT
// Sentences that reach a host in C name its own fields, with the meaning that they have there.
#include "engine/core/setting_row.h"
#include "modules/motion_blur/c_interface/field_names.h"
#include "modules/motion_blur/settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace shutter::motion_blur {
namespace {

namespace fs = std::filesystem;

const fs::path kModule = fs::path(SHUTTER_SOURCE_DIR) / "modules/motion_blur";

std::string readFile(const fs::path& file) {
    std::ifstream stream(file);
    EXPECT_TRUE(stream) << file;
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Words of two or more parts, as fields are named.
std::vector<std::string> listNames(const std::string& text) {
    static const std::regex kName("\\b[a-z]+[a-z0-9]*[A-Z]\\w*");
    std::vector<std::string> names;
    for (std::sregex_iterator at(text.begin(), text.end(), kName), end; at != end; ++at)
        names.push_back(at->str());
    return names;
}

/// The texts of a source, each of neighbouring literals.
std::vector<std::string> listTexts(const fs::path& file) {
    static const std::regex kTexts("(\"(?:[^\"\\\\\\n]|\\\\.)*\"\\s*)+");
    static const std::regex kJoint("\"\\s*\"");
    std::string source;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
        if (!line.starts_with("#include") && line.find("root[\"") == std::string::npos)
            source += line.substr(0, line.find("//")) + "\n";
    std::vector<std::string> texts;
    for (std::sregex_iterator at(source.begin(), source.end(), kTexts), end; at != end; ++at)
        texts.push_back(std::regex_replace(at->str(), kJoint, ""));
    return texts;
}

TEST(CNames, AreThoseOfTheHeaderWithTheMeaningThere) {
    const auto expect = [](const char* inCpp, const char* inC) { EXPECT_EQ(nameForC(inCpp), inC); };
    expect("set vectors.haveCamera = false", "set vectorsLackCamera = true");
    expect("set vectors.haveCamera = true", "set vectorsLackCamera = false");
    expect("set vectors.haveJitter = true", "set vectorsHaveJitter = true");
    expect("for linear depth set depth.isRaw = false", "for linear depth set depthIsLinear = true");
    expect(
        "convention.depth.isRaw is true, which needs convention.cameras, and their areGiven is "
        "false",
        "depthIsLinear is false, which needs cameras, and their areGiven is false"
    );
    expect(
        "motionDepth.image is null, and so are convention.vectors.image.image and "
        "convention.depth.image.image",
        "motionDepth.image is null, and so are vectors.image and depth.image"
    );
    expect("convention.scales.camera is 17", "cameraScale is 17");
    expect("convention.scales.exposureShare is -1", "exposureShare is -1");
    expect("scales.camera is not scales.object", "cameraScale is not objectScale");
    expect(
        "after a cut set scales.isCut, and motion.followsLast = false",
        "after a cut set isCut, and followsLast = false"
    );
    expect("motion.movers[3].worldFromObject, of row 7", "movers[3].worldFromObject, of row 7");
    expect("HostDevice::physical is null", "ShutterBlurDevice::physical is null");
    expect(
        "the method hybrid needs rays: reveal.record is empty, and HostDevice::rayTier was none",
        "the method hybrid needs rays: recordReveal is null"
    );
    expect("call markDone if it", "call shutterBlurMarkDone if it");
    expect("convention.vectors.image.format is", "vectors.format is");
    expect("set depth.metresPerUnit = 0.01", "set metresPerUnit = 0.01");
}

TEST(CNames, WordsOfASentenceAndWhatIsQuotedStayAsTheyAre) {
    for (const char* text :
         {"",
          "motion blur: the camera's motion.",
          "motion blur dump: '/tmp/motion.keys/scales.camera' holds a dump already",
          "'convention.depth'",
          "emotion.keys",
          "my_scales.isCut"})
        EXPECT_EQ(nameForC(text), text);
}

TEST(CNames, NoSentenceOfTheInterfaceKeepsAnotherName) {
    const std::string header = readFile(kModule / "c_interface/shutter_motion_blur.h");
    const std::vector<std::string> inHeader = listNames(header);
    std::set<std::string> known(inHeader.begin(), inHeader.end());
    for (const auto& row : listSettingRows())
        known.insert(std::string(row.name));
    // Vulkan's, and matrices by what they lead from.
    known.insert({"apiVersion", "maxImageDimension2D"});
    // What only a host in C++ can come to: rays through tables, and a response on the device.
    const std::set<std::string> cppAlone{
        "frameConstants",
        "tlasBuffer",
        "sceneLayout",
        "rayTier",
        "knotCount",
        "firstKnots",
        "fillFirstKnots",
        "secondRaster"};
    size_t count = 0;
    for (const fs::directory_entry& file : fs::directory_iterator(kModule / "embedding")) {
        const std::string name = file.path().filename().string();
        const bool isOfSentences = file.path().extension() == ".cpp" &&
                                   !name.starts_with("dump_") && name != "host_dump.cpp" &&
                                   name != "host_features.cpp" && name != "host_preparation.cpp";
        if (!isOfSentences)
            continue;
        for (const std::string& text : listTexts(file.path())) {
            // A field is named where the sentence is made, and a plural.
            const std::string made = std::regex_replace(
                std::regex_replace(text, std::regex("([A-Za-z])\\{[^}]*\\}"), "$1"),
                std::regex("\\{[^}]*\\}"),
                "N"
            );
            const std::string told = nameForC(made);
            ++count;
            EXPECT_EQ(told.find("convention."), std::string::npos) << name << ": " << told;
            EXPECT_EQ(told.find("scales."), std::string::npos) << name << ": " << told;
            EXPECT_FALSE(std::regex_search(told, std::regex("\\bmotion\\.[A-Za-z]"))) << told;
            EXPECT_FALSE(std::regex_search(told, std::regex("\\bHost[A-Z]\\w*"))) << told;
            for (const std::string& word : listNames(told))
                EXPECT_TRUE(known.contains(word) || cppAlone.contains(word))
                    << name << ": " << word << " in " << told;
        }
    }
    EXPECT_GT(count, 200u) << "the sources were not read";
}

} // namespace
} // namespace shutter::motion_blur
