// SPDX-License-Identifier: MIT
// What `shutter render` takes and refuses, names of frames, and errors as one line.
#include "engine/scene/shutter.h"
#include "game/options/option_rows.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"
#include "tests/support/rows.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/options/command_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace shutter::game {
namespace {

namespace fs = std::filesystem;

using scene::CameraShutter;
using scene::ResponseShape;
using scene::ShutterMode;
using scene::ShutterPhase;

core::Result<RenderOptions> parse(Words words) {
    words.insert(words.begin(), "scene.glb");
    const auto isOut = [](const std::string& word) { return word.starts_with("--out"); };
    if (std::none_of(words.begin(), words.end(), isOut))
        words.push_back("--out=out.exr");
    RenderArguments arguments;
    const core::Status typed =
        parseWords(words, [&](CLI::App& command) { defineRenderOptions(command, arguments); });
    if (!typed)
        return typed.error();
    return interpret(arguments);
}

/// Of words with a space between them.
Words wordsOf(const std::string& text) {
    return text.empty() ? Words{} : splitAt(text, ' ');
}

RenderOptions accept(const std::string& words) {
    auto options = parse(wordsOf(words));
    EXPECT_TRUE(options.ok()) << words << ": " << (options.ok() ? "" : options.error().message);
    return options.ok() ? options.value() : RenderOptions{};
}

/// The error has `part` in it, is one line and ends without a full stop.
void refuse(const std::string& part, const Words& words) {
    const auto options = parse(words);
    ASSERT_FALSE(options.ok()) << part << ": " << words.back();
    const std::string& message = options.error().message;
    EXPECT_NE(message.find(part), std::string::npos) << words.back() << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.back(), '.') << message;
}

void refuse(const std::string& part, const std::string& words) {
    refuse(part, wordsOf(words));
}

/// What an option refuses beside other words, which alone are accepted: values with a bar between.
struct Refused {
    const char* option;
    const char* values;
    const char* besides = "";
};

constexpr const char* kFrames = "--out=f_%04d.exr --frames=0:3";
constexpr const char* kFilm = "--out=film.mp4 --frames=0:3";
constexpr const char* kNoColours =
    "nosuch||1|1,2|1,2,3,4|1,,3|a,b,c|-1,0,0|nan,0,0|1e30,0,0|1,2,3 ";

