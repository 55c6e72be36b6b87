// SPDX-License-Identifier: MIT
#include "game/options/render_arguments.h"
#include "tests/unit/options/command_words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

namespace shutter::game {

namespace {

namespace fs = std::filesystem;

class RenderOptionsTest : public testing::Test {
  protected:
    RenderOptionsTest()
        : mFolder(fs::temp_directory_path() / fmt::format("shutter_options_{}", getpid())) {
        fs::create_directories(mFolder);
    }

    ~RenderOptionsTest() override { fs::remove_all(mFolder); }

    core::Result<RenderOptions> parse(Words words) const {
        words.insert(words.begin(), "scene.glb");
        const auto isOut = [](const std::string& word) { return word.starts_with("--out"); };
        if (std::none_of(words.begin(), words.end(), isOut))
            words.push_back("--out=" + (mFolder / "out.exr").string());
        RenderArguments arguments;
        const core::Status typed =
            parseWords(words, [&](CLI::App& command) { defineRenderOptions(command, arguments); });
        if (!typed)
            return typed.error();
        return interpret(arguments);
    }

    RenderOptions accept(const Words& words) const {
        auto options = parse(words);
        EXPECT_TRUE(options.ok()) << (options.ok() ? "" : options.error().message);
        return options.ok() ? options.value() : RenderOptions{};
    }

    void refuse(const std::string& option, const Words& words) const {
        expectRefused(parse(words), option);
    }

