// SPDX-License-Identifier: MIT
// Every field that a host sets, by every method: it changes the picture, it is refused by name, or
// it is stated to have no meaning there. The statements are the tables of
// modules/motion_blur/embedding/fields.md; a field that the header has and they lack fails.
#include "engine/math/transform.h"
#include "tests/gpu/embedding_host.h"
#include "tests/kit/sweep.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

constexpr uint32_t kFieldsWidth = 96;
constexpr uint32_t kFieldsHeight = 64;
constexpr VkExtent2D kFieldsExtent{kFieldsWidth, kFieldsHeight};
constexpr size_t kFieldsPixels = size_t{kFieldsWidth} * kFieldsHeight;

std::string readSource(const char* path) {
    std::ifstream file(std::string(SHUTTER_SOURCE_DIR) + "/" + path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Names of a structure's fields in the C header; those of structures within it with a dot.
std::set<std::string> listFields(const std::string& structure, const std::string& prefix = "") {
    static const std::string kHeader = std::regex_replace(
        readSource("modules/motion_blur/c_interface/shutter_motion_blur.h"),
        std::regex(R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)"),
        ""
    );
    std::smatch body;
    const std::regex pattern("typedef struct " + structure + R"( \{([^}]*)\})");
    if (!std::regex_search(kHeader, body, pattern))
        return {};
    const std::string members = body[1];
    static const std::regex kMember(R"((\w+)[\s*]+(\w+)(\[\d+\])?;)");
    std::set<std::string> names;
    for (std::sregex_iterator at(members.begin(), members.end(), kMember), end; at != end; ++at) {
        const std::string type = (*at)[1];
        const std::string name = prefix + (*at)[2].str();
        if (type == "ShutterBlurCameras" || type == "ShutterBlurLens" ||
            type == "ShutterBlurViewModel")
            names.merge(listFields(type, name + "."));
        else
            names.insert(name);
    }
    return names;
}

/// Rows of the page's tables under a heading: the words of the cells behind the field's name.
std::map<std::string, std::vector<std::string>> readTable(const std::string& heading) {
    std::istringstream page(readSource("modules/motion_blur/embedding/fields.md"));
    std::map<std::string, std::vector<std::string>> rows;
    bool isHere = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("## "))
            isHere = line == "## " + heading;
        if (!isHere || !line.starts_with("| `"))
            continue;
        std::vector<std::string> cells;
        std::istringstream parts(line.substr(1));
        for (std::string cell; std::getline(parts, cell, '|');) {
            const size_t first = cell.find_first_not_of(" `");
            const size_t last = cell.find_last_not_of(" `");
            cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
        }
        const std::string names = cells.front(); // width`, `height
        cells.erase(cells.begin());
        static const std::regex kName("[^`, ]+");
        for (std::sregex_iterator at(names.begin(), names.end(), kName), end; at != end; ++at)
            EXPECT_TRUE(rows.emplace(at->str(), cells).second) << at->str() << " has two rows";
    }
    return rows;
}

std::set<std::string> namesOf(const auto& rows) {
    std::set<std::string> names;
    for (const auto& [name, row] : rows)
        names.insert(name);
    return names;
}

/// A change of one field, and what a refusal's sentence names.
template <class T> struct FieldChange {
    std::function<void(T&)> apply;
    std::string_view named;
};

void copyMatrix(double (&to)[16], const glm::dmat4& matrix) {
    std::memcpy(to, &matrix, sizeof(to));
}

class EmbeddedFields : public test::EmbeddedTest {
  protected:
    using Inputs = ShutterBlurInputs;
    using Changes = std::map<std::string, FieldChange<Inputs>>;

    void SetUp() override {
        EmbeddedTest::SetUp();
        if (!mBlur)
            return;
        ShutterBlurDevice described = test::describeForC(device());
        described.measures = VK_TRUE; // a budget needs it
        mC.emplace(described);
        mOutput.emplace(device(), glm::uvec2(kFieldsWidth, kFieldsHeight));
        paint();
    }

    void TearDown() override {
        mC.reset();
        mOutput.reset();
        EmbeddedTest::TearDown();
    }

