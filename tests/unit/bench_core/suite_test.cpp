// SPDX-License-Identifier: MIT
// What the benchmark measures: suites, contenders, plans of sequences, crops, judges, truth.
#include "engine/image/flip.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/bench/bench_arguments.h"
#include "game/bench/case_stage.h"
#include "game/bench/contenders.h"
#include "game/bench/crops.h"
#include "game/bench/frame_judge.h"
#include "game/bench/measure.h"
#include "game/bench/sequence/temporal_error.h"
#include "game/bench/sequence_plan.h"
#include "game/bench/suites/suite.h"
#include "game/bench/truth_cache.h"
#include "modules/depth_of_field/depth_of_field.h"
#include "tests/support/outcomes.h"
#include "tests/support/rows.h"
#include "tests/support/temp_folder.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace shutter::bench {
namespace {

using image::Image;

TEST(Suites, SuitesAreFoundByNameAndTheirShotsAreValidOptions) {
    for (const char* name : {"paper", "hard", "scaling", "edges", "lens"}) {
        auto suite = test::valueOf(findSuite(name));
        std::vector<Case> cases = suite.cases;
        for (const ScalingAxis& axis : suite.axes)
            for (const ScalingPoint& point : axis.points)
                cases.push_back(point.shot);
        EXPECT_FALSE(cases.empty()) << name;
        std::set<std::string> names;
        for (Case& shot : cases) {
            EXPECT_TRUE(names.insert(shot.name).second) << shot.name;
            EXPECT_EQ(shot.name.find_first_of("/ "), std::string::npos) << shot.name;
            shot.shot.scene = "x.glb";
            const auto options = game::interpret(shot.shot);
            EXPECT_TRUE(options.ok()) << shot.name << ": " << options.error().message;
        }
    }
}

TEST(Suites, SequencesAreFourFlightsAndThreePlayedDemos) {
    const auto suite = test::valueOf(findSuite("sequence"));
    std::set<std::string> names;
    std::set<std::string> demos;
    for (const SequenceCase& film : suite.sequences) {
        EXPECT_TRUE(names.insert(film.name).second) << film.name;
        EXPECT_EQ(film.name.find_first_of("/ "), std::string::npos) << film.name;
        EXPECT_TRUE(film.description.ends_with('.')) << film.name;
        EXPECT_TRUE(film.writeScene) << film.name;
        EXPECT_TRUE(film.script.starts_with('{')) << film.name;
        if (!film.demo.empty())
            demos.insert(film.demo);
    }
    EXPECT_EQ(names.size(), 7u);
    EXPECT_EQ(demos, (std::set<std::string>{"gallery", "rally", "spin"}));
}

TEST(Suites, TheLookHasEachDemoWithShadowsAndBloomBeforeAPictureOfThePixelsMean) {
    const auto suite = test::valueOf(findSuite("look"));
    std::set<std::string> demos;
    for (const SequenceCase& film : suite.sequences) {
        demos.insert(film.demo);
        EXPECT_EQ(film.shot.picture.features.shadows.mode, shadows::ShadowMode::Blurred)
            << film.name;
        EXPECT_GT(film.shot.picture.bloom.share, 0.0f) << film.name;
    }
    EXPECT_EQ(demos, (std::set<std::string>{"gallery", "rally", "spin"}));
    EXPECT_EQ(suite.pixel, extract::PixelModel::Box);
}

TEST(Suites, TheDialMeasuresItsMethodsInItsOrderAndOtherSuitesLeaveItsVariantsOut) {
    const auto interpret = [](const std::string& words) {
        CLI::App app;
        BenchArguments arguments;
        defineBenchOptions(app, arguments);
        app.parse(words);
        return test::valueOf(interpretBench(arguments));
    };
    const BenchTask dial = interpret("--suite dial --out x");
    EXPECT_EQ(dial.suite.cases.size(), 6u);
    ASSERT_EQ(dial.methods.size(), dial.suite.dial.size());
    for (size_t i = 0; i < dial.methods.size(); ++i)
        EXPECT_EQ(dial.methods[i]->name, dial.suite.dial[i]);
    for (const SamplePoint& point : makeDialPoints(dial.methods))
        EXPECT_NE(point.isDefault, point.method->family == game::MethodFamily::Truth);
    for (const game::MethodInfo* method : interpret("--suite paper --out x").methods)
        EXPECT_FALSE(isOnDialAlone(method->name)) << method->name;
}

TEST(Suites, EachCaseIsThereWithEachAntiAliasingAndTheSuitesPixel) {
    Suite suite = makeEdgesSuite();
    const size_t count = suite.cases.size();
    suite.sequences = {{.name = "film", .title = "Film"}};
    spreadAntiAliasing(suite);
    ASSERT_EQ(suite.cases.size(), 3 * count);
    EXPECT_EQ(suite.cases[0].name, "vase");
    EXPECT_EQ(suite.cases[1].name, "vase-taa");
    EXPECT_EQ(suite.cases[2].name, "vase-box");
    EXPECT_EQ(suite.cases[0].shot.picture.antiAliasing, game::AntiAliasing::None);
    EXPECT_EQ(suite.cases[1].shot.picture.antiAliasing, game::AntiAliasing::Taa);
    EXPECT_EQ(suite.cases[1].title, suite.cases[0].title + ", --aa taa");
    for (const Case& shot : suite.cases)
        EXPECT_EQ(shot.shot.pixel, extract::PixelModel::Box) << shot.name;
    ASSERT_EQ(suite.sequences.size(), 3u);
    EXPECT_EQ(suite.sequences[2].name, "film-box");
    EXPECT_EQ(suite.sequences[2].shot.pixel, extract::PixelModel::Box);
}

TEST(Suites, PixelOverridesThatOfASuite) {
    for (const auto& [words, pixel] :
         {std::pair{"--suite edges --out x", extract::PixelModel::Box},
          std::pair{"--suite edges --pixel centre --out x", extract::PixelModel::Centre},
          std::pair{"--suite paper --out x", extract::PixelModel::Centre},
          std::pair{"--suite paper --pixel box --out x", extract::PixelModel::Box}}) {
        CLI::App app;
        BenchArguments arguments;
        defineBenchOptions(app, arguments);
        app.parse(words);
        const auto task = test::valueOf(interpretBench(arguments));
        EXPECT_EQ(task.suite.cases.front().shot.pixel, pixel) << words;
    }
}

TEST(Arguments, GivenOptionsAreListedAsTypedWithoutFoldersAndDefaults) {
    const auto list = [](const std::string& words) {
        CLI::App app;
        BenchArguments arguments;
        defineBenchOptions(app, arguments);
        app.parse(words);
        return listGivenOptions(app);
    };
    EXPECT_EQ(
        list("--out a/b --aa none,box --case near --case joint --suite lens --restart --methods "
             "sharp,resolved --rooms c --size 64x36 --unlit"),
        (std::vector<std::string>{
            "--suite lens",
            "--methods sharp,resolved",
            "--case near",
            "--case joint",
            "--size 64x36",
            "--unlit",
            "--aa none,box"})
    );
    EXPECT_EQ(
        list("a/scene.glb --out b --time 0.5"),
        (std::vector<std::string>{"scene.glb", "--time 0.5"})
    );
}

TEST(Suites, ShotsWhoseRoomIsNotThereAreLeftOut) {
    const test::TempFolder folder;
    Suite all = makeLensSuite();
    std::erase_if(all.cases, [](const Case& shot) { return shot.room.empty(); });
    Suite none = all;
    test::expectRefused(provideRooms(none, folder.path()), "--rooms");

    Suite suite = all;
    const std::string room = suite.cases.front().room;
    const auto isOfRoom = [&](const Case& shot) { return shot.room == room; };
    const auto count = std::count_if(suite.cases.begin(), suite.cases.end(), isOfRoom);
    folder.write(room, "no glTF");
    ASSERT_TRUE(provideRooms(suite, folder.path()).ok());
    ASSERT_EQ(suite.cases.size(), size_t(count));
    for (const Case& shot : suite.cases) {
        EXPECT_EQ(shot.room, room);
        test::expectRefused(shot.writeScene(folder.path() / "out.glb"), room);
    }
}

TEST(Suites, AnUnknownNameIsAnsweredWithTheKnownOnes) {
    const auto found = findSuite("nosuch");
    ASSERT_FALSE(found.ok());
    for (const char* part : {"--suite", "nosuch", "paper", "hard", "scaling"})
        EXPECT_NE(found.error().message.find(part), std::string::npos) << part;
}

class CaseSetupTest : public testing::Test {
  protected:
    void SetUp() override {
        mFolder.write("s.gltf", R"({"asset": {"version": "2.0"},
            "buffers": [{"uri": "a.bin", "byteLength": 1}]})");
        mFolder.write("a.bin", "1");
    }