constexpr Refused kRefused[] = {
    {"--aa", "msaa"},
    {"--ambient", kNoColours},
    {"--aov", "nosuch|motion,|,|motion,nosuch|Motion|motion depth"},
    {"--aov", "mask", "--method=gather"},
    {"--background", kNoColours},
    {"--bit-depth", "12", kFilm},
    {"--bloom", "-0.01|1.5|nan|inf"},
    {"--bloom-knee", "-0.1|1.1"},
    {"--bloom-threshold", "-0.1|65001"},
    {"--camera-rotation-blur", "-0.1|2.1|nan|inf"},
    {"--camera-translation-blur", "-0.1|2.1|nan|inf"},
    {"--codec", "vp9", kFilm},
    {"--cut-angle", "0|-1|nan|inf"},
    {"--cut-angle", "5", "--cut-detection=off"},
    {"--cut-detection", "|yes|ON"},
    {"--cut-distance", "0|-1|nan|inf"},
    {"--cut-distance", "5", "--cut-detection=off"},
    {"--environment-intensity", "-1|1001|nan|inf"},
    {"--environment-rotation", "-361|400|nan|inf"},
    {"--error", "0|-1|nan|inf", "--method=truth"},
    {"--error", "0.01", "--method=sharp"},
    {"--error", "0.01", "--method=hybrid"},
    {"--error", "0.01", "--method=accumulate"},
    {"--ev", "1x|32.5|-33|nan|inf"},
    {"--exposure", "1x|-0.1|nan|inf|1e300|1/48"},
    {"--focus", "|0|-1|nan|inf|1e99|x", "--method=truth"},
    {"--focus", "3", "--method=gather"},
    {"--focus", "3", "--method=truth --focus-entity=x"},
    {"--fps", "1x|x|0|-24|nan|inf|0/1|1/0|-24000/1001|24000 / 1001|24000/1001/1"},
    {"--frame-fit", "width"},
    {"--frames", "5:1|1|:|1:|a:b|0:1000000|1:2:3|0.5:2", "--out=f_%04d.png"},
    {"--frames", "1:2", "--out=f_%d.png --fps=1e-310"}, // times that overflow
    {"--fstop", "|-1|nan|inf|1e99|x", "--method=truth"},
    {"--fstop", "2.8", "--method=gather"},
    {"--method", "|Hybrid|nosuch"},
    {"--object-blur", "-0.1|2.1|nan|inf"},
    {"--out", "a.bmp|a|png"},
    {"--out", "f.png", "--frames=0:1"}, // a sequence needs a number in its name
    {"--part", "0/2|3/2|1|1/2/3|a/b|-1/2|1/100000", kFrames},
    {"--part", "1/2"}, // of a single picture
    {"--phase", "|center|END|middle"},
    {"--pixel", "nosuch|gauss|box"}, // only many samples fill a pixel
    {"--rays", "nosuch"},
    {"--reference-fps", "24"},
    {"--reference-fps", "0|-1|nan|inf|0/1|1/0|2002/1", "--shutter-mode=capped"},
    {"--repeat", "1x|0"},
    {"--response", "|round|box:|box:1|triangle:1|trapezoid|trapezoid:|trapezoid:0.1"},
    {"--response", "trapezoid:0.1,0.2,0.3|trapezoid:0.6,0.5|trapezoid:-0.1,0.5"},
    {"--response", "trapezoid:nan,0.5|trapezoid:a,b|samples|samples:1|samples:0,0"},
    {"--response", "samples:1,-1|samples:1,inf|samples:1,,1|samples:1,1,"},
    {"--samples", "1x|-1|0|257|99999999999"},
    {"--samples", "257", "--method=gather"},
    {"--samples", "257", "--method=hybrid"},
    {"--samples", "65537", "--method=accumulate"},
    {"--seed", "1x"},
    {"--set", "|jitter|jitter=|jitter=x|jitter=nan|jitter=inf|jitter=2|jitter=0.5x|nosuch=1|=1"},
    {"--set", "tileSizePx=1.5|tileSizePx=-1|tileSizePx=0|tileSizePx=1e30|neighbourhoodTiles=4"},
    {"--set", "objectTest=nosuch|revealTraversal=nosuch"},
    {"--shadow-distance", "-1|nan|inf"},
    {"--shadow-instants", "0|65"},
    {"--shadow-map-size", "0|32|100|8256"},
    {"--shadows", "soft"},
    {"--shutter-angle", "1x|-0.1|nan|inf|1e300"},
    {"--shutter-angle", "180", "--exposure=0.1"},
    {"--shutter-mode", "Physical|box|angle |180"},
    {"--shutter-mode", "physical", "--shutter-angle=180"},
    {"--shutter-mode", "angle|capped", "--exposure=0.1"},
    {"--size", "|0x0|0x5|5x0|12|12x|x12|-1x5|16385x1|99999x1|1.5x2|64x36x3| 64x36|64X36"},
    {"--size", "999999999999x1"},
    {"--sky", "-1|1|10.5|nan|inf"},
    {"--time", "1x|nan|inf|-inf|1e300"},
    {"--timecode", "1:00:00:00|00:60:00:00|00:00:00;00|frames", kFilm},
    {"--timecode", "1:0:0:0", kFrames},
    {"--tonemap", "aces"}};

TEST(RenderOptions, EachOptionRefusesValuesThatItDoesNotTakeByItsName) {
    for (const Refused& refused : kRefused)
        for (const std::string& value : test::rowsOf(refused.values)) {
            Words words = wordsOf(refused.besides);
            words.push_back(refused.option + ("=" + value));
            refuse(refused.option, words);
        }
    std::string many = "--response=samples:1";
    for (int i = 0; i < 64; ++i)
        many += ",1";
    refuse("--response", many);
}