    /// Sky above a wall, a square before it that moves, of id 7, and another of id 200.
    void paint() {
        std::vector<uint64_t> color;
        std::vector<uint64_t> halves;
        std::vector<glm::vec2> motion;
        std::vector<glm::vec4> packed;
        std::vector<float> metres;
        std::vector<float> shares(kFieldsPixels, 0.25f);
        std::vector<uint32_t> ids;
        for (uint32_t i = 0; i < kFieldsPixels; ++i) {
            const uint32_t x = i % kFieldsWidth;
            const uint32_t y = i / kFieldsWidth;
            const bool isFront = x >= 30 && x < 60 && y >= 20 && y < 50;
            const bool isOther = x >= 66 && x < 80 && y >= 30 && y < 60;
            const bool isSky = y < 16;
            const float noise = static_cast<float>((x * 7 + y * 13) % 16) / 16.0f;
            color.push_back(test::packHalf({isFront ? 4.0f : noise, noise / 2, isOther, 1.0f}));
            halves.push_back(test::packHalf({0.25f, 0.0f, 0.0f, 0.5f}));
            motion.emplace_back(isFront ? 12.0f : 2.0f, isFront ? -4.0f : 0.0f);
            metres.push_back(isSky ? 1.0e9f : isFront ? 2.0f : isOther ? 4.0f : 16.0f);
            packed.emplace_back(motion.back() * 0.5f, metres.back(), 0.0f);
            ids.push_back(isSky ? 0xFFFFFFFFu : isFront ? 7u : isOther ? 200u : 1u);
        }
        const auto make = [&](VkFormat format, const auto& values) {
            return test::convertForC(
                makeTexels(format, kFieldsExtent, values, VK_IMAGE_USAGE_STORAGE_BIT).describe()
            );
        };
        mBase.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, color);
        mBase.vectors = make(VK_FORMAT_R32G32_SFLOAT, motion);
        mBase.depth = make(VK_FORMAT_R32_SFLOAT, metres);
        mBase.entityId = make(VK_FORMAT_R32_UINT, ids);
        mBase.normal = make(VK_FORMAT_R16G16B16A16_SFLOAT, color);
        mPacked = make(VK_FORMAT_R32G32B32A32_SFLOAT, packed);
        mShares = make(VK_FORMAT_R32_SFLOAT, shares);
        mHalves = make(VK_FORMAT_R16G16B16A16_SFLOAT, halves);
        mBase.output = test::convertForC(mOutput->output());
        describe();
    }

    void describe() {
        mBase.width = kFieldsWidth;
        mBase.height = kFieldsHeight;
        mBase.depthIsLinear = VK_TRUE;
        mBase.skyValue = 1.0e9f;
        mBase.exposureShare = 1.0f;
        const glm::dmat4 before = glm::rotate(
            glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, 0.0, 0.0)), 0.02, glm::dvec3(0, 1, 0)
        );
        const glm::dmat4 projection = math::clipFromViewPerspective(1.0, 1.5, 0.125);
        ShutterBlurCameras& cameras = mBase.cameras;
        cameras.areGiven = VK_TRUE;
        copyMatrix(cameras.viewFromWorld, glm::dmat4(1.0));
        copyMatrix(cameras.viewFromWorldBefore, before);
        copyMatrix(cameras.clipFromView, projection);
        copyMatrix(cameras.clipFromViewBefore, projection);
        cameras.jitterPxBefore[0] = 0.25;
        mKeys[0].time = -0.5;
        mKeys[1].time = 1.0;
        copyMatrix(mKeys[0].viewFromWorld, before);
        copyMatrix(mKeys[1].viewFromWorld, glm::dmat4(1.0));
        for (ShutterBlurCameraKey& key : mKeys)
            copyMatrix(key.clipFromView, projection);
        const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(-0.4, 0.0, 0.0));
        copyMatrix(mMatrices[0], moved);
        copyMatrix(mMatrices[1], glm::dmat4(1.0));
        mMovers[0] = {7, mMatrices[0]};
        mBase.keys = mKeys.data();
        mBase.keyCount = 2;
        mBase.movers = mMovers.data();
        mBase.moverCount = 1;
        mBase.rowCount = 201;
        mBase.recordReveal = [](void*, const ShutterBlurRevealTask*) {};
        mBase.recordSamples = [](void*, const ShutterBlurSampleTask*) {};
    }

    /// Nothing: it was refused, which the sentence explains.
    std::optional<image::Image> draw(const Inputs& inputs, const ShutterBlurSettings& settings) {
        mSentence.clear();
        submit([&](VkCommandBuffer commands) {
            for (const test::HostTexels& texels : mTexels)
                texels.record(commands);
            if (shutterBlurRecord(mC->blur, commands, 0, &inputs, &settings) !=
                SHUTTER_BLUR_SUCCESS)
                mSentence = shutterBlurGetMessage();
            else
                mOutput->recordReadback(commands);
        });
        if (!mSentence.empty())
            return std::nullopt;
        return mOutput->read();
    }

    [[nodiscard]] Changes listChanges() const;

    static ShutterBlurSettings settingsOf(const char* method) {
        ShutterBlurSettings settings = shutterBlurDefaultSettings();
        settings.method = method;
        settings.sampleCount = 5;
        return settings;
    }

    /// "changes", "none" or "refused"; in a column that compares no pictures "taken" for the first
    /// two.
    std::string tryField(const FieldChange<Inputs>& change, const char* method, bool compares) {
        Inputs inputs = mBase;
        change.apply(inputs);
        const auto made = draw(inputs, settingsOf(method));
        if (!made) {
            const bool isNamed = mSentence.find(change.named) != std::string::npos;
            return isNamed ? "refused" : "refused by another name: " + mSentence;
        }
        if (!compares)
            return "taken";
        const auto [base, isNew] = mPictures.try_emplace(method);
        if (isNew)
            base->second = draw(mBase, settingsOf(method)).value_or(image::Image());
        return test::sameBits(*made, base->second) ? "none" : "changes";
    }

    std::optional<test::BlurOfC> mC;
    std::optional<test::Picture> mOutput;
    Inputs mBase = shutterBlurDefaultInputs();
    ShutterBlurImage mPacked{};
    ShutterBlurImage mShares{};
    ShutterBlurImage mHalves{};
    std::array<ShutterBlurCameraKey, 2> mKeys{};
    double mMatrices[2][16]{};
    std::array<ShutterBlurMover, 1> mMovers{};
    std::string mSentence;
    std::map<std::string, image::Image> mPictures; ///< by method, of mBase
};

