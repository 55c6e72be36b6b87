// SPDX-License-Identifier: MIT
// A host is compiled against one header and may meet a newer library: what a structure of the C
// interface holds stays where it is, and new fields come last. A change that these tests notice
// breaks hosts that are built already: it takes a new SHUTTER_BLUR_VERSION_MINOR (before 1.0) or
// MAJOR.
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace shutter {
namespace {

TEST(CStructures, InArraysNeverGrow) {
    static_assert(sizeof(void*) == 8, "the sizes are those of 64-bit hosts");
    EXPECT_EQ(sizeof(ShutterBlurValue), 16u);
    EXPECT_EQ(sizeof(ShutterBlurCameraKey), 264u);
    EXPECT_EQ(sizeof(ShutterBlurMover), 16u);
    EXPECT_EQ(sizeof(ShutterBlurPassTime), 24u);
    EXPECT_EQ(sizeof(ShutterBlurCounter), 16u);
}

TEST(CStructures, WithinOthersNeverGrow) {
    EXPECT_EQ(sizeof(ShutterBlurUse), 24u);
    EXPECT_EQ(sizeof(ShutterBlurImage), 96u);
    EXPECT_EQ(sizeof(ShutterBlurCameras), 552u);
    EXPECT_EQ(sizeof(ShutterBlurRevealTarget), 16u);
}

#define EXPECT_IN_PLACE(type, field, offset)                                                       \
    EXPECT_EQ(offsetof(type, structBytes), 0u);                                                    \
    EXPECT_EQ(offsetof(type, field), size_t{offset}) << "a field before it has changed"

TEST(CStructures, ThatTellTheirSizeKeepTheirFieldsInPlace) {
    EXPECT_IN_PLACE(ShutterBlurDevice, messageUser, 80);
    EXPECT_IN_PLACE(ShutterBlurSettings, preset, 32);
    EXPECT_IN_PLACE(ShutterBlurRevealTask, entityId, 104);
    EXPECT_IN_PLACE(ShutterBlurSampleTask, answersBytes, 88);
    EXPECT_IN_PLACE(ShutterBlurInputs, showsInputs, 1808);
    EXPECT_IN_PLACE(ShutterBlurReport, gaveUp, 40);
    EXPECT_IN_PLACE(ShutterBlurPlan, moverCount, 52);
    EXPECT_IN_PLACE(ShutterBlurMemory, bytes, 8);
}

} // namespace
} // namespace shutter
