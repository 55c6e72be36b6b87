// SPDX-License-Identifier: MIT
// What a host is compiled against: names in C, structures in their places, features of a device.
#include "engine/core/setting_row.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "modules/motion_blur/embedding/host_features.h"
#include "modules/motion_blur/settings.h"
#include "tests/support/shader_modules.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cstddef>
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

TEST(HostSentences, NameNoFieldThatThePublicHeaderLacks) {
    const std::string header = readFile(kModule / "c_interface/shutter_motion_blur.h");
    const std::vector<std::string> inHeader = listNames(header);
    std::set<std::string> known(inHeader.begin(), inHeader.end());
    for (const auto& row : listSettingRows())
        known.insert(std::string(row.name));
    // Vulkan's names, and matrices by their source space.
    known.insert({"apiVersion", "maxImageDimension2D"});
    // Rays through tables and a response on the device, which the tree alone gives.
    const std::set<std::string> internal{
        "frameConstants",
        "tlasBuffer",
        "sceneLayout",
        "rayTier",
        "knotCount",
        "firstKnots",
        "fillFirstKnots",
        "secondRaster"};
    size_t count = 0;
    for (const fs::directory_entry& file :
         fs::recursive_directory_iterator(kModule / "embedding")) {
        const std::string name = file.path().filename().string();
        const bool isOfSentences = file.path().extension() == ".cpp" &&
                                   !name.starts_with("dump_") && name != "host_dump.cpp" &&
                                   name != "host_features.cpp" && name != "host_preparation.cpp";
        if (!isOfSentences)
            continue;
        for (const std::string& text : listTexts(file.path())) {
            // A field is named where the sentence is made, and a plural.
            const std::string reported = std::regex_replace(
                std::regex_replace(text, std::regex("([A-Za-z])\\{[^}]*\\}"), "$1"),
                std::regex("\\{[^}]*\\}"),
                "N"
            );
            ++count;
            EXPECT_EQ(reported.find("convention."), std::string::npos) << name << ": " << reported;
            EXPECT_EQ(reported.find("scales."), std::string::npos) << name << ": " << reported;
            EXPECT_FALSE(std::regex_search(reported, std::regex("\\bmotion\\.(?!response)[A-Za-z]"))
            ) << reported;
            EXPECT_FALSE(std::regex_search(reported, std::regex("\\bHost[A-Z]\\w*"))) << reported;
            for (const std::string& word : listNames(reported))
                EXPECT_TRUE(known.contains(word) || internal.contains(word))
                    << name << ": " << word << " in " << reported;
        }
    }
    EXPECT_GT(count, 200u) << "the sources were not read";
}

TEST(CStructures, StructuresInArraysAndNestedOnesNeverGrow) {
    static_assert(sizeof(void*) == 8, "the sizes are those of 64-bit hosts");
    EXPECT_EQ(sizeof(ShutterBlurValue), 16u);
    EXPECT_EQ(sizeof(ShutterBlurCameraKey), 264u);
    EXPECT_EQ(sizeof(ShutterBlurMover), 16u);
    EXPECT_EQ(sizeof(ShutterBlurPassTime), 24u);
    EXPECT_EQ(sizeof(ShutterBlurCounter), 16u);
    EXPECT_EQ(sizeof(ShutterBlurUse), 24u);
    EXPECT_EQ(sizeof(ShutterBlurImage), 96u);
    EXPECT_EQ(sizeof(ShutterBlurCameras), 552u);
    EXPECT_EQ(sizeof(ShutterBlurRevealTarget), 16u);
    EXPECT_EQ(sizeof(ShutterBlurViewModel), 144u);
    EXPECT_EQ(sizeof(ShutterBlurEntity), 32u);
}

#define EXPECT_IN_PLACE(type, field, offset)                                                       \
    EXPECT_EQ(offsetof(type, structBytes), 0u);                                                    \
    EXPECT_EQ(offsetof(type, field), size_t{offset}) << "a field before it has changed"

TEST(CStructures, StructuresWithASizeFieldKeepTheirFieldsInPlace) {
    EXPECT_IN_PLACE(ShutterBlurDevice, messageUser, 80);
    EXPECT_IN_PLACE(ShutterBlurSettings, preset, 32);
    EXPECT_IN_PLACE(ShutterBlurRevealTask, entityId, 104);
    EXPECT_IN_PLACE(ShutterBlurSampleTask, answersBytes, 88);
    EXPECT_IN_PLACE(ShutterBlurBlendedTask, opacity, 104);
    EXPECT_IN_PLACE(ShutterBlurInputs, showsInputs, 1808);
    EXPECT_IN_PLACE(ShutterBlurInputs, lastDeformedMotion, 1928);
    EXPECT_IN_PLACE(ShutterBlurInputs, blendedOpacityInAlpha, 2160);
    EXPECT_IN_PLACE(ShutterBlurReport, droppedQuality, 40);
    EXPECT_IN_PLACE(ShutterBlurPlan, moverCount, 52);
    EXPECT_IN_PLACE(ShutterBlurPlan, blendedPixels, 64); // not in the padding before it
    EXPECT_IN_PLACE(ShutterBlurMemory, bytes, 8);
}

TEST(HostFeatures, BringWhatShadersThatTraceNoRaysNeed) {
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    ASSERT_TRUE(addHostFeatures(features).ok());
    size_t count = 0;
    for (const auto& module : test::readShaderModules(SHUTTER_BUILD_DIR, "motion_blur")) {
        const auto capabilities = gpu::reflectNeeds(module.words).capabilities;
        constexpr uint32_t kRayTracing = 4479, kRayQuery = 4472;
        constexpr uint32_t kRuntimeDescriptorArray = 5302; // the textures of what rays meet
        if (capabilities.contains(kRayTracing) || capabilities.contains(kRayQuery) ||
            capabilities.contains(kRuntimeDescriptorArray))
            continue;
        ++count;
        for (const std::string& lacking :
             test::findLacking(module, {features.features, v12, v13, gpu::RayTier::None}))
            ADD_FAILURE() << lacking;
    }
    EXPECT_GT(count, 20u) << "the shaders were not found";
}

} // namespace
} // namespace shutter::motion_blur