    [[nodiscard]] CaseSetup setUp(Case shot = {}) const {
        shot.shot.scene = (mFolder.path() / "s.gltf").string();
        return test::valueOf(setUpCase(shot, {}, mFolder.path()));
    }

    [[nodiscard]] std::string hash() const { return setUp().hash; }

    test::TempFolder mFolder;
};

TEST_F(CaseSetupTest, ABufferIsPartOfTheSceneAndUnreferencedFilesAreNot) {
    const std::string before = hash();
    mFolder.write("notes.txt", "next to the scene");
    mFolder.write("below/deep/file.bin", "below the scene");
    std::filesystem::create_symlink("nowhere", mFolder.path() / "broken");
    EXPECT_EQ(hash(), before);
    mFolder.write("a.bin", "2");
    EXPECT_NE(hash(), before);
}

TEST_F(CaseSetupTest, TheTruthDependsOnThePixelAndNotOnAntiAliasing) {
    Case smooth;
    smooth.shot.picture.antiAliasing = game::AntiAliasing::Taa;
    EXPECT_NE(setUp(smooth).hash, setUp().hash);
    EXPECT_EQ(setUp(smooth).truthHash, setUp().truthHash);
    smooth.shot.pixel = extract::PixelModel::Box;
    EXPECT_NE(setUp(smooth).truthHash, setUp().truthHash);
}