EmbeddedFields::Changes EmbeddedFields::listChanges() const {
    static const std::array<ShutterBlurResponsePoint, 2> kRamp{{{0.0, 0.0}, {1.0, 1.0}}};
    static const std::array<uint64_t, 201> kIds{};
    static const uint32_t kViewModel = 200;
    static const std::array<double, 2> kFocus{1.0, 3.0};
    static const glm::dmat4 kElsewhere = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0.2, 0));
    static const std::array<glm::dmat4, 2> kPoses{glm::dmat4(1.0), kElsewhere};
    static const glm::dmat4 kZoomed = math::clipFromViewPerspective(1.2, 1.5, 0.125);
    // A barrier may name the stage of ray-tracing pipelines only where they are enabled.
    const VkBool32 launchesRays = device().info().rayTier == gpu::RayTier::Pipeline;
    const auto openLens = [](Inputs& in) { in.lens.radius = 0.02; };
    const auto bent = [openLens](const auto& change) {
        return [openLens, change](Inputs& in) {
            openLens(in);
            change(in.lens);
        };
    };
    return {
        {"structBytes", {[](Inputs& in) { in.structBytes = 1; }, "structBytes"}},
        {"width", {[](Inputs& in) { in.width = 0; }, "size"}},
        {"height", {[](Inputs& in) { in.height = 0; }, "size"}},
        {"color", {[](Inputs& in) { in.color.image = VK_NULL_HANDLE; }, "color"}},
        {"motionDepth", {[this](Inputs& in) { in.motionDepth = mPacked; }, "motionDepth"}},
        {"output", {[](Inputs& in) { in.output.format = VK_FORMAT_R8_UNORM; }, "output.format"}},
        {"vectors", {[](Inputs& in) { in.vectors = {}; }, "vectors"}},
        {"depth", {[](Inputs& in) { in.depth = {}; }, "depth"}},
        {"pixelsPerUnit", {[](Inputs& in) { in.pixelsPerUnit[0] = 2.0f; }, "pixelsPerUnit"}},
        {"vectorsLackCamera", {[](Inputs& in) { in.vectorsLackCamera = VK_TRUE; }, "vectors"}},
        {"vectorsHaveJitter", {[](Inputs& in) { in.vectorsHaveJitter = VK_TRUE; }, "vectors"}},
        {"depthIsLinear", {[](Inputs& in) { in.depthIsLinear = VK_FALSE; }, "depth"}},
        {"metresPerUnit", {[](Inputs& in) { in.metresPerUnit = 0.5f; }, "metres"}},
        {"skyValue", {[](Inputs& in) { in.skyValue = 16.0f; }, "sky"}},
        {"cameras.areGiven", {[](Inputs& in) { in.cameras.areGiven = VK_FALSE; }, "cameras"}},
        {"cameras.aheadIsPlusZ",
         {[](Inputs& in) { in.cameras.aheadIsPlusZ = VK_TRUE; }, "aheadIsPlusZ"}},
        {"cameras.viewFromWorld",
         {[](Inputs& in) { copyMatrix(in.cameras.viewFromWorld, kElsewhere); }, "cameras"}},
        {"cameras.clipFromView",
         {[](Inputs& in) { copyMatrix(in.cameras.clipFromView, kZoomed); }, "cameras"}},
        {"cameras.viewFromWorldBefore",
         {[](Inputs& in) { copyMatrix(in.cameras.viewFromWorldBefore, kElsewhere); }, "cameras"}},
        {"cameras.clipFromViewBefore",
         {[](Inputs& in) { copyMatrix(in.cameras.clipFromViewBefore, kZoomed); }, "cameras"}},
        {"cameras.jitterPx",
         {[](Inputs& in) { in.cameras.jitterPx[0] = std::nan(""); }, "jitterPx"}},
        {"cameras.jitterPxBefore",
         {[](Inputs& in) { in.cameras.jitterPxBefore[0] = std::nan(""); }, "jitterPx"}},
        {"exposureShare", {[](Inputs& in) { in.exposureShare = 0.5f; }, "exposureShare"}},
        {"cameraScale", {[](Inputs& in) { in.cameraScale = 0.5f; }, "cameraScale"}},
        {"objectScale", {[](Inputs& in) { in.objectScale = 0.5f; }, "objectScale"}},
        {"displayedPerRendered",
         {[](Inputs& in) { in.displayedPerRendered = 2.0f; }, "displayedPerRendered"}},
        {"blurScale", {[this](Inputs& in) { in.blurScale = mShares; }, "blurScale"}},
        {"isCut", {[](Inputs& in) { in.isCut = VK_TRUE; }, "isCut"}},
        {"rasterTime", {[](Inputs& in) { in.rasterTime = 0.5; }, "rasterTime"}},
        {"frameNumber", {[](Inputs& in) { in.frameNumber = 3; }, "frameNumber"}},
        {"entityId", {[](Inputs& in) { in.entityId = {}; }, "entityId"}},
        {"noEntity", {[](Inputs& in) { in.noEntity = 200; }, "noEntity"}},
        {"rowCount", {[](Inputs& in) { in.rowCount = 8; }, "rowCount"}},
        {"keyCount", {[](Inputs& in) { in.keyCount = 65; }, "keys"}},
        {"keys", {[](Inputs& in) { in.keys = nullptr, in.keyCount = 0; }, "keys"}},
        {"moverCount", {[](Inputs& in) { in.moverCount = 0; }, "movers"}},
        {"movers", {[](Inputs& in) { in.movers = nullptr; }, "movers"}},
        {"rowIds", {[](Inputs& in) { in.rowIds = kIds.data(); }, "rowIds"}},
        {"view", {[](Inputs& in) { in.view = 5; }, "view"}},
        {"followsLast", {[](Inputs& in) { in.followsLast = VK_TRUE; }, "followsLast"}},
        {"normal", {[](Inputs& in) { in.normal = {}; }, "normal"}},
        {"recordReveal", {[](Inputs& in) { in.recordReveal = nullptr; }, "recordReveal"}},
        {"revealUser", {[](Inputs& in) { in.revealUser = &in; }, "revealUser"}},
        {"revealByRayPipeline",
         {[launchesRays](Inputs& in) { in.revealByRayPipeline = launchesRays; }, "reveal"}},
        {"recordSamples", {[](Inputs& in) { in.recordSamples = nullptr; }, "recordSamples"}},
        {"samplesUser", {[](Inputs& in) { in.samplesUser = &in; }, "samplesUser"}},
        {"samplesByRayPipeline",
         {[launchesRays](Inputs& in) { in.samplesByRayPipeline = launchesRays; }, "samples"}},
        {"lastColor", {[this](Inputs& in) { in.lastColor = mHalves; }, "lastMotionDepth"}},
        {"lastMotionDepth", {[this](Inputs& in) { in.lastMotionDepth = mPacked; }, "lastColor"}},
        {"lastEntityId", {[](Inputs& in) { in.lastEntityId = in.entityId; }, "lastEntityId"}},
        {"budgetMilliseconds", {[](Inputs& in) { in.budgetMilliseconds = -1.0; }, "budget"}},
        {"showsInputs", {[](Inputs& in) { in.showsInputs = VK_TRUE; }, "showsInputs"}},
        {"responsePoints",
         {[](Inputs& in) { in.responsePoints = kRamp.data(), in.responsePointCount = 2; },
          "responsePoints"}},
        {"responsePointCount", {[](Inputs& in) { in.responsePointCount = 2; }, "responsePoints"}},
        {"deformedMotion",
         {[this](Inputs& in) { in.deformedMotion = mHalves, in.moverCount = 0; }, "deformed"}},
        {"lastDeformedMotion",
         {[this](Inputs& in) { in.lastDeformedMotion = mHalves; }, "deformedMotion"}},
        {"blended", {[this](Inputs& in) { in.blended = mHalves; }, "blended"}},
        {"recordBlended",
         {[](Inputs& in) {
              in.recordBlended = [](void*, const ShutterBlurBlendedTask*) {};
              in.blendedInstants = 257;
          },
          "blendedInstants"}},
        {"blendedUser", {[](Inputs& in) { in.blendedUser = &in; }, "blendedUser"}},
        {"blendedArea",
         {[](Inputs& in) {
              in.recordBlended = [](void*, const ShutterBlurBlendedTask*) {};
              in.blendedArea = {{0, 0}, {kFieldsWidth + 1, 1}};
          },
          "blendedArea"}},
        {"blendedInstants", {[](Inputs& in) { in.blendedInstants = 3; }, "blendedInstants"}},
        {"blendedParts",
         {[](Inputs& in) {
              in.recordBlended = [](void*, const ShutterBlurBlendedTask*) {};
              in.blendedParts = 5;
          },
          "blendedParts"}},
        {"blendedOpacityInAlpha",
         {[](Inputs& in) { in.blendedOpacityInAlpha = VK_TRUE; }, "blendedOpacityInAlpha"}},
        {"lens.radius", {openLens, "lens.radius"}},
        {"lens.focusDistance",
         {bent([](ShutterBlurLens& lens) { lens.focusDistance = 0.0; }), "lens"}},
        {"lens.focusDistances",
         {bent([](ShutterBlurLens& lens) { lens.focusDistances = kFocus.data(); }), "lens"}},
        {"lens.bladeRotation",
         {bent([](ShutterBlurLens& lens) { lens.bladeRotation = 9.0; }), "lens"}},
        {"lens.roundness", {bent([](ShutterBlurLens& lens) { lens.roundness = 2.0; }), "lens"}},
        {"lens.squeeze", {bent([](ShutterBlurLens& lens) { lens.squeeze = 0.0; }), "lens"}},
        {"lens.blades", {bent([](ShutterBlurLens& lens) { lens.blades = 2; }), "lens"}},
        {"viewModelRows",
         {[](Inputs& in) { in.viewModelRows = &kViewModel, in.viewModelRowCount = 1; },
          "viewModelRows"}},
        {"viewModelRowCount", {[](Inputs& in) { in.viewModelRowCount = 1; }, "viewModelRows"}},
        {"viewModel.depthMin", {[](Inputs& in) { in.viewModel.depthMin = 1.0f; }, "depthMin"}},
        {"viewModel.depthMax", {[](Inputs& in) { in.viewModel.depthMax = 2.0f; }, "depthMax"}},
        {"viewModel.clipFromView",
         {[](Inputs& in) {
              in.viewModel.depthMax = 2.0f;
              copyMatrix(in.viewModel.clipFromView, kZoomed);
          },
          "viewModel.clipFromView"}},
        {"viewModel.viewFromObject",
         {[](Inputs& in) {
              in.viewModel.depthMax = 2.0f;
              in.viewModel.viewFromObject = &kPoses[0][0].x;
          },
          "viewModel.viewFromObject"}},
        {"transfer", {[](Inputs& in) { in.transfer = SHUTTER_BLUR_TRANSFER_SRGB; }, "transfer"}},
        {"transferPower",
         {[](Inputs& in) {
              in.transfer = SHUTTER_BLUR_TRANSFER_POWER;
              in.transferPower = 4.0;
          },
          "transferPower"}},
        {"transferScale", {[](Inputs& in) { in.transferScale = 0.0; }, "transferScale"}},
        {"cutDistance", {[](Inputs& in) { in.cutDistance = 0.01; }, "cutDistance"}},
        {"cutDegrees", {[](Inputs& in) { in.cutDegrees = 0.01; }, "cutDegrees"}},
    };
}