TEST(RenderOptions, OptionsThatDoNotFitTogetherAreRefusedWithTheReason) {
    const std::string frames = kFrames;
    const std::string film = kFilm;
    const std::pair<const char*, std::string> kPairs[] = {
        {"--aa taa", frames + " --part=1/2 --aa=taa"},
        {"--preset balanced sets --aa taa", frames + " --part=1/2 --preset=balanced"},
        {"--budget", frames + " --part=1/2 --budget=8"},
        {"--part", frames + " --part=1/2 --stats=s.json"},
        {"--part", frames + " --part=1/2 --explain"},
        {"--part", frames + " --part=1/2 --dump-graph"},
        {"--part", frames + " --part=1/2 --repeat=2"},
        {"--codec prores needs", film + " --codec=prores"},
        {"--bit-depth 8", "--out=film.mov --frames=0:3 --codec=prores --bit-depth=8"},
        {"FILE.mp4", "--codec=av1"},
        {"FILE.mp4", "--bit-depth=10"},
        {"FILE.mp4", "--timecode=frame"},
        {".png, .jpg, .mp4 or .mov", "--out=film.avi"},
        {"a sequence of EXR", "--out=f_%d.png --frames=0:3 --timecode=frame"},
        {"a sequence of EXR", "--out=f.exr --timecode=frame"},
        {"needs a frame number such as %04d in the file's own name",
         "--frames=0:1 --out=a/%04d/f.png"},
        {"gather, hybrid, resolved, adaptive, denoised, accumulate, truth", "--method=nosuch"},
        {"--samples 0 must lie in [1, 256]", "--method=gather --samples=0"},
        {"--samples 0 must lie in [1, 65536]", "--method=accumulate --samples=0"},
        {"--samples 0 must lie in [1, 65536]", "--method=truth --samples=0"},
        {"--samples 0 must lie in [1, 65536]", "--method=sharp --samples=0"},
        {"--instants '16' is not auto", "--method=accumulate --instants=16"},
        {"--instants auto is for accumulate", "--method=truth --instants=auto"},
        {"--max-step requires --instants auto", "--method=accumulate --max-step=1"},
        {"--max-step 0 must lie in", "--method=accumulate --instants=auto --max-step=0"},
        {"--max-step nan must lie in", "--method=accumulate --instants=auto --max-step=nan"},
        {"method gather has no lens yet", "--method=gather --fstop=2.8"},
        {"--focus-entity: method gather", "--method=gather --focus-entity=x"},
        {"fStop", "--method=truth --fstop=0.001"},
        {"exclude", "--environment=a.hdr --sky=2.5"}};
    for (const auto& [part, words] : kPairs)
        refuse(part, words);
    for (const std::string method : {"accumulate", "truth", "denoised"})
        for (const std::string aa : {"taa", "box"})
            refuse("--aa is about the raster image", "--aa=" + aa + " --method=" + method);
}