TEST(Sweep, SampleCountsRiseWithinAMethodAndContainItsDefaultOnce) {
    std::vector<const game::MethodInfo*> methods;
    for (const game::MethodInfo& method : listContenders())
        methods.push_back(&method);
    const std::vector<SamplePoint> sweep = makeSweep(methods, 256);
    for (size_t i = 1; i < sweep.size(); ++i)
        if (sweep[i].method == sweep[i - 1].method) {
            EXPECT_LT(sweep[i - 1].samples, sweep[i].samples) << sweep[i].method->name;
        }
    for (const game::MethodInfo* method : methods) {
        const auto isDefault = [&](const SamplePoint& point) {
            return point.method == method && point.isDefault;
        };
        const auto count = std::count_if(sweep.begin(), sweep.end(), isDefault);
        // The truth's own default is what the others are compared with.
        EXPECT_EQ(count, method->family == game::MethodFamily::Accumulate ? 0 : 1) << method->name;
    }
}

TEST(Contenders, ContendersAreTheMethodsThePapersWithItsNumbersAndSomeWithOtherRays) {
    for (const game::MethodInfo& method : game::listMethods()) {
        const auto found = test::valueOf(findContender(method.name));
        const game::MethodOptions options = makeMethodOptions({found, method.defaultSamples, true});
        EXPECT_STREQ(options.method->name, method.name);
        motion_blur::MotionBlurSettings expected;
        if (method.blur) {
            expected.method = method.blur;
            expected.sampleCount = method.defaultSamples;
        }
        EXPECT_EQ(options.motionBlur, expected) << method.name;
    }
    const game::MethodInfo* paper = findContender("hybrid_paper").value();
    EXPECT_EQ(makeMethodOptions({paper, 15, true}).motionBlur, motion_blur::paperSettings());
    const game::MethodInfo* fewer = findContender("hybrid_share_25").value();
    EXPECT_FLOAT_EQ(makeMethodOptions({fewer, 15, true}).motionBlur.rayShare, 0.25f);
    const game::MethodInfo* more = findContender("adaptive_rays_200").value();
    EXPECT_FLOAT_EQ(makeMethodOptions({more, 15, true}).motionBlur.raysPerPixel, 2.0f);
    test::expectRefused(findContender("nosuch"), "gather_paper");
}

TEST(Contenders, AFilterOfTheLensTakesTapsAndBesideAMotionBlurItsDefault) {
    const game::MethodInfo* alone = findContender("near_far_lens").value();
    EXPECT_TRUE(alone->hasLens);
    EXPECT_EQ(makeMethodOptions({alone, 16, false}).lensTaps, 16u);
    const game::MethodInfo* traced = findContender("hybrid_lens").value();
    EXPECT_EQ(traced->rays, game::RayNeed::Query);
    EXPECT_EQ(makeMethodOptions({traced, 2, false}).samples, 2u);
    EXPECT_EQ(makeMethodOptions({traced, 2, false}).lensTaps, depth_of_field::kDefaultTaps);
    for (const char* name : {"lens_then_blur", "blur_then_lens"}) {
        const game::MethodInfo* both = findContender(name).value();
        const game::MethodOptions options = makeMethodOptions({both, 8, false});
        EXPECT_EQ(options.lensTaps, depth_of_field::kDefaultTaps);
        EXPECT_EQ(options.motionBlur.sampleCount, 8u);
        EXPECT_STREQ(options.motionBlur.method->name, "resolved");
    }
    EXPECT_EQ(makeMethodOptions({findContender("resolved").value(), 8, false}).lensTaps, 0u);
}