TEST_F(EmbeddedFields, EachFieldOfTheInputsCountsOrIsRefusedOrHasNoMeaningAsStated) {
    const Changes changes = listChanges();
    const auto table = readTable("Inputs");
    const std::set<std::string> fields = listFields("ShutterBlurInputs");
    ASSERT_GT(fields.size(), 60u);
    EXPECT_EQ(namesOf(changes), fields);
    EXPECT_EQ(namesOf(table), fields) << "fields.md";

    struct Column {
        std::vector<const char*> methods;
        bool compares = true;
    };

    // Rays that a host answers are drawn in host_rays_test.cpp; a column names which of them
    // refuse.
    std::array<Column, 5> columns{
        {{{"gather", "own_velocity"}},
         {{"rosado2007"}},
         {{"resolved"}},
         {{"hybrid"}, false},
         {{"adaptive"}, false}}};
    if (test::drawsAll())
        columns[0].methods = {
            "gather", "own_velocity", "mcguire2012", "guertin2014", "jimenez2014"};
    for (const auto& [name, cells] : table) {
        const auto change = changes.find(name);
        if (change == changes.end())
            continue;
        const bool areAlike = cells.size() == 1; // one outcome of all methods
        ASSERT_TRUE(areAlike || cells.size() == 5) << name;
        for (size_t i = 0; i < columns.size(); ++i)
            for (const char* method : columns[i].methods) {
                std::string stated = cells[areAlike || !columns[i].compares ? 0 : i];
                if (!columns[i].compares) {
                    const bool refuses =
                        areAlike ? stated == "refused" : cells[3].find(method) != std::string::npos;
                    stated = refuses ? "refused" : "taken";
                }
                const bool differ = stated.ends_with('*'); // it holds for the first method
                if (differ && method != columns[i].methods.front())
                    continue;
                stated.erase(stated.find_last_not_of('*') + 1);
                EXPECT_EQ(stated, tryField(change->second, method, columns[i].compares))
                    << name << " by " << method;
            }
    }
}