TEST(RenderOptions, TheDefaultsAreThoseOfTheHelp) {
    const RenderOptions options = accept("");
    EXPECT_EQ(options.shot.width, 1280u);
    EXPECT_EQ(options.shot.height, 720u);
    EXPECT_EQ(options.shot.frameTimes, std::vector<double>{0.0});
    EXPECT_FALSE(options.shot.isSequence);
    EXPECT_EQ(options.shot.pixel, extract::PixelModel::Centre);
    EXPECT_EQ(options.shot.background, math::vec3(0.18f));
    EXPECT_EQ(options.shot.ambient, math::vec3(0.25f));
    EXPECT_EQ(options.shot.turbidity, 0.0);
    EXPECT_TRUE(options.shot.environment.empty());
    EXPECT_FALSE(options.shot.fStop);
    EXPECT_TRUE(options.output.aovs.empty());
    const auto& picture = options.shot.picture;
    EXPECT_EQ(picture.frameFit, extract::FrameFit::Whole);
    EXPECT_EQ(picture.antiAliasing, AntiAliasing::None);
    EXPECT_EQ(picture.bloom.share, 0.0f);
    EXPECT_EQ(picture.bloom.threshold, 1.0f);
    EXPECT_EQ(picture.bloom.knee, 0.5f);
    EXPECT_EQ(picture.features.shadows.mode, shadows::ShadowMode::None);
    EXPECT_EQ(picture.tonemap.op, tonemap::Operator::Neutral);
    const CameraShutter& shutter = options.shot.shutter;
    const CameraShutter plain;
    EXPECT_EQ(shutter.mode, ShutterMode::Physical);
    EXPECT_EQ(shutter.exposureSeconds, 1.0 / 60.0);
    EXPECT_EQ(shutter.phase, ShutterPhase::End);
    EXPECT_EQ(shutter.response.shape, ResponseShape::Box);
    EXPECT_TRUE(shutter.cuts.enabled);
    EXPECT_EQ(shutter.cuts.degrees, plain.cuts.degrees);
    EXPECT_EQ(shutter.cuts.metres, plain.cuts.metres);
    EXPECT_EQ(shutter.cameraRotationScale, 1.0);
    EXPECT_EQ(shutter.cameraTranslationScale, 1.0);
    EXPECT_EQ(shutter.objectScale, 1.0);
    EXPECT_STREQ(options.method.method->name, "resolved");
    EXPECT_EQ(options.method.samples, 15u);
    EXPECT_EQ(options.method.method->blur, &motion_blur::getDefaultMethod());
    EXPECT_EQ(options.method.motionBlur, motion_blur::complete({}));
}

TEST(RenderOptions, ValuesOfTheShotAreTaken) {
    const auto shot = [](const std::string& words) { return accept(words).shot; };
    EXPECT_EQ(shot("--size=1x16384").height, 16384u);
    EXPECT_EQ(shot("--time=-2.5").frameTimes, std::vector<double>{-2.5});
    EXPECT_EQ(shot("--background=0,0.5,65000").background, math::vec3(0.0f, 0.5f, 65000.0f));
    EXPECT_EQ(shot("--sky=2.5").turbidity, 2.5);
    EXPECT_EQ(shot("--environment=a.hdr").environment, "a.hdr");
    EXPECT_EQ(shot("--environment-intensity=3").surroundings.intensity, 3.0);
    EXPECT_EQ(shot("--environment-rotation=-90").surroundings.rotationDegrees, -90.0);
    EXPECT_EQ(shot("--method=accumulate --pixel=box").pixel, extract::PixelModel::Box);
    EXPECT_EQ(shot("--method=truth --pixel=box").pixel, extract::PixelModel::Box);
    EXPECT_EQ(shot("--fstop=0").fStop, 0.0) << "a pinhole is for all methods";
    const ShotOptions lens = shot("--method=accumulate --fstop=2.8 --focus=3");
    EXPECT_EQ(lens.fStop, 2.8);
    EXPECT_EQ(lens.focusDistance, 3.0);
    EXPECT_EQ(shot("--method=truth --focus-entity=x").focusEntity, "x");
}

TEST(RenderOptions, ValuesOfThePictureAreTaken) {
    const auto picture = [](const std::string& words) { return accept(words).shot.picture; };
    EXPECT_EQ(picture("--frame-fit=height").frameFit, extract::FrameFit::Height);
    EXPECT_EQ(picture("--frame-fit=whole").frameFit, extract::FrameFit::Whole);
    EXPECT_EQ(picture("--aa=taa").antiAliasing, AntiAliasing::Taa);
    EXPECT_EQ(picture("--aa=box --method=resolved").antiAliasing, AntiAliasing::Box);
    EXPECT_EQ(picture("--bloom=0.05").bloom.share, 0.05f);
    EXPECT_EQ(picture("--bloom-threshold=0").bloom.threshold, 0.0f);
    EXPECT_EQ(picture("--bloom-knee=1").bloom.knee, 1.0f);
    EXPECT_EQ(picture("--shadows=sharp").features.shadows.mode, shadows::ShadowMode::Sharp);
    EXPECT_EQ(picture("--shadows=blurred").features.shadows.mode, shadows::ShadowMode::Blurred);
    EXPECT_EQ(picture("--shadow-map-size=2048").features.shadows.mapSize, 2048u);
    EXPECT_EQ(picture("--shadow-distance=30").features.shadows.distance, 30.0);
    EXPECT_EQ(picture("--shadow-instants=8").features.shadows.instants, 8u);
    EXPECT_EQ(picture("--tonemap=none").tonemap.op, tonemap::Operator::None);
    EXPECT_EQ(picture("--unlit").tonemap.op, tonemap::Operator::None);
    EXPECT_EQ(picture("--ev=-32.0").tonemap.exposureValue, -32.0);
}