std::vector<const game::MethodInfo*> findMethods(std::initializer_list<const char*> names) {
    std::vector<const game::MethodInfo*> methods;
    for (const char* name : names)
        methods.push_back(findContender(name).value());
    return methods;
}

TEST(SequencePlan, NoSampleCountIsDrawnTwiceInAFrame) {
    const SequencePlan plan =
        planSequence(findMethods({"sharp", "gather", "accumulate", "truth"}), 48, 64);
    std::set<std::string> keys;
    for (const auto* points : {&plan.points, &plan.sweep})
        for (const SamplePoint& point : *points)
            EXPECT_TRUE(keys.insert(makeKey(point)).second) << makeKey(point);
    for (const std::string& key :
         test::rowsOf("sharp/0|gather/15|gather/64|accumulate/8|accumulate/32|truth/4|truth/8"))
        EXPECT_TRUE(keys.contains(key)) << key;
    EXPECT_FALSE(keys.contains("truth/16")) << "seconds a frame";
    EXPECT_FALSE(keys.contains("accumulate/64")) << "the truth itself";
    EXPECT_EQ(plan.points.size(), 4u);
}

TEST(SequencePlan, AntiAliasingAllowsOnlyMethodsOfOneRasterAtTheirDefaults) {
    const SequencePlan plan = planSequence(
        findMethods({"sharp", "gather", "accumulate", "truth"}), 48, 64, game::AntiAliasing::Taa
    );
    ASSERT_EQ(plan.points.size(), 2u);
    EXPECT_EQ(makeKey(plan.points[0]), "sharp/0");
    EXPECT_EQ(makeKey(plan.points[1]), "gather/15");
    EXPECT_TRUE(plan.sweep.empty());
}

TEST(SequencePlan, FramesThatAreDrawnAgainLieInsideTheFilm) {
    for (const uint32_t frames : {2u, 3u, 7u, 48u}) {
        const SequencePlan plan = planSequence(findMethods({"sharp"}), frames, 64);
        EXPECT_GE(plan.standingFrames, 2u);
        EXPECT_LE(plan.firstStanding + plan.standingFrames, frames);
        ASSERT_FALSE(plan.sweepFrames.empty());
        EXPECT_LT(plan.sweepFrames.back(), frames);
        EXPECT_EQ(
            std::set(plan.sweepFrames.begin(), plan.sweepFrames.end()).size(),
            plan.sweepFrames.size()
        );
        for (const uint32_t frame : plan.sweepFrames)
            EXPECT_TRUE(plan.isSwept(frame));
    }
    EXPECT_EQ(
        planSequence(findMethods({"sharp"}), 48, 64).sweepFrames,
        (std::vector<uint32_t>{6, 18, 30, 42})
    );
}

TEST(SequencePlan, TheProgressBarCountsEveryPicture) {
    const SequencePlan plan = planSequence(findMethods({"sharp", "gather"}), 48, 64);
    // A truth and two methods in 48 and 12 frames; gather at 4, 8, 16, 32 and 64 in four.
    EXPECT_EQ(countPictures(plan), 3u * 60u + 5u * 4u);
}

image::Image makeSpot(uint32_t x, uint32_t y, float value) {
    image::Image picture(64, 48, 3);
    picture.at(x, y, 1) = value;
    return picture;
}