TEST_F(EmbeddedFields, EachFieldOfTheSettingsIsTakenOrRefusedAsStated) {
    using Settings = ShutterBlurSettings;
    static const ShutterBlurValue kNonsense{"nonsense", "1"};
    const std::map<std::string, FieldChange<Settings>> changes{
        {"structBytes", {[](Settings& one) { one.structBytes = 1; }, "structBytes"}},
        {"method", {[](Settings& one) { one.method = "nonsense"; }, "settings.method"}},
        {"sampleCount", {[](Settings& one) { one.sampleCount = 3; }, "sampleCount"}},
        {"valueCount", {[](Settings& one) { one.valueCount = 1; }, "settings.values"}},
        {"values",
         {[](Settings& one) { one.values = &kNonsense, one.valueCount = 1; }, "nonsense"}},
        {"preset", {[](Settings& one) { one.preset = "nonsense"; }, "settings.preset"}}};
    const auto table = readTable("Settings");
    EXPECT_EQ(namesOf(changes), listFields("ShutterBlurSettings"));
    EXPECT_EQ(namesOf(table), listFields("ShutterBlurSettings")) << "fields.md";
    for (const char* method : {"gather", "resolved"}) {
        const auto base = draw(mBase, settingsOf(method));
        ASSERT_TRUE(base.has_value()) << mSentence;
        for (const auto& [name, change] : changes) {
            ShutterBlurSettings settings = settingsOf(method);
            change.apply(settings);
            const auto made = draw(mBase, settings);
            std::string outcome = made ? "none" : "refused";
            if (made && !test::sameBits(*made, *base))
                outcome = "changes";
            EXPECT_EQ(table.at(name).front(), outcome) << name << " by " << method;
            EXPECT_TRUE(made || mSentence.find(change.named) != std::string::npos) << mSentence;
        }
    }
}