TEST(RenderOptions, APresetSetsWhatItSetsInPlayUnlessAnOptionIsGiven) {
    const auto picture = [](const std::string& words) { return accept(words).shot.picture; };
    for (const std::string preset : {"balanced", "quality"}) {
        const PictureSettings settings = picture("--preset=" + preset);
        EXPECT_EQ(settings.antiAliasing, AntiAliasing::Taa) << preset;
        EXPECT_EQ(settings.features.shadows.mode, shadows::ShadowMode::Blurred) << preset;
        EXPECT_EQ(settings.bloom.share, 0.04f) << preset;
    }
    const PictureSettings own =
        picture("--preset=balanced --aa=none --shadows=sharp --bloom=0 --shadow-map-size=2048");
    EXPECT_EQ(own.antiAliasing, AntiAliasing::None);
    EXPECT_EQ(own.features.shadows.mode, shadows::ShadowMode::Sharp);
    EXPECT_EQ(own.features.shadows.mapSize, 2048u);
    EXPECT_EQ(own.bloom.share, 0.0f);
    for (const std::string preset : {"off", "paper"})
        EXPECT_EQ(describe(picture("--preset=" + preset)), describe(PictureSettings())) << preset;
    EXPECT_EQ(picture("--preset=performance").features.shadows.mode, shadows::ShadowMode::Blurred);
    EXPECT_FALSE(accept("--preset=performance").shot.usesLens);
    EXPECT_TRUE(accept("--preset=performance --fstop=2.8").shot.usesLens);
    EXPECT_TRUE(accept("--preset=balanced").shot.usesLens);
    EXPECT_NE(
        accept("--preset=balanced").fingerprint, accept("--preset=balanced --aa=none").fingerprint
    );
}

TEST(RenderOptions, ValuesOfTheShutterAreTaken) {
    const auto shutter = [](const std::string& words) { return accept(words).shot.shutter; };
    EXPECT_EQ(shutter("--phase=start").phase, ShutterPhase::Start);
    EXPECT_EQ(shutter("--phase=centre").phase, ShutterPhase::Centre);
    EXPECT_EQ(shutter("--phase=end").phase, ShutterPhase::End);
    EXPECT_EQ(shutter("--cut-angle=30").cuts.degrees, 30.0);
    EXPECT_EQ(shutter("--cut-distance=2").cuts.metres, 2.0);
    EXPECT_FALSE(shutter("--cut-detection=off").cuts.enabled);
    EXPECT_EQ(shutter("--camera-rotation-blur=0").cameraRotationScale, 0.0);
    EXPECT_EQ(shutter("--camera-translation-blur=2").cameraTranslationScale, 2.0);
    EXPECT_EQ(shutter("--object-blur=0.5").objectScale, 0.5);
    EXPECT_EQ(shutter("--response=box").response.shape, ResponseShape::Box);
    EXPECT_EQ(shutter("--response=triangle").response.shape, ResponseShape::Triangle);
    const auto trapezoid = shutter("--response=trapezoid:0.2,0.35").response;
    EXPECT_EQ(trapezoid.shape, ResponseShape::Trapezoid);
    EXPECT_EQ(trapezoid.openShare, 0.2);
    EXPECT_EQ(trapezoid.closeShare, 0.35);
    const auto sampled = shutter("--response=samples:0,1,0.5,1e-3").response;
    EXPECT_EQ(sampled.shape, ResponseShape::Sampled);
    EXPECT_EQ(sampled.samples, (std::vector<double>{0.0, 1.0, 0.5, 1e-3}));
}