TEST(Crops, TheSquareHoldsTheLargestDifferenceAndMeetsNoneThatIsTaken) {
    const image::Image black(64, 48, 3);
    image::Image two = makeSpot(8, 8, 1.0f);
    two.at(40, 30, 0) = 0.5f;
    const auto first = findLargestDifference(two, black, 16, "here", {});
    ASSERT_EQ(first.size(), 1u);
    EXPECT_LE(first[0].x, 8u);
    EXPECT_EQ(first[0].label, "here");
    const auto second = findLargestDifference(two, black, 16, "", first);
    ASSERT_EQ(second.size(), 1u);
    EXPECT_GT(second[0].x, 16u);
    EXPECT_LE(second[0].x, 40u);
    EXPECT_GT(second[0].x + second[0].width, 40u);
    EXPECT_LE(second[0].y, 30u);
    EXPECT_GT(second[0].y + second[0].height, 30u);
    EXPECT_TRUE(findLargestDifference(black, black, 16, "", {}).empty());
    EXPECT_TRUE(findLargestDifference(makeSpot(1, 1, 1.0f), black, 65, "", {}).empty()) << "small";
    const auto broken = makeSpot(40, 30, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(findLargestDifference(broken, black, 16, "", {}).size(), 1u);
}

using Metrics = std::map<std::string, double>;

/// Grey of 1/2 and noise, on the steps of 8 bits.
Image makePicture(uint32_t seed) {
    Image picture(24, 16, 3);
    std::mt19937 random(seed);
    for (float& value : picture.pixels)
        value = float(112 + random() % 32) / 255.0f;
    return picture;
}

FramePicture makeFrame(const char* key, uint32_t seed, Judgement judgement = Judgement::Whole) {
    FramePicture picture;
    picture.key = key;
    picture.shown = makePicture(seed);
    picture.judgement = judgement;
    return picture;
}

std::set<std::string> listIds(const FramePicture& picture) {
    std::set<std::string> ids;
    for (const auto& [id, value] : picture.record.picture.metrics)
        ids.insert(id);
    return ids;
}

std::vector<FramePicture> judge(FrameJudge& judge, std::vector<FramePicture> pictures) {
    test::expectDone(judge.judge(pictures));
    return pictures;
}

TEST(FrameJudge, TheFirstFrameHasNothingBeforeIt) {
    FrameJudge frames;
    const auto first = judge(
        frames,
        {makeFrame("truth", 1),
         makeFrame("gather/15", 2),
         makeFrame("gather/4", 3, Judgement::Squares),
         makeFrame("sharp/0", 4, Judgement::InTime)}
    );
    EXPECT_EQ(listIds(first[0]), std::set<std::string>()) << "nothing to compare the truth with";
    EXPECT_EQ(listIds(first[1]), (std::set<std::string>{"psnr", "ssim", "flip"}));
    EXPECT_EQ(listIds(first[2]), std::set<std::string>{"psnr"});
    EXPECT_EQ(listIds(first[3]), std::set<std::string>());
    const Metrics& metrics = first[1].record.picture.metrics;
    EXPECT_EQ(metrics.at("psnr"), image::computePsnr(makePicture(2), makePicture(1)));
    EXPECT_EQ(metrics.at("ssim"), image::computeSsim(makePicture(2), makePicture(1)));
    EXPECT_EQ(metrics.at("flip"), image::computeFlip(makePicture(2), makePicture(1)).mean);
}

TEST(FrameJudge, EachPictureIsComparedWithItsPredecessor) {
    FrameJudge frames;
    judge(
        frames,
        {makeFrame("truth", 1),
         makeFrame("gather/15", 2),
         makeFrame("sharp/0", 3, Judgement::InTime),
         makeFrame("gather/4", 4, Judgement::Squares)}
    );
    // In another order, and with one that was not there.
    const auto second = judge(
        frames,
        {makeFrame("truth", 5),
         makeFrame("sharp/0", 6, Judgement::InTime),
         makeFrame("gather/15", 7),
         makeFrame("gather/4", 8, Judgement::Squares),
         makeFrame("hybrid/15", 9)}
    );
    EXPECT_EQ(listIds(second[1]), std::set<std::string>{"flicker"});
    EXPECT_EQ(
        listIds(second[2]), (std::set<std::string>{"psnr", "ssim", "flip", "flicker", "fixedPower"})
    );
    EXPECT_EQ(listIds(second[3]), std::set<std::string>{"psnr"});
    EXPECT_EQ(listIds(second[4]), (std::set<std::string>{"psnr", "ssim", "flip"}));
    const auto flickerOf = [](uint32_t before, uint32_t now) {
        const Image pictures[] = {
            makePicture(before), makePicture(1), makePicture(now), makePicture(5)};
        return computeFlicker({pictures[0], pictures[1]}, {pictures[2], pictures[3]});
    };
    EXPECT_EQ(second[1].record.picture.metrics.at("flicker"), flickerOf(3, 6));
    EXPECT_EQ(second[2].record.picture.metrics.at("flicker"), flickerOf(2, 7));
    EXPECT_EQ(
        second[2].record.picture.metrics.at("fixedPower"),
        computeFixedPower(
            computeFineError(makePicture(2), makePicture(1)),
            computeFineError(makePicture(7), makePicture(5))
        )
    );
}

TEST(FrameJudge, JudgingResumesFromPicturesAsFromAFrame) {
    FrameJudge whole;
    judge(whole, {makeFrame("truth", 1), makeFrame("gather/15", 2)});
    FrameJudge resumed;
    resumed.goOnFrom("truth", {{"truth", makePicture(1)}, {"gather/15", makePicture(2)}});
    const auto a = judge(whole, {makeFrame("truth", 3), makeFrame("gather/15", 4)});
    const auto b = judge(resumed, {makeFrame("truth", 3), makeFrame("gather/15", 4)});
    EXPECT_TRUE(a[1].record.picture.metrics.contains("fixedPower"));
    EXPECT_EQ(a[1].record.picture.metrics, b[1].record.picture.metrics);
}

TEST(FrameJudge, HdrFlipIsOfLinearPicturesWhereBothAreThere) {
    std::vector<FramePicture> pictures = {makeFrame("truth", 1), makeFrame("gather/15", 2)};
    pictures[1].linear = makePicture(4);
    FrameJudge frames;
    EXPECT_FALSE(listIds(judge(frames, pictures)[1]).contains("hdrFlip"));
    pictures[0].linear = makePicture(3);
    const auto judged = judge(frames, pictures);
    EXPECT_EQ(
        judged[1].record.picture.metrics.at("hdrFlip"),
        image::computeHdrFlip(makePicture(4), makePicture(3)).mean
    );
    EXPECT_FALSE(listIds(judged[0]).contains("hdrFlip"));
}

TEST(FrameJudge, PicturesAreWrittenOrAnErrorIsReported) {
    const test::TempFolder folder;
    std::vector<FramePicture> pictures = {makeFrame("truth", 1), makeFrame("gather/15", 2)};
    pictures[0].file = folder.path() / "truth.png";
    FrameJudge frames;
    judge(frames, pictures);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "truth.png"));
    pictures[1].file = folder.path() / "none" / "gather.png";
    test::expectRefused(frames.judge(pictures), "gather.png");
}

