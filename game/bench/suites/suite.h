// SPDX-License-Identifier: MIT
// A benchmark suite as data.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "engine/core/result.h"
#include "game/options/shot_arguments.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::bench {

/// One shot, as a person would type it for `shutter render`; the benchmark chooses the methods.
struct Case {
    std::string name; ///< unique in its suite; part of file names
    std::string title;
    std::string description;
    game::ShotArguments shot;
    std::optional<game::PictureSize> size; ///< empty: the run's size
    /// Writes the scene to a file; empty where `shot.scene` names one that is there, and where
    /// provideRooms() has yet to set it.
    std::function<core::Status(const std::filesystem::path&)> writeScene;
    /// Binary glTF file that the scene is made from, relative to the folder of rooms; empty: none.
    std::string room;
    void (*furnish)(generator::GltfWriter& writer) = nullptr; ///< adds objects to `room`
};

/// A point of a scaling curve.
struct ScalingPoint {
    double value = 0.0; ///< in the axis' unit
    std::string label;
    Case shot;
};

/// How time grows with one parameter.
struct ScalingAxis {
    std::string name; ///< letters, digits, -
    std::string title;
    std::string unit;
    std::vector<ScalingPoint> points;
};

/// A film whose frames are each compared with the truth of their own instant: a flight through a
/// scene, or a demo that a script plays.
struct SequenceCase {
    std::string name; ///< unique in its suite; part of file names
    std::string title;
    std::string description;
    game::ShotArguments shot; ///< of a flight; of a demo its shutter and size
    /// Writes the scene to a file, named as the demo requires for demos.
    std::function<core::Status(const std::filesystem::path&)> writeScene;
    std::string demo;        ///< of game::listDemos(); empty: a flight
    std::string_view script; ///< text of the flythrough, or of the demo's input script
    uint32_t firstFrame = 0; ///< of the flight or the script
};

struct Suite {
    std::string name;
    std::vector<Case> cases;             ///< compared with the truth
    std::vector<ScalingAxis> axes;       ///< timed only
    std::vector<SequenceCase> sequences; ///< compared with the truth frame by frame
    /// Pixel model of the truth: the centre, as in the methods, or the mean over the pixel, as in a
    /// camera.
    extract::PixelModel pixel = extract::PixelModel::Centre;
    uint32_t repeats = 7;       ///< timed pictures of each method and sample count
    double limitSeconds = 60.0; ///< sample counts whose picture takes longer are skipped
    uint32_t maxRays = 256;     ///< largest sample count of methods that count rays
    bool hasLens = false;       ///< its cameras have lenses: pinholes are measured only if named
    /// Measured without --methods, at their defaults, from the fastest to the best; empty: all, at
    /// each of their sample counts.
    std::vector<std::string_view> dial;
    /// Each case is drawn with each.
    std::vector<game::AntiAliasing> antiAliasings = {game::AntiAliasing::None};
};

/// Error: lists the names of all suites.
[[nodiscard]] core::Result<Suite> findSuite(std::string_view name);

/// A user's own shot as a suite of one case, swept like `paper`.
[[nodiscard]] Suite makeOwnSuite(const game::ShotArguments& shot);

/// Case::writeScene of a generated scene.
[[nodiscard]] std::function<core::Status(const std::filesystem::path&)>
makeWriter(std::function<generator::GltfWriter()> build);

/// The paper's shot: a vase that crosses in front of a sofa.
[[nodiscard]] Suite makePaperSuite();
/// Twenty-four shots in which methods are known to fail.
[[nodiscard]] Suite makeHardSuite();
/// Resolution, entities, triangles, moving share of the screen, exposure.
[[nodiscard]] Suite makeScalingSuite();
/// Three flights and three played demos, judged in time.
[[nodiscard]] Suite makeSequenceSuite();
/// Four shots as a camera sees them: with each anti-aliasing, against the mean over the pixel.
[[nodiscard]] Suite makeEdgesSuite();

/// The played demos in the default look of `play` with a GPU, with taa and without anti-aliasing.
[[nodiscard]] Suite makeLookSuite();
/// Shots that a lens sees, against the mean over lens, exposure and pixel.
[[nodiscard]] Suite makeLensSuite();

/// Six shots, of still and turning cameras, rigid and deforming things: quality against time from
/// the cheapest method to the truth.
[[nodiscard]] Suite makeDialSuite();

/// Sets Case::writeScene of the cases that are made from a room, and leaves out, with a warning,
/// those whose room is not in the folder. Error: no case is left.
[[nodiscard]] core::Status provideRooms(Suite& suite, const std::filesystem::path& rooms);

/// "none", "taa" or "box".
[[nodiscard]] std::string nameAntiAliasing(game::AntiAliasing antiAliasing);

/// Puts the suite's pixel model and kinds of anti-aliasing into its cases and films: one of each
/// kind for each of them, called after it ("vase-taa") unless it has none.
void spreadAntiAliasing(Suite& suite);

} // namespace shutter::bench
