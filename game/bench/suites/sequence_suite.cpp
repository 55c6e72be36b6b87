// SPDX-License-Identifier: MIT
#include "assets/generator/demo_scenes.h"
#include "assets/generator/scenes.h"
#include "game/bench/suites/courtyard_flight.h"
#include "game/bench/suites/gallery_script.h"
#include "game/bench/suites/rally_flight.h"
#include "game/bench/suites/rally_script.h"
#include "game/bench/suites/spin_script.h"
#include "game/bench/suites/suite.h"
#include "game/bench/suites/vase_flight.h"

namespace shutter::bench {

namespace {

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

} // namespace

Suite makeSequenceSuite() {
    Suite suite;
    suite.name = "sequence";
    suite.repeats = 1;
    for (const SequenceRow& row : kRows) {
        SequenceCase film;
        film.name = row.name;
        film.title = row.title;
        film.description = row.description;
        film.writeScene = makeWriter(row.build);
        film.demo = row.demo;
        film.script = row.script;
        film.firstFrame = row.firstFrame;
        suite.sequences.push_back(std::move(film));
    }
    return suite;
}

} // namespace shutter::bench