TEST(CachedTruth, ACachedTruthIsUsedIfBothPicturesHaveTheCasesSize) {
    const test::TempFolder folder;
    const TruthFiles files = nameTruthFiles(folder.path(), "truth");
    EXPECT_FALSE(readCachedTruth(nameTruthFiles("", "truth"), 4, 3));
    EXPECT_FALSE(readCachedTruth(files, 4, 3));
    TruthPictures drawn{image::Image(4, 3, 3), image::Image(4, 3, 3)};
    drawn.linear.at(3, 2, 1) = 40.5f;
    ASSERT_TRUE(writeTruth(files, drawn));
    const auto truth = readCachedTruth(files, 4, 3);
    ASSERT_TRUE(truth);
    EXPECT_EQ(truth->display.pixels.size(), 36u);
    EXPECT_EQ(truth->linear.at(3, 2, 1), 40.5f);
    // One without the other is what a run leaves that was killed between them.
    std::filesystem::remove(files.linear);
    EXPECT_FALSE(readCachedTruth(files, 4, 3));
}

TEST(CachedTruth, AnythingElseCountsAsNoneAndIsNamed) {
    const test::TempFolder folder;
    const TruthFiles files = nameTruthFiles(folder.path(), "truth");
    const image::Image good(4, 3, 3);
    const auto expectNone = [&](const std::filesystem::path& file, const char* mention) {
        testing::internal::CaptureStderr();
        EXPECT_FALSE(readCachedTruth(files, 4, 3)) << file;
        const std::string reported = testing::internal::GetCapturedStderr();
        EXPECT_NE(reported.find(file.filename().string()), std::string::npos) << reported;
        EXPECT_NE(reported.find(mention), std::string::npos) << reported;
    };
    for (const std::filesystem::path& file : {files.display, files.linear}) {
        ASSERT_TRUE(writeTruth(files, {good, good}));
        std::ignore = folder.write(file.filename().string(), "\x89PNG\r\n\x1A\n...");
        expectNone(file, "cannot read");
        ASSERT_TRUE(io::writeImage(file, image::Image(5, 3, 3)));
        expectNone(file, "is 5x3");
        ASSERT_TRUE(io::writeImage(file, image::Image(4, 3, 1)));
        expectNone(file, "with 1 channel,");
        std::filesystem::remove(file);
        std::filesystem::create_directory(file);
        expectNone(file, "it is not a file");
        std::filesystem::remove(file);
    }
}

} // namespace
} // namespace shutter::bench