TEST(RenderOptions, TheModeOfTheShutterFollowsWhatIsGivenOrIsGivenItself) {
    const auto shutter = [](const std::string& words) { return accept(words).shot.shutter; };
    EXPECT_EQ(shutter("--shutter-angle=90").mode, ShutterMode::Angle);
    EXPECT_EQ(shutter("--exposure=0.1").mode, ShutterMode::Physical);
    const CameraShutter capped =
        shutter("--shutter-mode=capped --reference-fps=50 --shutter-angle=90");
    EXPECT_EQ(capped.mode, ShutterMode::Capped);
    EXPECT_DOUBLE_EQ(scene::computeExposureSeconds(capped, 1.0 / 25.0), 1.0 / 200.0);
    EXPECT_EQ(
        shutter("--shutter-mode=capped --reference-fps=24000/1001").referenceFps, 24000.0 / 1001.0
    );
    EXPECT_DOUBLE_EQ(
        scene::computeExposureSeconds(shutter("--shutter-mode=angle"), 1.0 / 25.0), 1.0 / 50.0
    );
}

TEST(RenderOptions, AShutterAngleIsAShareOfAFrame) {
    const auto exposure = [](const std::string& words) {
        const RenderOptions options = accept(words);
        return scene::computeExposureSeconds(options.shot.shutter, options.shot.frameSeconds);
    };
    EXPECT_DOUBLE_EQ(exposure("--shutter-angle=180"), 1.0 / 48.0);
    EXPECT_DOUBLE_EQ(exposure("--shutter-angle=360 --fps=50"), 0.02);
    EXPECT_EQ(exposure("--exposure=0"), 0.0);
    EXPECT_EQ(exposure("--exposure=0.25"), 0.25);
}

TEST(RenderOptions, APartIsOneOfSeveralAndDrawsWhatOthersNeedNot) {
    const std::string frames = kFrames;
    const RenderOptions options = accept(frames + " --part=3/4");
    ASSERT_TRUE(options.output.part);
    EXPECT_EQ(options.output.part->index, 2u);
    EXPECT_EQ(options.output.part->count, 4u);
    EXPECT_EQ(options.fingerprint, accept(frames).fingerprint) << "its pictures are the whole's";
    accept(frames + " --part=1/1 --aa=taa");
}

TEST(RenderOptions, AFilmsCodecDeterminesItsDepthAndContainerAndATimeCodeIsInEachExr) {
    const std::string film = kFilm;
    const auto plain = accept(film);
    EXPECT_EQ(plain.output.video.codec, io::VideoCodec::H264);
    EXPECT_EQ(plain.output.video.bitDepth, 8u);
    EXPECT_FALSE(plain.output.isDeep());
    const auto deep = accept(film + " --codec=av1 --bit-depth=10 --timecode=01:00:00:23");
    EXPECT_EQ(deep.output.video.codec, io::VideoCodec::Av1);
    EXPECT_TRUE(deep.output.isDeep());
    EXPECT_EQ(deep.output.video.timecode, "01:00:00:23");
    EXPECT_NE(deep.fingerprint, plain.fingerprint) << "its frames are other files";
    const auto proRes = accept("--out=film.mov --frames=0:3 --codec=prores");
    EXPECT_EQ(proRes.output.video.bitDepth, 10u);
    EXPECT_EQ(proRes.fingerprint, deep.fingerprint) << "its frames are the same files";
    const std::string frames = kFrames;
    const auto timed = accept(frames + " --timecode=01:00:00:23");
    EXPECT_EQ(timed.output.video.timecode, "01:00:00:23");
    EXPECT_NE(timed.fingerprint, accept(frames + " --timecode=01:00:00:22").fingerprint);
}

