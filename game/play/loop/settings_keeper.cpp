// SPDX-License-Identifier: MIT
#include "game/play/loop/settings_keeper.h"

#include "engine/core/log.h"
#include "game/options/program.h"

#include <system_error>
#include <utility>

namespace shutter::game {

namespace {

/// For a player without settings: a third of a frame at 20 frames per second.
constexpr double kFirstBudgetMilliseconds = 16.0;
/// The same without a GPU, where the whole frame takes hundreds of milliseconds: of the frame.
constexpr double kFirstBudgetShare = 0.25;

constexpr const char* kNoFile =
    "settings are kept nowhere: there is no home folder, or a script plays";

void applyOptions(const PlayOptions& options, PlaySettings& settings) {
    if (options.preset)
        applyPreset(*options.preset, settings);
    if (options.method)
        settings.method = *options.method;
    if (options.vsync)
        settings.vsync = *options.vsync;
    if (options.uiScale)
        settings.uiScale = *options.uiScale;
    visitPictureRows([&](auto rows, const auto& part) {
        for (const auto& row : rows)
            if (options.typed.contains(row.option))
                core::copyValue(row, part(options.shot.picture), part(settings.picture));
    });
    if (options.fStop) {
        settings.lens.fStop = *options.fStop;
        settings.depthOfField = *options.fStop != 0.0;
        if (settings.depthOfField && settings.lens.blurScale == 0.0)
            settings.lens.blurScale = scene::LensOverride().blurScale;
    }
    if (options.focusDistance)
        settings.lens.focusDistance = *options.focusDistance;
    else if (!options.shot.focusEntity.empty())
        settings.lens.focusDistance = 0.0; // as the cameras do
    if (options.environment)
        settings.environment = *options.environment;
}

} // namespace

core::Result<PlaySettings>
SettingsKeeper::open(const PlayOptions& options, bool isScripted, std::string& message) {
    PlaySettings settings;
    mIsOwn = options.settings.empty();
    // What a script shows must not depend on what a person left behind.
    const bool isPersons = mIsOwn && !isScripted;
    mFile = isPersons ? findSettingsFile() : options.settings;
    std::error_code ignored;
    if (!mFile.empty() && (!isPersons || std::filesystem::exists(mFile, ignored))) {
        auto loaded = loadPlaySettings(mFile);
        if (!loaded && !isPersons)
            return loaded.error();
        if (!loaded)
            message = refuse(loaded.error().message);
        else
            settings = std::move(loaded).value();
    }
    // The budget keeps up a person's frame rate in the first session; scripts and films depend on
    // no clock.
    mIsFirstSession = isPersons && options.film.empty() && !std::filesystem::exists(mFile, ignored);
    if (mIsFirstSession)
        settings.budget.milliseconds = kFirstBudgetMilliseconds;
    applyOptions(options, settings);
    return settings;
}

std::string SettingsKeeper::slowDown(const PlayOptions& options, PlaySettings& settings) {
    settings.budget = {};
    settings.budgetShare = kFirstBudgetShare;
    if (options.preset)
        return {};
    const Preset& preset = *findPreset("performance").value();
    applyPreset(preset, settings);
    apply(*findPresetEffects(kPresetWithoutGpu), settings.picture);
    applyOptions(options, settings);
    return fmt::format(
        "no GPU: started with the preset {}, keys 1 to 9 change it", kPresetWithoutGpu
    );
}

std::string SettingsKeeper::save(const PlaySettings& settings) const {
    if (mFile.empty())
        return kNoFile;
    std::error_code ignored;
    if (mIsOwn)
        std::filesystem::create_directories(mFile.parent_path(), ignored);
    if (mIsRefused)
        return mFile.string() + " is not written over: it was refused and holds a mistake";
    const core::Status saved = savePlaySettings(mFile, settings);
    return saved ? "saved " + mFile.string() : saved.error().message;
}

std::string SettingsKeeper::load(PlaySettings& settings) {
    if (mFile.empty())
        return kNoFile;
    std::error_code ignored;
    if (!std::filesystem::exists(mFile, ignored))
        return fmt::format("{} is not there yet: F5 saves the settings", mFile.string());
    auto loaded = loadPlaySettings(mFile);
    if (!loaded)
        return refuse(loaded.error().message);
    mIsRefused = false;
    settings = std::move(loaded).value();
    return "loaded " + mFile.string();
}

std::string SettingsKeeper::refuse(const std::string& why) {
    mIsRefused = true;
    core::logWarning("{}", why);
    return why;
}

} // namespace shutter::game
