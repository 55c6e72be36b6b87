// SPDX-License-Identifier: MIT
// Suites whose pictures are compared with the truth.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scenes.h"
#include "game/bench/suites/suite.h"

namespace shutter::bench {

namespace {

/// The frame rate at which the exposure is half a frame, as a film's is (180 degrees).
double findFilmRate(double exposureSeconds) {
    return 0.5 / exposureSeconds;
}

} // namespace

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
    for (const generator::BenchCase& from : generator::listHardCases()) {
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
        suite.cases.push_back(std::move(shot));
    }
    return suite;
}

} // namespace shutter::bench