TEST(RenderOptions, FramesAreTimesOfTheirNumbersAndAFractionOfFramesASecondIsExact) {
    const RenderOptions options = accept("--frames=-1:2 --fps=10 --out=f_%04d.png");
    EXPECT_EQ(options.shot.frameTimes, (std::vector<double>{-0.1, 0.0, 0.1, 0.2}));
    EXPECT_EQ(options.shot.firstFrame, -1);
    EXPECT_TRUE(options.shot.isSequence);
    accept("--frames=3:3"); // one frame needs no number in its name
    const auto drawn = [](const std::string& fps) {
        return accept("--frames=24:25 --out=f_%04d.png --fps=" + fps);
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

TEST(RenderOptions, NoSamplesMeansTheMethodsOwnNumber) {
    const auto method = [](const std::string& words) { return accept("--method=" + words).method; };
    EXPECT_EQ(method("gather").motionBlur.sampleCount, 15u);
    EXPECT_EQ(method("gather --samples=256").motionBlur.sampleCount, 256u);
    EXPECT_EQ(method("accumulate").samples, 256u);
    EXPECT_EQ(method("accumulate --samples=1").samples, 1u);
    EXPECT_EQ(method("accumulate --samples=65536").samples, 65536u);
    EXPECT_EQ(method("truth").samples, 256u);
    EXPECT_EQ(method("sharp").samples, 0u);
}

TEST(RenderOptions, InstantsFollowTheMotionWhereTheyAreAutoAndAnErrorToStopAtIsTruths) {
    const auto method = [](const std::string& words) {
        return accept("--method=accumulate" + words).method;
    };
    EXPECT_EQ(method("").maxStepPx, std::nullopt);
    EXPECT_EQ(method(" --instants=auto").maxStepPx, 1.0);
    EXPECT_EQ(method(" --instants=auto").samples, 1024u); // at most
    const MethodOptions chosen = method(" --instants=auto --max-step=0.25 --samples=64");
    EXPECT_EQ(chosen.maxStepPx, 0.25);
    EXPECT_EQ(chosen.samples, 64u);
    EXPECT_EQ(accept("--method=truth --error=0.01").method.error, 0.01);
    EXPECT_FALSE(accept("--method=truth").method.error.has_value());
}

TEST(RenderOptions, EverySettingCanBeSet) {
    const auto with = [](const std::string& method, const std::vector<std::string>& settings) {
        std::string words = "--method=" + method;
        for (const std::string& setting : settings)
            words += " --set=" + setting;
        return accept(words).method.motionBlur;
    };
    const auto settings = with(
        "hybrid",
        {"tileSizePx=20",
         "neighbourhoodTiles=5",
         "recursionLimit=9",
         "softDepthExtent=0.5",
         "edgeThreshold=0.25",
         "luminanceThreshold=0.125",
         "foregroundMagnification=12",
         "backgroundMagnification=6",
         "jitter=0",
         "objectTest=luminance",
         "revealTraversal=stepping"}
    );
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
    const auto others = with("hybrid", {"revealTraversal=single", "objectTest=mesh_id"});
    EXPECT_EQ(others.revealTraversal, motion_blur::RevealTraversal::Single);
    EXPECT_EQ(others.objectTest, motion_blur::ObjectTest::MeshId);
    // The rivals' own.
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

TEST(RenderOptions, ASettingOfAnotherMethodIsRefused) {
    // Each name is some method's, and each method lacks some.
    for (const MethodInfo& method : listMethods()) {
        const std::string words = "--method=" + std::string(method.name);
        const bool blurs = method.family == MethodFamily::MotionBlur;
        const bool isOwnVelocity = method.name == std::string("own_velocity");
        refuse(
            method.name,
            words + (isOwnVelocity ? " --set=tileSizePx=20" : " --set=occluderTest=none")
        );
        const auto& settings = blurs ? method.blur->settings : std::vector<std::string_view>{};
        if (std::find(settings.begin(), settings.end(), "jitter") != settings.end())
            accept(words + " --set=jitter=0.5");
        else
            refuse("--set 'jitter'", words + " --set=jitter=0.5");
    }
}

TEST(RenderOptions, IntermediatesAreTheMethodsOwn) {
    const auto aovs = [](const std::string& method, const std::string& names) {
        return accept("--method=" + method + " --aov=" + names).output.aovs;
    };
    EXPECT_EQ(aovs("sharp", "depth,motion"), (std::set<std::string>{"depth", "motion"}));
    EXPECT_EQ(aovs("sharp", "all").size(), 4u);
    EXPECT_EQ(aovs("gather", "all").size(), 7u);
    EXPECT_EQ(aovs("hybrid", "all").size(), 11u);
    EXPECT_EQ(aovs("own_velocity", "all").size(), 5u);
    EXPECT_EQ(aovs("guertin2014", "variance,tiles").size(), 2u);
}

TEST(RenderOptions, TheExtensionDecidesWhetherAPictureIsForDisplays) {
    EXPECT_FALSE(accept("--out=a.exr").output.displayOut);
    EXPECT_TRUE(accept("--out=a.png").output.displayOut);
    EXPECT_TRUE(accept("--out=a.JPG").output.displayOut);
}

TEST(RenderOptions, OutputsNeedAFolderThatIsThereAndInterpretingWritesNothing) {
    const test::TempFolder folder;
    const std::string inside = folder.path().string() + "/";
    EXPECT_TRUE(checkOutputs(accept("--out=" + inside + "a.png --stats=" + inside + "s.json")));
    EXPECT_TRUE(fs::is_empty(folder.path()));
    fs::create_directory(folder.path() / "folder.png");
    const auto expectNamed = [](const std::string& option, const std::string& file) {
        const core::Status checked = checkOutputs(accept(option + "=" + file));
        ASSERT_FALSE(checked.ok()) << file;
        EXPECT_NE(checked.error().message.find(option), std::string::npos);
    };
    for (const char* name : {"a.png/b.png", "nosuch/a.png", "folder.png"})
        expectNamed("--out", inside + name);
    expectNamed("--stats", inside + "nosuch/s.json");
    expectNamed("--stats", folder.path().string());
}

TEST(FrameFile, TheNumberStandsInTheFilesOwnNameFilledWithZeros) {
    const std::pair<fs::path, fs::path> kNames[] = {
        {"a_%04d.png", "a_0007.png"},
        {"a_%d.png", "a_7.png"},
        {"a_%3d.png", "a_007.png"},
        {"a_%010d.png", "a_0000000007.png"},
        {"%d_of_%03d.png", "7_of_007.png"},
        {"100%%_%d.png", "100%_7.png"}, // two percent signs are one
        {"%%d_%%%d%%.png", "%d_%7%.png"},
        {"%d/a.png", "%d/a.png"}, // a folder has none
        {"a.png", "a.png"},
        {"100%.png", "100%.png"},
        {"a%s.png", "a%s.png"},
        {"", ""}};
    for (const auto& [name, expected] : kNames)
        EXPECT_EQ(frameFile(name, 7), expected) << name;
    EXPECT_EQ(frameFile("a_%02d.png", 123), fs::path("a_123.png"));
    EXPECT_EQ(frameFile("a_%04d.png", -7), fs::path("a_-007.png"));
    for (const char* folder : {"%d day", "%04d", "100%%", "50%20off", "a/%d/b", "Größe_🎥", "-x\n"})
        EXPECT_EQ(frameFile(fs::path(folder) / "f_%04d.png", 7), fs::path(folder) / "f_0007.png")
            << folder;
    EXPECT_EQ(frameFile("./x//f%d.png", 7).string(), "./x//f7.png");
}

TEST(ErrorOutput, ControlCharactersBecomeSpacesAndOtherTextStaysAsItIs) {
    EXPECT_EQ(toOneLine("a\nb\tc\r\x1b[31m\x7f"), "a b c  [31m ");
    EXPECT_EQ(toOneLine(std::string("a\0b", 3)), "a b");
    EXPECT_EQ(toOneLine(""), "");
    EXPECT_EQ(toOneLine("größe 5 µm"), "größe 5 µm");
}

} // namespace
} // namespace shutter::game
