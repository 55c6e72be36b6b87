// SPDX-License-Identifier: MIT
// Killed in the middle of a sequence: every file with a picture's name is a complete picture.
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"
#include "tests/cli/folder_watch.h"

#include <csignal>
#include <sys/wait.h>

namespace shutter::cli {

TEST_F(Cli, AnInterruptedSequenceLeavesNoHalfPicture) {
    requireDevice();
    if (IsSkipped())
        return;
    // The journal is two events, its temporary file and the rename, and so is each picture: an odd
    // number falls between them, an even one before the next picture.
    for (const int events : {7, 8, 9, 11}) {
        const std::string folder = path(std::to_string(events));
        fs::create_directory(folder);
        const FolderWatch watch(folder);
        const pid_t process = start(renderVase(
            {"--method", "sharp", "--frames", "0:99999", "--out", folder + "/f_%06d.exr"}
        ));
        watch.waitFor(events, process);
        kill(process, SIGKILL);
        int status = 0;
        waitpid(process, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
        int pictures = 0;
        for (const auto& entry : fs::directory_iterator(folder)) {
            if (entry.path().extension() != ".exr")
                continue;
            const auto picture = io::readImage(entry.path());
            ASSERT_TRUE(picture.ok()) << picture.error().message;
            EXPECT_EQ(picture.value().width, 64u);
            EXPECT_EQ(picture.value().height, 36u);
            ++pictures;
        }
        EXPECT_GE(pictures, events / 2 - 1);
    }
}

} // namespace shutter::cli