    fs::path mFolder;
};

} // namespace

TEST_F(RenderOptionsTest, TheDefaultsAreThoseOfTheHelp) {
    const RenderOptions options = accept(Words{});
    EXPECT_EQ(options.shot.width, 1280u);
    EXPECT_EQ(options.shot.height, 720u);
    EXPECT_EQ(options.shot.picture.frameFit, extract::FrameFit::Whole);
    EXPECT_EQ(options.shot.frameTimes, std::vector<double>{0.0});
    EXPECT_FALSE(options.shot.isSequence);
    EXPECT_DOUBLE_EQ(options.shot.shutter.exposureSeconds, 1.0 / 60.0);
    EXPECT_EQ(options.shot.shutter.phase, scene::ShutterPhase::End);
    EXPECT_STREQ(options.method.method->name, "resolved");
    EXPECT_EQ(options.method.samples, 15u);
    EXPECT_EQ(options.shot.pixel, extract::PixelModel::Centre);
    EXPECT_EQ(options.shot.background, math::vec3(0.18f));
    EXPECT_EQ(options.shot.ambient, math::vec3(0.25f));
    EXPECT_EQ(options.shot.picture.tonemap.op, tonemap::Operator::Neutral);
    EXPECT_TRUE(options.output.aovs.empty());
}

TEST_F(RenderOptionsTest, TheFitOfACamerasFrameIsOneOfTwoWords) {
    EXPECT_EQ(accept({"--frame-fit=height"}).shot.picture.frameFit, extract::FrameFit::Height);
    EXPECT_EQ(accept({"--frame-fit=whole"}).shot.picture.frameFit, extract::FrameFit::Whole);
    refuse("--frame-fit", {"--frame-fit=width"});
}

TEST_F(RenderOptionsTest, APartIsOneOfSeveralAndDrawsWhatOthersNeedNot) {
    const auto part = [&](Words more) {
        more.insert(more.begin(), {"--out=" + (mFolder / "f_%d.exr").string(), "--frames=0:3"});
        return more;
    };
    const RenderOptions options = accept(part({"--part=3/4"}));
    ASSERT_TRUE(options.output.part);
    EXPECT_EQ(options.output.part->index, 2u);
    EXPECT_EQ(options.output.part->count, 4u);
    EXPECT_EQ(options.fingerprint, accept(part({})).fingerprint) << "its pictures are the whole's";
    accept(part({"--part=1/1", "--aa=taa"}));
    for (const char* wrong :
         {"--part=0/2",
          "--part=3/2",
          "--part=1",
          "--part=1/2/3",
          "--part=a/b",
          "--part=-1/2",
          "--part=1/100000"})
        refuse("--part", part({wrong}));
    refuse("--part", {"--part=1/2"}); // a single picture
    for (const char* other : {"--stats=s.json", "--explain", "--dump-graph", "--repeat=2"})
        refuse("--part", part({"--part=1/2", other}));
    refuse("--aa taa", part({"--part=1/2", "--aa=taa"}));
    refuse("--budget", part({"--part=1/2", "--budget=8"}));
}

TEST_F(RenderOptionsTest, AFilmsCodecDeterminesItsDepthAndContainer) {
    const auto film = [&](Words more, const std::string& file = "film.mp4") {
        more.insert(more.begin(), {"--out=" + (mFolder / file).string(), "--frames=0:3"});
        return more;
    };
    const auto plain = accept(film({}));
    EXPECT_EQ(plain.output.video.codec, io::VideoCodec::H264);
    EXPECT_EQ(plain.output.video.bitDepth, 8u);
    EXPECT_FALSE(plain.output.isDeep());
    const auto deep = accept(film({"--codec=av1", "--bit-depth=10", "--timecode=01:00:00:23"}));
    EXPECT_EQ(deep.output.video.codec, io::VideoCodec::Av1);
    EXPECT_TRUE(deep.output.isDeep());
    EXPECT_EQ(deep.output.video.timecode, "01:00:00:23");
    EXPECT_NE(deep.fingerprint, plain.fingerprint) << "its frames are other files";
    const auto proRes = accept(film({"--codec=prores"}, "film.mov"));
    EXPECT_EQ(proRes.output.video.bitDepth, 10u);
    EXPECT_EQ(proRes.fingerprint, deep.fingerprint) << "its frames are the same files";
    refuse("--codec", film({"--codec=vp9"}));
    refuse("--codec prores needs", film({"--codec=prores"}));
    refuse("--bit-depth 8", film({"--codec=prores", "--bit-depth=8"}, "film.mov"));
    refuse("--bit-depth 12", film({"--bit-depth=12"}));
    for (const char* wrong : {"1:00:00:00", "00:60:00:00", "00:00:00;00", "frames"})
        refuse("--timecode", film({std::string("--timecode=") + wrong}));
    for (const char* option : {"--codec=av1", "--bit-depth=10", "--timecode=frame"})
        refuse("FILE.mp4", Words{option});
}

TEST_F(RenderOptionsTest, ASequenceOfExrTakesATimeCodeAndOtherPicturesNone) {
    const auto pictures = [&](const char* file, const char* timecode) {
        return Words{"--out=" + (mFolder / file).string(), "--frames=0:3", timecode};
    };
    const auto timed = accept(pictures("f_%d.exr", "--timecode=01:00:00:23"));
    EXPECT_EQ(timed.output.video.timecode, "01:00:00:23");
    EXPECT_NE(timed.fingerprint, accept(pictures("f_%d.exr", "--timecode=01:00:00:22")).fingerprint)
        << "it is in each picture";
    refuse("--timecode", pictures("f_%d.exr", "--timecode=1:0:0:0"));
    refuse("a sequence of EXR", pictures("f_%d.png", "--timecode=frame"));
    refuse("a sequence of EXR", Words{"--out=" + (mFolder / "f.exr").string(), "--timecode=frame"});
}

TEST_F(RenderOptionsTest, AValueThatIsNoNumberOrNoneOfAListIsRefused) {
    for (const std::string option :
         {"--time",
          "--fps",
          "--exposure",
          "--shutter-angle",
          "--samples",
          "--seed",
          "--ev",
          "--repeat"})
        refuse(option, Words{option + "=1x"});
    for (const std::string option : {"--pixel", "--rays", "--aov", "--background"})
        refuse(option, Words{option + "=nosuch"});
    for (const char* samples : {"-1", "0", "257", "99999999999"})
        refuse("--samples", Words{std::string("--samples=") + samples});
    refuse("--repeat", Words{"--repeat=0"});
}

TEST_F(RenderOptionsTest, SizesAreTakenAndBadOnesRefused) {
    EXPECT_EQ(accept(Words{"--size=1x16384"}).shot.height, 16384u);
    for (const char* size :
         {"",
          "0x0",
          "0x5",
          "5x0",
          "12",
          "12x",
          "x12",
          "-1x5",
          "16385x1",
          "99999x1",
          "1.5x2",
          "64x36x3",
          " 64x36",
          "64X36",
          "999999999999x1"})
        refuse("--size", Words{"--size=" + wordOf(size)});
}

TEST_F(RenderOptionsTest, ATimeIsAFiniteNumberOfSeconds) {
    EXPECT_EQ(accept(Words{"--time=-2.5"}).shot.frameTimes, std::vector<double>{-2.5});
    for (const double time : {kNan, kInfinity, -kInfinity, 1e300})
        refuse("--time", Words{"--time=" + wordOf(time)});
}

TEST_F(RenderOptionsTest, FramesAreTimesOfTheirNumbers) {
    const RenderOptions options =
        accept(Words{"--frames=-1:2", "--fps=10.0", "--out=" + (mFolder / "f_%04d.png").string()});
    EXPECT_EQ(options.shot.frameTimes, (std::vector<double>{-0.1, 0.0, 0.1, 0.2}));
    EXPECT_EQ(options.shot.firstFrame, -1);
    EXPECT_TRUE(options.shot.isSequence);
}

TEST_F(RenderOptionsTest, BadFramesAreRefused) {
    for (const char* frames : {"5:1", "1", ":", "1:", "a:b", "0:1000000", "1:2:3", "0.5:2"})
        refuse(
            "--frames",
            Words{"--frames=" + wordOf(frames), "--out=" + (mFolder / "f_%04d.png").string()}
        );
    for (const double fps : {0.0, -24.0, kNan, kInfinity})
        refuse("--fps", Words{"--fps=" + wordOf(fps)});
    for (const char* fps : {"0/1", "1/0", "-24000/1001", "24000 / 1001", "24000/1001/1", "x"})
        refuse("--fps", Words{std::string("--fps=") + fps});
    // Times that overflow.
    refuse("--frames", Words{"--frames=1:2", "--fps=1e-310"});
}

TEST_F(RenderOptionsTest, ASequenceNeedsANumberInItsName) {
    refuse("--out", Words{"--frames=0:1"});
    refuse(".png, .jpg, .mp4 or .mov", Words{"--out=film.avi"});
    accept(Words{"--frames=3:3"});
    accept(Words{"--frames=0:1", "--out=" + (mFolder / "f%d.png").string()});
}

TEST_F(RenderOptionsTest, AShutterAngleIsAShareOfAFrame) {
    const auto exposure = [&](const Words& words) {
        const RenderOptions options = accept(words);
        return scene::computeExposureSeconds(options.shot.shutter, options.shot.frameSeconds);
    };
    EXPECT_DOUBLE_EQ(exposure(Words{"--shutter-angle=180.0"}), 1.0 / 48.0);
    EXPECT_DOUBLE_EQ(exposure(Words{"--shutter-angle=360.0", "--fps=50.0"}), 0.02);
    EXPECT_EQ(exposure(Words{"--exposure=0.0"}), 0.0);
    EXPECT_EQ(exposure(Words{"--exposure=0.25"}), 0.25);
}

TEST_F(RenderOptionsTest, BadExposuresAreRefused) {
    for (const double value : {-0.1, kNan, kInfinity, 1e300}) {
        refuse("--exposure", Words{"--exposure=" + wordOf(value)});
        refuse("--shutter-angle", Words{"--shutter-angle=" + wordOf(value)});
    }
    refuse("--shutter-angle", Words{"--exposure=0.1", "--shutter-angle=180.0"});
}

TEST_F(RenderOptionsTest, PhasesHaveTheirNames) {
    using scene::ShutterPhase;
    const auto phase = [&](const char* name) {
        return accept(Words{"--phase=" + wordOf(name)}).shot.shutter.phase;
    };
    EXPECT_EQ(phase("start"), ShutterPhase::Start);
    EXPECT_EQ(phase("centre"), ShutterPhase::Centre);
    EXPECT_EQ(phase("end"), ShutterPhase::End);
    for (const char* name : {"", "center", "END", "middle"})
        refuse("--phase", Words{"--phase=" + wordOf(name)});
}

TEST_F(RenderOptionsTest, AnUnknownMethodIsRefusedWithThoseThereAre) {
    for (const char* name : {"", "Hybrid", "nosuch"})
        refuse("--method", Words{"--method=" + wordOf(name)});
    refuse(
        "gather, hybrid, resolved, adaptive, denoised, accumulate, truth", Words{"--method=nosuch"}
    );
}

TEST_F(RenderOptionsTest, NoMethodMeansTheBlursOwnDefault) {
    const MethodOptions method = accept(Words{}).method;
    EXPECT_EQ(method.method->blur, &motion_blur::getDefaultMethod());
    EXPECT_EQ(method.motionBlur, motion_blur::complete({}));
}

TEST_F(RenderOptionsTest, NoSamplesMeansTheMethodsOwnNumber) {
    const auto samples = [&](const char* method, uint32_t count) {
        return accept(Words{"--method=" + wordOf(method), "--samples=" + wordOf(count)});
    };
    EXPECT_EQ(accept(Words{"--method=gather"}).method.motionBlur.sampleCount, 15u);
    EXPECT_EQ(samples("gather", 256).method.motionBlur.sampleCount, 256u);
    EXPECT_EQ(accept(Words{"--method=accumulate"}).method.samples, 256u);
    EXPECT_EQ(samples("accumulate", 1).method.samples, 1u);
    EXPECT_EQ(samples("accumulate", 65536).method.samples, 65536u);
    EXPECT_EQ(accept(Words{"--method=truth"}).method.samples, 256u);
    EXPECT_EQ(accept(Words{"--method=sharp"}).method.samples, 0u);
    refuse("--samples 0 must lie in [1, 256]", Words{"--method=gather", "--samples=0"});
    for (const char* method : {"accumulate", "truth", "sharp"})
        refuse(
            "--samples 0 must lie in [1, 65536]", Words{"--method=" + wordOf(method), "--samples=0"}
        );
    for (const char* method : {"gather", "hybrid"})
        refuse("--samples", Words{"--method=" + wordOf(method), "--samples=257"});
    refuse("--samples", Words{"--method=accumulate", "--samples=65537"});
}

TEST_F(RenderOptionsTest, InstantsFollowTheMotionWhereTheyAreAuto) {
    const Words autoWords{"--method=accumulate", "--instants=auto"};
    EXPECT_EQ(accept(autoWords).method.maxStepPx, 1.0);
    EXPECT_EQ(accept(autoWords).method.samples, 1024u); // at most
    EXPECT_EQ(accept(Words{"--method=accumulate"}).method.maxStepPx, std::nullopt);
    const RenderOptions chosen =
        accept(Words{"--method=accumulate", "--instants=auto", "--max-step=0.25", "--samples=64"});
    EXPECT_EQ(chosen.method.maxStepPx, 0.25);
    EXPECT_EQ(chosen.method.samples, 64u);
    refuse("--instants '16' is not auto", Words{"--method=accumulate", "--instants=16"});
    refuse("--instants auto is for accumulate", Words{"--method=truth", "--instants=auto"});
    refuse("--max-step requires --instants auto", Words{"--method=accumulate", "--max-step=1"});
    refuse(
        "--max-step 0 must lie in", Words{"--method=accumulate", "--instants=auto", "--max-step=0"}
    );
    refuse(
        "--max-step nan must lie in",
        Words{"--method=accumulate", "--instants=auto", "--max-step=nan"}
    );
}

TEST_F(RenderOptionsTest, ALensIsForMethodsThatHaveOne) {
    EXPECT_FALSE(accept(Words{}).shot.fStop);
    const ShotOptions shot = accept(Words{"--method=accumulate", "--fstop=2.8", "--focus=3"}).shot;
    EXPECT_EQ(shot.fStop, 2.8);
    EXPECT_EQ(shot.focusDistance, 3.0);
    EXPECT_EQ(accept(Words{"--fstop=0"}).shot.fStop, 0.0) << "a pinhole is for all";
    EXPECT_NE(
        accept(Words{"--method=truth"}).fingerprint,
        accept(Words{"--method=truth", "--fstop=8"}).fingerprint
    );
    for (const char* word : {"--fstop=2.8", "--focus=3"})
        refuse(std::string(word).substr(0, 7), Words{"--method=gather", word});
    refuse("method gather has no lens yet", Words{"--method=gather", "--fstop=2.8"});
    for (const char* bad : {"-1", "nan", "inf", "1e99", "x", ""}) {
        refuse("--fstop", Words{"--method=truth", std::string("--fstop=") + bad});
        refuse("--focus", Words{"--method=truth", std::string("--focus=") + bad});
    }
    refuse("--focus", Words{"--method=truth", "--focus=0"});
    EXPECT_EQ(accept(Words{"--method=truth", "--focus-entity=x"}).shot.focusEntity, "x");
    refuse("--focus-entity: method gather", Words{"--method=gather", "--focus-entity=x"});
    refuse("--focus", Words{"--method=truth", "--focus=3", "--focus-entity=x"});
    refuse("fStop", Words{"--method=truth", "--fstop=0.001"});
}

TEST_F(RenderOptionsTest, OnlyManySamplesFillAPixel) {
    EXPECT_EQ(
        accept(Words{"--method=accumulate", "--pixel=box"}).shot.pixel, extract::PixelModel::Box
    );
    EXPECT_EQ(accept(Words{"--method=truth", "--pixel=box"}).shot.pixel, extract::PixelModel::Box);
    refuse("--pixel", Words{"--pixel=box"});
    refuse("--pixel", Words{"--pixel=gauss"});
}

TEST_F(RenderOptionsTest, AnErrorToStopAtIsAboveZeroAndTruths) {
    const auto truth = [](double error) {
        return Words{"--method=truth", "--error=" + wordOf(error)};
    };
    EXPECT_EQ(accept(truth(0.01)).method.error, 0.01);
    EXPECT_FALSE(accept(Words{"--method=truth"}).method.error.has_value());
    for (const double bad : {0.0, -1.0, kNan, kInfinity})
        refuse("--error", truth(bad));
    for (const char* method : {"sharp", "hybrid", "accumulate"})
        refuse("--error", Words{"--method=" + wordOf(method), "--error=0.01"});
}

TEST_F(RenderOptionsTest, EverySettingCanBeSet) {
    const motion_blur::MotionBlurSettings settings = accept(Words{
                                                                "--method=hybrid",
                                                                "--set=tileSizePx=20",
                                                                "--set=neighbourhoodTiles=5",
                                                                "--set=recursionLimit=9",
                                                                "--set=softDepthExtent=0.5",
                                                                "--set=edgeThreshold=0.25",
                                                                "--set=luminanceThreshold=0.125",
                                                                "--set=foregroundMagnification=12",
                                                                "--set=backgroundMagnification=6",
                                                                "--set=jitter=0",
                                                                "--set=objectTest=luminance",
                                                                "--set=revealTraversal=stepping"})
                                                         .method.motionBlur;
    EXPECT_EQ(settings.tileSizePx, 20u);
    EXPECT_EQ(settings.neighbourhoodTiles, 5u);
    EXPECT_EQ(settings.recursionLimit, 9u);
    EXPECT_EQ(settings.softDepthExtent, 0.5f);
    EXPECT_EQ(settings.edgeThreshold, 0.25f);
    EXPECT_EQ(settings.luminanceThreshold, 0.125f);
    EXPECT_EQ(settings.foregroundMagnification, 12.0f);
    EXPECT_EQ(settings.backgroundMagnification, 6.0f);
    EXPECT_EQ(settings.jitter, 0.0f);
    EXPECT_EQ(settings.objectTest, motion_blur::ObjectTest::Luminance);
    EXPECT_EQ(settings.revealTraversal, motion_blur::RevealTraversal::Stepping);
    EXPECT_EQ(
        accept(Words{"--method=hybrid", "--set=revealTraversal=single"})
            .method.motionBlur.revealTraversal,
        motion_blur::RevealTraversal::Single
    );
    EXPECT_EQ(
        accept(Words{"--method=hybrid", "--set=objectTest=mesh_id"}).method.motionBlur.objectTest,
        motion_blur::ObjectTest::MeshId
    );
}

TEST_F(RenderOptionsTest, TheRivalsSettingsCanBeSet) {
    const auto with = [&](const char* method, const std::vector<std::string>& settings) {
        Words words{"--method=" + wordOf(method)};
        for (const std::string& setting : settings)
            words.push_back("--set=" + setting);
        return accept(words).method.motionBlur;
    };
    const auto guertin = with("guertin2014", {"centreBias=20", "speedThresholdPx=3"});
    EXPECT_EQ(guertin.method, &motion_blur::getMethod("guertin2014"));
    EXPECT_EQ(guertin.sampleCount, 35u);
    EXPECT_EQ(guertin.centreBias, 20.0f);
    EXPECT_EQ(guertin.speedThresholdPx, 3.0f);
    using motion_blur::OccluderTest;
    EXPECT_EQ(with("own_velocity", {"occluderTest=velocity"}).occluderTest, OccluderTest::Velocity);
    EXPECT_EQ(with("own_velocity", {"occluderTest=none"}).occluderTest, OccluderTest::None);
    EXPECT_EQ(with("jimenez2014", {"softDepthExtent=1"}).softDepthExtent, 1.0f);
    EXPECT_EQ(with("mcguire2012", {"tileSizePx=20"}).tileSizePx, 20u);
}

TEST_F(RenderOptionsTest, ASettingOfAnotherMethodIsRefused) {
    // Each name is some method's, and each method lacks some.
    for (const MethodInfo& method : listMethods()) {
        const bool blurs = method.family == MethodFamily::MotionBlur;
        const char* foreign =
            method.name == std::string("own_velocity") ? "tileSizePx=20" : "occluderTest=none";
        refuse(method.name, Words{"--method=" + wordOf(method.name), "--set=" + wordOf(foreign)});
        const auto& settings = blurs ? method.blur->settings : std::vector<std::string_view>{};
        if (std::find(settings.begin(), settings.end(), "jitter") != settings.end())
            accept(Words{"--method=" + wordOf(method.name), "--set=jitter=0.5"});
        else
            refuse("--set 'jitter'", Words{"--method=" + wordOf(method.name), "--set=jitter=0.5"});
    }
}

TEST_F(RenderOptionsTest, BadSettingsAreRefused) {
    for (const char* setting :
         {"",
          "jitter",
          "jitter=",
          "jitter=x",
          "jitter=nan",
          "jitter=inf",
          "jitter=2",
          "jitter=0.5x",
          "nosuch=1",
          "=1",
          "tileSizePx=1.5",
          "tileSizePx=-1",
          "tileSizePx=0",
          "tileSizePx=1e30",
          "neighbourhoodTiles=4",
          "objectTest=nosuch",
          "revealTraversal=nosuch"})
        refuse("--set", Words{"--set=" + wordOf(setting)});
}

TEST_F(RenderOptionsTest, IntermediatesAreTheMethodsOwn) {
    const auto aovs = [&](const char* method, const char* names) {
        return accept(Words{"--method=" + wordOf(method), "--aov=" + wordOf(names)}).output.aovs;
    };
    EXPECT_EQ(aovs("sharp", "depth,motion"), (std::set<std::string>{"depth", "motion"}));
    EXPECT_EQ(aovs("sharp", "all").size(), 4u);
    EXPECT_EQ(aovs("gather", "all").size(), 7u);
    EXPECT_EQ(aovs("hybrid", "all").size(), 11u);
    EXPECT_EQ(aovs("own_velocity", "all").size(), 5u);
    EXPECT_EQ(aovs("guertin2014", "variance,tiles").size(), 2u);
    for (const char* names : {"nosuch", "motion,", ",", "motion,nosuch", "Motion", "motion depth"})
        refuse("--aov", Words{"--aov=" + wordOf(names)});
    refuse("--aov", Words{"--method=gather", "--aov=mask"});
}

TEST_F(RenderOptionsTest, TheExtensionDecidesWhetherAPictureIsForDisplays) {
    const auto isDisplay = [&](const char* name) {
        return accept(Words{"--out=" + (mFolder / name).string()}).output.displayOut;
    };
    EXPECT_FALSE(isDisplay("a.exr"));
    EXPECT_TRUE(isDisplay("a.png"));
    EXPECT_TRUE(isDisplay("a.JPG"));
    for (const char* name : {"a.bmp", "a", "png"})
        refuse("--out", Words{"--out=" + (mFolder / name).string()});
}

TEST_F(RenderOptionsTest, OutputsNeedAFolderThatIsThere) {
    fs::create_directory(mFolder / "folder.png");
    for (const char* name : {"a.png/b.png", "nosuch/a.png", "folder.png"}) {
        const core::Status checked =
            checkOutputs(accept(Words{"--out=" + (mFolder / name).string()}));
        ASSERT_FALSE(checked.ok()) << name;
        EXPECT_NE(checked.error().message.find("--out"), std::string::npos);
    }
    for (const auto& stats : {mFolder / "nosuch" / "s.json", mFolder}) {
        const core::Status checked =
            checkOutputs(accept(Words{"--stats=" + wordOf(stats.string())}));
        ASSERT_FALSE(checked.ok()) << stats;
        EXPECT_NE(checked.error().message.find("--stats"), std::string::npos);
    }
    EXPECT_TRUE(checkOutputs(accept(Words{"--stats=" + (mFolder / "s.json").string()})));
}

TEST_F(RenderOptionsTest, InterpretingWritesNothing) {
    accept(Words{"--stats=" + (mFolder / "s.json").string()});
    EXPECT_TRUE(fs::is_empty(mFolder));
}

TEST_F(RenderOptionsTest, AntiAliasingIsAboutTheRasterImage) {
    EXPECT_EQ(accept(Words{}).shot.picture.antiAliasing, AntiAliasing::None);
    EXPECT_EQ(accept(Words{"--aa=taa"}).shot.picture.antiAliasing, AntiAliasing::Taa);
    EXPECT_EQ(
        accept(Words{"--aa=box", "--method=resolved"}).shot.picture.antiAliasing, AntiAliasing::Box
    );
    refuse("--aa", Words{"--aa=msaa"});
    for (const std::string method : {"accumulate", "truth", "denoised"})
        for (const char* aa : {"--aa=taa", "--aa=box"})
            refuse("--aa is about the raster image", Words{aa, "--method=" + method});
}

TEST_F(RenderOptionsTest, BloomHasAShareAThresholdAndAKnee) {
    EXPECT_EQ(accept(Words{}).shot.picture.bloom.threshold, 1.0f);
    EXPECT_EQ(accept(Words{}).shot.picture.bloom.knee, 0.5f);
    EXPECT_EQ(accept(Words{"--bloom-threshold=0"}).shot.picture.bloom.threshold, 0.0f);
    EXPECT_EQ(accept(Words{"--bloom-knee=1"}).shot.picture.bloom.knee, 1.0f);
    for (const double value : {-0.1, 65001.0})
        refuse("--bloom-threshold", Words{"--bloom-threshold=" + wordOf(value)});
    for (const double value : {-0.1, 1.1})
        refuse("--bloom-knee", Words{"--bloom-knee=" + wordOf(value)});
    EXPECT_EQ(accept(Words{}).shot.picture.bloom.share, 0.0f);
    EXPECT_EQ(accept(Words{"--bloom=0.05"}).shot.picture.bloom.share, 0.05f);
    for (const double value : {-0.01, 1.5, kNan, kInfinity})
        refuse("--bloom", Words{"--bloom=" + wordOf(value)});
}

TEST_F(RenderOptionsTest, ShadowsAreOffByDefault) {
    EXPECT_EQ(accept(Words{}).shot.picture.shadows.mode, extract::ShadowMode::None);
    EXPECT_EQ(
        accept(Words{"--shadows=sharp"}).shot.picture.shadows.mode, extract::ShadowMode::Sharp
    );
    EXPECT_EQ(
        accept(Words{"--shadows=blurred"}).shot.picture.shadows.mode, extract::ShadowMode::Blurred
    );
    refuse("--shadows", Words{"--shadows=soft"});
}

TEST_F(RenderOptionsTest, SizesDistancesAndInstantsOfShadowsHaveRanges) {
    EXPECT_EQ(accept(Words{"--shadow-map-size=2048"}).shot.picture.shadows.mapSize, 2048u);
    for (const char* value : {"0", "32", "100", "8256"})
        refuse("--shadow-map-size", Words{std::string("--shadow-map-size=") + value});
    EXPECT_EQ(accept(Words{"--shadow-distance=30"}).shot.picture.shadows.distance, 30.0);
    for (const double value : {-1.0, kNan, kInfinity})
        refuse("--shadow-distance", Words{"--shadow-distance=" + wordOf(value)});
    EXPECT_EQ(accept(Words{"--shadow-instants=8"}).shot.picture.shadows.instants, 8u);
    for (const char* value : {"0", "65"})
        refuse("--shadow-instants", Words{std::string("--shadow-instants=") + value});
}

TEST_F(RenderOptionsTest, SurroundingsAreAFileOrASkyWithinTheirRanges) {
    EXPECT_EQ(accept(Words{}).shot.turbidity, 0.0);
    EXPECT_TRUE(accept(Words{}).shot.environment.empty());
    EXPECT_EQ(accept(Words{"--sky=2.5"}).shot.turbidity, 2.5);
    for (const double value : {-1.0, 1.0, 10.5, kNan, kInfinity})
        refuse("--sky", Words{"--sky=" + wordOf(value)});
    EXPECT_EQ(accept(Words{"--environment=a.hdr"}).shot.environment, "a.hdr");
    refuse("exclude", Words{"--environment=a.hdr", "--sky=2.5"});
    EXPECT_EQ(accept(Words{"--environment-intensity=3"}).shot.surroundings.intensity, 3.0);
    for (const double value : {-1.0, 1001.0, kNan, kInfinity})
        refuse("--environment-intensity", Words{"--environment-intensity=" + wordOf(value)});
    EXPECT_EQ(accept(Words{"--environment-rotation=-90"}).shot.surroundings.rotationDegrees, -90.0);
    for (const double value : {-361.0, 400.0, kNan, kInfinity})
        refuse("--environment-rotation", Words{"--environment-rotation=" + wordOf(value)});
}

TEST_F(RenderOptionsTest, ToneMappingHasTwoOperatorsAndABoundedGain) {
    EXPECT_EQ(accept(Words{"--tonemap=none"}).shot.picture.tonemap.op, tonemap::Operator::None);
    EXPECT_EQ(accept(Words{"--unlit"}).shot.picture.tonemap.op, tonemap::Operator::None);
    EXPECT_EQ(accept(Words{"--ev=-32.0"}).shot.picture.tonemap.exposureValue, -32.0);
    refuse("--tonemap", Words{"--tonemap=aces"});
    for (const double value : {32.5, -33.0, kNan, kInfinity})
        refuse("--ev", Words{"--ev=" + wordOf(value)});
}

TEST_F(RenderOptionsTest, AFractionOfFramesASecondIsExact) {
    const auto drawn = [&](const char* fps) {
        return accept(Words{
            "--frames=24:25",
            std::string("--fps=") + fps,
            "--out=" + (mFolder / "f_%04d.png").string()});
    };
    const RenderOptions ntsc = drawn("24000/1001");
    EXPECT_EQ(ntsc.shot.fps, core::FrameRate(24000.0, 1001.0));
    EXPECT_EQ(ntsc.shot.frameTimes, (std::vector<double>{1.001, 25.0 * 1001.0 / 24000.0}));
    EXPECT_EQ(ntsc.shot.frameSeconds, 1001.0 / 24000.0);
    const RenderOptions decimal = drawn("23.976");
    EXPECT_EQ(decimal.shot.fps, core::FrameRate(23.976));
    EXPECT_EQ(decimal.shot.frameTimes.front(), 24.0 / 23.976);
    EXPECT_NE(ntsc.fingerprint, drawn("23.976023976023978").fingerprint);
}

TEST_F(RenderOptionsTest, ANumberInAFoldersNameNumbersNoFrames) {
    refuse(
        "needs a frame number such as %04d in the file's own name",
        Words{"--frames=0:1", "--out=" + (mFolder / "%04d" / "f.png").string()}
    );
}

TEST_F(RenderOptionsTest, ColoursAreThreeNumbersThatAPictureCanHold) {
    EXPECT_EQ(
        accept(Words{"--background=0,0.5,65000"}).shot.background, math::vec3(0.0f, 0.5f, 65000.0f)
    );
    for (const char* color :
         {"", "1", "1,2", "1,2,3,4", "1,,3", "a,b,c", "-1,0,0", "nan,0,0", "1e30,0,0", "1,2,3 "}) {
        refuse("--background", Words{"--background=" + wordOf(color)});
        refuse("--ambient", Words{"--ambient=" + wordOf(color)});
    }
}

TEST(FrameFile, TheNumberIsFilledWithZeros) {
    EXPECT_EQ(frameFile("a_%04d.png", 7), fs::path("a_0007.png"));
    EXPECT_EQ(frameFile("a_%d.png", 7), fs::path("a_7.png"));
    EXPECT_EQ(frameFile("a_%3d.png", 7), fs::path("a_007.png"));
    EXPECT_EQ(frameFile("a_%02d.png", 123), fs::path("a_123.png"));
    EXPECT_EQ(frameFile("a_%010d.png", 7), fs::path("a_0000000007.png"));
    EXPECT_EQ(frameFile("a_%04d.png", -7), fs::path("a_-007.png"));
}

TEST(FrameFile, ANumberStandsInTheFilesOwnNameAndNotInThatOfAFolder) {
    for (const char* folder : {"%d day", "%04d", "100%%", "50%20off", "a/%d/b", "Größe_🎥", "-x\n"})
        EXPECT_EQ(frameFile(fs::path(folder) / "f_%04d.png", 7), fs::path(folder) / "f_0007.png")
            << folder;
    EXPECT_EQ(frameFile("%d/a.png", 7), fs::path("%d/a.png"));
    EXPECT_EQ(frameFile("./x//f%d.png", 7).string(), "./x//f7.png");
}

TEST(FrameFile, EveryNumberIsTheFramesAndTwoPercentSignsAreOne) {
    EXPECT_EQ(frameFile("%d_of_%03d.png", 7), fs::path("7_of_007.png"));
    EXPECT_EQ(frameFile("100%%_%d.png", 7), fs::path("100%_7.png"));
    EXPECT_EQ(frameFile("%%d_%%%d%%.png", 7), fs::path("%d_%7%.png"));
}

TEST(FrameFile, ANameWithoutANumberStaysAsItIs) {
    for (const char* name : {"a.png", "100%.png", "a%s.png", ""})
        EXPECT_EQ(frameFile(name, 7), fs::path(name));
}

} // namespace shutter::game
