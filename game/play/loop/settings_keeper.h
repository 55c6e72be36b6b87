// SPDX-License-Identifier: MIT
// The file in which a player's settings outlast the session. Files that hold a mistake are left as
// they are.
#pragma once

#include "game/play/loop/play_options.h"
#include "game/play/panel/play_settings.h"

#include <filesystem>
#include <string>

namespace shutter::game {

class SettingsKeeper {
  public:
    /// The settings that a session starts with: the file's, where there is one, and over them what
    /// `options` names. A script without --settings neither reads nor writes the user's own file.
    /// \param message one line for the player if the user's own file was refused; else unchanged
    /// Error: the file that --settings names cannot be read.
    [[nodiscard]] core::Result<PlaySettings>
    open(const PlayOptions& options, bool isScripted, std::string& message);

    /// Writes the settings. \return one line for the player: the result, or why nothing was saved
    [[nodiscard]] std::string save(const PlaySettings& settings) const;

    /// Reads the settings again; `settings` stay as they are if the file is refused.
    /// \return one line for the player
    [[nodiscard]] std::string load(PlaySettings& settings);

    /// The player has kept no settings yet.
    [[nodiscard]] bool isFirstSession() const { return mIsFirstSession; }

    /// What a new player begins with on a software device, whose pictures take the processor: a
    /// budget that is a share of the frame, and, unless `options` name a preset, `performance`
    /// with the effects of kPresetWithoutGpu, and over it what `options` name.
    /// \return one line for the player; empty if `options` name a preset
    static std::string slowDown(const PlayOptions& options, PlaySettings& settings);

  private:
    std::string refuse(const std::string& why);

    std::filesystem::path mFile; ///< empty: settings are not kept
    bool mIsOwn = true;          ///< the user's own file, whose folder is made if need be
    bool mIsFirstSession = false;
    bool mIsRefused = false; ///< the file exists and holds a mistake
};

} // namespace shutter::game
