// SPDX-License-Identifier: MIT
#include "game/bench/suites/suite.h"

#include "assets/generator/demo_scenes.h"
#include "assets/generator/hard_cases.h"
#include "assets/generator/lens_shots.h"
#include "assets/generator/scaling_scenes.h"
#include "assets/generator/scenes.h"
#include "engine/core/log.h"
#include "game/bench/suites/courtyard_flight.h"
#include "game/bench/suites/gallery_focus_flight.h"
#include "game/bench/suites/gallery_script.h"
#include "game/bench/suites/rally_flight.h"
#include "game/bench/suites/rally_script.h"
#include "game/bench/suites/spin_script.h"
#include "game/bench/suites/vase_flight.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <set>
#include <system_error>

namespace shutter::bench {

namespace {

struct SuiteRow {
    std::string_view name;
    Suite (*make)();
};

constexpr std::array kSuites = {
    SuiteRow{"paper", makePaperSuite},
    SuiteRow{"hard", makeHardSuite},
    SuiteRow{"scaling", makeScalingSuite},
    SuiteRow{"sequence", makeSequenceSuite},
    SuiteRow{"edges", makeEdgesSuite},
    SuiteRow{"lens", makeLensSuite},
    SuiteRow{"look", makeLookSuite},
    SuiteRow{"dial", makeDialSuite},
};

/// The frame rate at which the exposure is half a frame, as a film's is (180 degrees).
double findFilmRate(double exposureSeconds) {
    return 0.5 / exposureSeconds;
}

/// A case of a scaling axis; `name` ends in the point's label.
Case makeCase(const std::string& name, std::function<generator::GltfWriter()> build) {
    Case shot;
    shot.name = name;
    shot.title = name;
    shot.shot.camera = generator::kScalingCamera;
    shot.shot.time = generator::kScalingSeconds;
    shot.shot.shutter =
        game::makeShutterArguments(generator::kScalingExposureSeconds, generator::kScalingPhase);
    shot.writeScene = makeWriter(std::move(build));
    return shot;
}

ScalingAxis makeResolutionAxis() {
    struct Size {
        uint32_t width;
        uint32_t height;
        const char* label;
    };

    constexpr std::array kSizes = {
        Size{640, 360, "360p"},
        Size{960, 540, "540p"},
        Size{1280, 720, "720p"},
        Size{1920, 1080, "1080p"},
        Size{2560, 1440, "1440p"},
        Size{3840, 2160, "4K"},
    };
    ScalingAxis axis{"resolution", "Resolution", "pixels", {}};
    for (const Size& size : kSizes) {
        Case shot = makeCase(fmt::format("resolution-{}", size.label), &generator::buildVaseScene);
        shot.size = {size.width, size.height};
        axis.points.push_back({double(size.width) * size.height, size.label, std::move(shot)});
    }
    return axis;
}

/// \param name of the axis, and its unit
ScalingAxis makeCountAxis(
    const char* name,
    const char* title,
    std::initializer_list<int> counts,
    generator::GltfWriter (*build)(int)
) {
    ScalingAxis axis{name, title, name, {}};
    for (const int count : counts)
        axis.points.push_back(
            {double(count),
             std::to_string(count),
             makeCase(fmt::format("{}-{}", name, count), [=] { return build(count); })}
        );
    return axis;
}

ScalingAxis makeMovingShareAxis() {
    ScalingAxis axis{"moving-share", "Moving share of the screen", "%", {}};
    for (int percent : {0, 5, 10, 25, 50, 75, 100})
        axis.points.push_back(
            {double(percent),
             fmt::format("{} %", percent),
             makeCase(
                 fmt::format("moving-{}", percent),
                 [percent] { return generator::buildMovingShareScene(float(percent) / 100.0f); }
             )}
        );
    return axis;
}

ScalingAxis makeExposureAxis() {
    ScalingAxis axis{"exposure", "Exposure, times 1/60 s", "x", {}};
    for (int times : {1, 2, 4, 8}) {
        Case shot = makeCase(fmt::format("exposure-{}", times), &generator::buildVaseScene);
        shot.shot.shutter.shutter.exposureSeconds = times * generator::kScalingExposureSeconds;
        axis.points.push_back({double(times), fmt::format("x{}", times), std::move(shot)});
    }
    return axis;
}

/// All bytes of an embedded file; the array has a zero after them.
template <size_t N> constexpr std::string_view viewOf(const char (&bytes)[N]) {
    return {bytes, N - 1};
}

struct SequenceRow {
    const char* name;
    const char* title;
    const char* description;
    generator::GltfWriter (*build)();
    const char* demo; ///< empty: a flight
    std::string_view script;
    uint32_t firstFrame;
};

constexpr SequenceRow kRows[] = {
    {"vase-flight",
     "Flight past the vase",
     "The camera cuts to a room, comes to rest and zooms at a cushion.",
     &generator::buildVaseScene,
     "",
     viewOf(k_vase_flight),
     72},
    {"courtyard-flight",
     "Flight round the courtyard",
     "The camera comes down between turning and swinging things.",
     &generator::buildCourtyardScene,
     "",
     viewOf(k_courtyard_flight),
     24},
    {"rally-flight",
     "Flight along the rally's road",
     "The camera rushes along a road with posts, gates and trees; only it moves.",
     &generator::buildRallyScene,
     "",
     viewOf(k_rally_flight),
     90},
    {"gallery-focus",
     "Focus pulled through the gallery",
     "A lens is focused at a near target, then at the far wall, past a pane that crosses.",
     &generator::buildGalleryScene,
     "",
     viewOf(k_gallery_focus_flight),
     10},
    {"rally-play",
     "The rally, driven",
     "A camera chases a car through curves: the car keeps its place, the world rushes by.",
     &generator::buildRallyScene,
     "rally",
     viewOf(k_rally_script),
     75},
    {"gallery-play",
     "The gallery, shot at",
     "Fast targets cross before a camera that a player turns, and balls are thrown at them.",
     &generator::buildGalleryScene,
     "gallery",
     viewOf(k_gallery_script),
     110},
    {"spin-play",
     "The carousel, ridden",
     "A carousel, a fan and a wind wheel turn at a great speed before a camera at rest.",
     &generator::buildSpinScene,
     "spin",
     viewOf(k_spin_script),
     120},
};

struct EdgesRow {
    const char* name;
    const char* title;
    const char* description;
    generator::GltfWriter (*build)();
    const char* camera;
    double seconds;
};

constexpr EdgesRow kEdgesRows[] = {
    {"vase",
     "Vase before a cushion",
     "The paper suite's scene; only the vase moves.",
     &generator::buildVaseScene,
     "main",
     0.0},
    {"courtyard",
     "Courtyard",
     "Many things move before bricks and paving.",
     &generator::buildCourtyardScene,
     "main",
     0.5},
    {"courtyard-pan",
     "Courtyard, camera turning",
     "The camera turns past all that moves.",
     &generator::buildCourtyardScene,
     "pan",
     0.5},
    {"gallery", "Gallery", "Nearly all is at rest.", &generator::buildGalleryScene, "shooter", 0.5},
};

Case makeHardCase(const generator::BenchCase& from) {
    Case shot;
    shot.name = from.name;
    shot.title = from.title;
    shot.description = from.description;
    shot.shot.camera = from.camera;
    shot.shot.time = from.timeSeconds;
    shot.shot.shutter = game::makeShutterArguments(from.exposureSeconds, from.phase);
    shot.shot.fps = findFilmRate(from.exposureSeconds);
    shot.shot.background = from.background;
    shot.writeScene = makeWriter(from.build);
    return shot;
}

Case makeEdgesCase(const EdgesRow& row) {
    Case shot;
    shot.name = row.name;
    shot.title = row.title;
    shot.description = row.description;
    shot.shot.camera = row.camera;
    shot.shot.time = row.seconds;
    shot.shot.fps = findFilmRate(generator::kExposureSeconds);
    shot.writeScene = makeWriter(row.build);
    return shot;
}

SequenceCase makeFilm(const SequenceRow& row) {
    SequenceCase film;
    film.name = row.name;
    film.title = row.title;
    film.description = row.description;
    film.writeScene = makeWriter(row.build);
    film.demo = row.demo;
    film.script = row.script;
    film.firstFrame = row.firstFrame;
    return film;
}

/// One of each for each kind of anti-aliasing.
template <class T> std::vector<T> spread(const std::vector<T>& cases, const Suite& suite) {
    std::vector<T> all;
    for (const T& one : cases)
        for (const game::AntiAliasing kind : suite.antiAliasings) {
            T& drawn = all.emplace_back(one);
            drawn.shot.pixel = suite.pixel;
            drawn.shot.picture.antiAliasing = kind;
            if (kind == game::AntiAliasing::None)
                continue;
            drawn.name += "-" + nameAntiAliasing(kind);
            drawn.title += ", --aa " + nameAntiAliasing(kind);
        }
    return all;
}

} // namespace

std::function<core::Status(const std::filesystem::path&)>
makeWriter(std::function<generator::GltfWriter()> build) {
    return [build = std::move(build)](const std::filesystem::path& file) -> core::Status {
        if (const std::string error = build().write(file); !error.empty())
            return core::Error{error};
        return {};
    };
}

core::Result<Suite> findSuite(std::string_view name) {
    std::string names;
    for (const SuiteRow& row : kSuites) {
        if (row.name == name)
            return row.make();
        names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
    }
    return core::makeError("--suite '{}' is not one of {}", name, names);
}

Suite makeOwnSuite(const game::ShotArguments& shot) {
    Suite suite;
    suite.name = "own";
    Case own;
    own.name = "own";
    own.title = std::filesystem::path(shot.scene).filename().string();
    own.description = "A scene given on the command line.";
    own.shot = shot;
    suite.cases = {own};
    return suite;
}

Suite makePaperSuite() {
    Case vase;
    vase.name = "vase";
    vase.title = "Vase before a cushion";
    vase.description =
        "A vase crosses in front of a sofa with a cushion: the kind of shot on which "
        "the paper compares methods. Motion 38 by 14 px at 1280x720.";
    vase.shot.camera = "main";
    vase.shot.shutter = game::makeShutterArguments(generator::kExposureSeconds, "end");
    vase.shot.fps = findFilmRate(generator::kExposureSeconds);
    vase.writeScene = makeWriter(&generator::buildVaseScene);
    Suite suite;
    suite.name = "paper";
    suite.limitSeconds = 120.0; // so that the truth of 256 rays is measured on a software device
    suite.cases = {vase};
    return suite;
}

Suite makeHardSuite() {
    Suite suite;
    suite.name = "hard";
    suite.repeats = 3;
    suite.limitSeconds = 30.0;
    suite.maxRays = 64;
    for (const generator::BenchCase& from : generator::listHardCases())
        suite.cases.push_back(makeHardCase(from));
    return suite;
}

Suite makeScalingSuite() {
    Suite suite;
    suite.name = "scaling";
    suite.repeats = 3;
    suite.limitSeconds = 30.0;
    suite.axes = {
        makeResolutionAxis(),
        makeCountAxis(
            "entities", "Moving entities", {1, 10, 100, 1000, 10000}, &generator::buildEntitiesScene
        ),
        makeCountAxis("bodies", "Walking bodies", {0, 1, 10, 50, 200}, &generator::buildCrowdScene),
        makeCountAxis(
            "triangles",
            "Triangles",
            {10'000, 31'623, 100'000, 316'228, 1'000'000},
            &generator::buildTrianglesScene
        ),
        makeMovingShareAxis(),
        makeExposureAxis()};
    return suite;
}

Suite makeSequenceSuite() {
    Suite suite;
    suite.name = "sequence";
    suite.repeats = 1;
    for (const SequenceRow& row : kRows)
        suite.sequences.push_back(makeFilm(row));
    return suite;
}

Suite makeLookSuite() {
    Suite suite;
    suite.name = "look";
    suite.repeats = 1;
    suite.pixel = extract::PixelModel::Box;
    suite.antiAliasings = {game::AntiAliasing::None, game::AntiAliasing::Taa};
    for (const SequenceRow& row : kRows) {
        if (std::string_view(row.demo).empty())
            continue;
        SequenceCase film = makeFilm(row);
        game::apply(*game::findPresetEffects("balanced"), film.shot.picture);
        suite.sequences.push_back(std::move(film));
    }
    return suite;
}

Suite makeEdgesSuite() {
    Suite suite;
    suite.name = "edges";
    suite.repeats = 3;
    suite.limitSeconds = 30.0;
    suite.maxRays = 16;
    suite.pixel = extract::PixelModel::Box;
    suite.antiAliasings = {
        game::AntiAliasing::None, game::AntiAliasing::Taa, game::AntiAliasing::Box};
    for (const EdgesRow& row : kEdgesRows)
        suite.cases.push_back(makeEdgesCase(row));
    return suite;
}

Suite makeDialSuite() {
    constexpr std::string_view kCases[] = {"vase", "courtyard", "courtyard-pan"};
    constexpr std::string_view kHardCases[] = {
        "camera_orbit", "walking_figure", "running_figure_pan"};
    Suite suite;
    suite.name = "dial";
    suite.repeats = 15;
    suite.dial = {
        "gather",
        "hybrid_share_0",
        "hybrid_share_25",
        "hybrid_share_50",
        "hybrid",
        "resolved",
        "adaptive_rays_2",
        "adaptive",
        "adaptive_rays_50",
        "adaptive_rays_200",
        "truth"};
    for (const EdgesRow& row : kEdgesRows)
        if (std::count(std::begin(kCases), std::end(kCases), row.name) > 0)
            suite.cases.push_back(makeEdgesCase(row));
    for (const generator::BenchCase& from : generator::listHardCases())
        if (std::count(std::begin(kHardCases), std::end(kHardCases), from.name) > 0)
            suite.cases.push_back(makeHardCase(from));
    return suite;
}

Suite makeLensSuite() {
    Suite suite;
    suite.name = "lens";
    suite.repeats = 3;
    suite.limitSeconds = 60.0;
    suite.maxRays = 16;
    suite.hasLens = true;
    suite.pixel = extract::PixelModel::Box;
    suite.antiAliasings = {
        game::AntiAliasing::None, game::AntiAliasing::Taa, game::AntiAliasing::Box};
    for (const generator::LensShot& from : generator::listLensShots()) {
        Case shot;
        shot.name = from.name;
        shot.title = from.title;
        shot.description = from.description;
        if (from.room) {
            shot.room = from.room;
            shot.furnish = from.furnish;
        } else {
            shot.writeScene = makeWriter([name = std::string(from.name), furnish = from.furnish] {
                generator::GltfWriter writer(name);
                furnish(writer);
                return writer;
            });
        }
        shot.shot.camera = generator::kLensCamera;
        shot.shot.clips = {"none"}; // the rooms' own, which would add to the shot's motion
        shot.shot.shutter = game::makeShutterArguments(generator::kExposureSeconds, "end");
        shot.shot.fps = findFilmRate(generator::kExposureSeconds);
        suite.cases.push_back(std::move(shot));
    }
    return suite;
}

core::Status provideRooms(Suite& suite, const std::filesystem::path& rooms) {
    std::set<std::string> missing;
    std::erase_if(suite.cases, [&](Case& shot) {
        if (shot.room.empty())
            return false;
        const std::filesystem::path room = rooms / shot.room;
        std::error_code failure;
        if (!std::filesystem::is_regular_file(room, failure)) {
            missing.insert(shot.room);
            return true;
        }
        shot.writeScene = makeWriter([room, furnish = shot.furnish] {
            generator::GltfWriter writer = generator::GltfWriter::open(room);
            furnish(writer);
            return writer;
        });
        return false;
    });
    const std::string names = fmt::format("{}", fmt::join(missing, ", "));
    if (suite.cases.empty() && suite.axes.empty() && suite.sequences.empty())
        return core::makeError("--rooms: '{}' has none of {}", rooms.string(), names);
    if (!missing.empty())
        core::logWarning("--rooms: '{}' lacks {}: their cases are left out", rooms.string(), names);
    return {};
}

std::string nameAntiAliasing(game::AntiAliasing antiAliasing) {
    const auto& row = core::getRow(game::listPictureRows(), "antiAliasing");
    return core::describeValue(row, {.antiAliasing = antiAliasing});
}

void spreadAntiAliasing(Suite& suite) {
    suite.cases = spread(suite.cases, suite);
    suite.sequences = spread(suite.sequences, suite);
}

} // namespace shutter::bench