TEST_F(EmbeddedFields, EachFieldOfTheDeviceIsTakenOrRefusedAsStated) {
    using Device = ShutterBlurDevice;
    static const VkPhysicalDeviceFeatures2 kNone{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    const std::map<std::string, FieldChange<Device>> changes{
        {"structBytes", {[](Device& one) { one.structBytes = 1; }, "structBytes"}},
        {"headerVersion",
         {[](Device& one) { one.headerVersion = 1u << 22; }, "headers of version"}},
        {"physical", {[](Device& one) { one.physical = VK_NULL_HANDLE; }, "physical"}},
        {"device", {[](Device& one) { one.device = VK_NULL_HANDLE; }, "device"}},
        {"queueFamily", {[](Device& one) { one.queueFamily = 77; }, "queue"}},
        {"framesInFlight", {[](Device& one) { one.framesInFlight = 0; }, "framesInFlight"}},
        {"hasDebugUtils", {[](Device& one) { one.hasDebugUtils = VK_FALSE; }, ""}},
        {"pipelineCache", {[](Device& one) { one.pipelineCache = VK_NULL_HANDLE; }, ""}},
        {"tracesIndirect", {[](Device& one) { one.tracesIndirect = VK_TRUE; }, ""}},
        {"apiVersion", {[](Device& one) { one.apiVersion = VK_API_VERSION_1_2; }, "apiVersion"}},
        {"enabledFeatures", {[](Device& one) { one.enabledFeatures = &kNone; }, "enabledFeatures"}},
        {"measures", {[](Device& one) { one.measures = VK_TRUE; }, ""}},
        {"checksInputs", {[](Device& one) { one.checksInputs = VK_TRUE; }, ""}},
        {"message", {[](Device& one) { one.message = [](void*, const char*) {}; }, ""}},
        {"messageUser", {[](Device& one) { one.messageUser = &one; }, ""}}};
    const auto table = readTable("Device");
    EXPECT_EQ(namesOf(changes), listFields("ShutterBlurDevice"));
    EXPECT_EQ(namesOf(table), listFields("ShutterBlurDevice")) << "fields.md";
    for (const auto& [name, change] : changes) {
        ShutterBlurDevice described = test::describeForC(device());
        change.apply(described);
        ShutterBlur* blur = nullptr;
        const ShutterBlurResult result = shutterBlurCreate(&described, &blur);
        const std::string sentence = shutterBlurGetMessage();
        EXPECT_EQ(table.at(name).front(), result == SHUTTER_BLUR_SUCCESS ? "taken" : "refused")
            << name;
        EXPECT_TRUE(blur || sentence.find(change.named) != std::string::npos) << sentence;
        shutterBlurDestroy(blur);
    }
}

} // namespace
} // namespace shutter
